package houghstream.spy;

import houghstream.detections_t;
import houghstream.object_poses_t;
import java.util.LinkedHashMap;

/** Joins frames with their detections and poses by utime. Times handed in are microseconds of one clock. */
final class ResultMatcher {
  /** What is known about a frame; null where it was not heard. */
  static final class Entry {
    final long utime;
    byte[] frame;
    detections_t detections;
    object_poses_t poses;

    Entry(long utime) {
      this.utime = utime;
    }
  }

  private static final int KEPT = 60; // two seconds at 30 Hz: results come later than their frame
  private static final long SILENCE_US = 1_500_000; // when no poses come for so long, nobody makes them
  private static final long OLD_US = 1_000_000;
  private final LinkedHashMap<Long, Entry> entries = new LinkedHashMap<>(); // in the order in which they came
  private long lastPosesUs = Long.MIN_VALUE / 2;

  synchronized void addFrame(byte[] bytes) throws BadMessage {
    long utime = Wire.utime(bytes);
    Entry known = entries.get(utime);
    if (known != null && known.frame != null) entries.remove(utime); // a log that is played again
    entry(utime).frame = bytes;
  }

  synchronized void addDetections(detections_t detections) {
    entry(detections.utime).detections = detections;
  }

  synchronized void addPoses(object_poses_t poses, long nowUs) {
    lastPosesUs = nowUs;
    entry(poses.utime).poses = poses;
  }

  /**
   * The newest frame with detections, and with poses unless there are none these days; null where there is none. One
   * whose frame arrived goes before those without, unless it is more than a second older.
   */
  synchronized Entry newest(long nowUs) {
    boolean posesExpected = nowUs - lastPosesUs < SILENCE_US;
    Entry newest = null;
    Entry newestWithFrame = null;
    for (Entry entry : entries.values()) {
      if (entry.detections == null || entry.poses == null && posesExpected) continue;
      newest = entry;
      if (entry.frame != null) newestWithFrame = entry;
    }
    boolean recent = newestWithFrame != null && Math.abs(newest.utime - newestWithFrame.utime) <= OLD_US;
    return recent ? newestWithFrame : newest;
  }

  /** How many of the frames with detections arrived themselves, in percent; 0 where there are none. */
  synchronized int arrivedPercent() {
    int arrived = 0;
    int wanted = 0;
    for (Entry entry : entries.values()) {
      if (entry.detections == null) continue;
      ++wanted;
      if (entry.frame != null) ++arrived;
    }
    return wanted == 0 ? 0 : 100 * arrived / wanted;
  }

  private Entry entry(long utime) {
    Entry entry = entries.computeIfAbsent(utime, Entry::new);
    if (entries.size() > KEPT) entries.remove(entries.keySet().iterator().next());
    return entry;
  }
}
