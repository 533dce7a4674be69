package houghstream.spy;

import houghstream.detections_t;
import houghstream.object_poses_t;
import houghstream.spy.Wire.BadMessage;
import java.util.LinkedHashMap;
import java.util.List;
import java.util.TreeSet;
import java.util.function.Predicate;

/**
 * Joins frames with their detections and poses by the frame's name, its channel and utime: two cameras may take frames
 * of equal times. One camera is shown at a time. Times handed in are microseconds of one clock.
 */
final class ResultMatcher {
  /** The name of a frame. */
  record FrameId(String channel, long utime) {}

  /** What is known about a frame; `frame` is null where it was not heard. */
  static final class Entry {
    final FrameId id;
    final long utime;
    byte[] frame;
    final FrameResults results = new FrameResults();
    int changes; // grows with all that comes

    Entry(FrameId id) {
      this.id = id;
      utime = id.utime;
    }
  }

  /** An entry as it is at one moment: what comes later does not change it. All but `entry` may be null. */
  record Snapshot(Entry entry, int changes, byte[] frame, detections_t detections, object_poses_t poses,
      object_poses_t followed) {}

  private static final int KEPT = 60; // of each camera two seconds at 30 Hz: results come later than their frame
  private static final long SILENCE_US = 1_500_000; // when no poses come for so long, nobody makes them
  private static final long OLD_US = 1_000_000;
  private static final long PATIENCE_US = 500_000; // so much older may a frame be that all detectors have worked on
  private final LinkedHashMap<FrameId, Entry> entries = new LinkedHashMap<>(); // in the order in which they came
  private final TreeSet<String> cameras = new TreeSet<>();
  private String shown = "";
  private long lastPosesUs = Long.MIN_VALUE / 2;

  synchronized void addFrame(String channel, byte[] bytes) throws BadMessage {
    FrameId id = new FrameId(channel, Wire.utime(bytes));
    Entry known = entries.get(id);
    if (known != null && known.frame != null) entries.remove(id); // a log that is played again
    entry(id).frame = bytes;
  }

  synchronized void addDetections(detections_t detections) {
    entry(new FrameId(detections.source_channel, detections.utime)).results.add(detections);
  }

  synchronized void addPoses(object_poses_t poses, long nowUs) {
    lastPosesUs = nowUs;
    entry(new FrameId(poses.source_channel, poses.utime)).results.add(poses);
  }

  /** The channels of all cameras that were heard of, in order. */
  synchronized List<String> cameras() {
    return List.copyOf(cameras);
  }

  /** Which camera is shown: the first that was heard of, until another is chosen. */
  synchronized String shown() {
    return shown;
  }

  synchronized void choose(String camera) {
    shown = camera;
  }

  /** What newest() is at this moment; null where there is none. */
  synchronized Snapshot snapshot(long nowUs) {
    Entry entry = newest(nowUs);
    if (entry == null) return null;
    FrameResults results = entry.results;
    return new Snapshot(entry, entry.changes, entry.frame, results.detections(), results.poses(), results.followed());
  }

  /**
   * The camera's newest frame with followed poses, or with detections, and with poses unless there are none these days;
   * null where there is none. One whose frame arrived goes before those without, unless it is more than a second older;
   * one on which all detectors have worked goes before others, unless it is more than half a second older.
   */
  synchronized Entry newest(long nowUs) {
    boolean posesExpected = nowUs - lastPosesUs < SILENCE_US;
    int detectors = entries.values().stream().filter(this::isShown).mapToInt(e -> e.results.size()).max().orElse(0);
    Entry any = newest(e -> e.results.followed() != null
        || (e.results.size() > 0 && (e.results.anyPosed() || !posesExpected)));
    Entry full = newest(e -> e.results.followed() != null || (e.results.size() > 0 && e.results.size() >= detectors
        && (e.results.allPosed() || !posesExpected)));
    return full != null && Math.abs(any.utime - full.utime) <= PATIENCE_US ? full : any;
  }

  private Entry newest(Predicate<Entry> ready) {
    Entry newest = null;
    Entry newestWithFrame = null;
    for (Entry entry : entries.values()) {
      if (!isShown(entry) || !ready.test(entry)) continue;
      newest = entry;
      if (entry.frame != null) newestWithFrame = entry;
    }
    boolean recent = newestWithFrame != null && Math.abs(newest.utime - newestWithFrame.utime) <= OLD_US;
    return recent ? newestWithFrame : newest;
  }

  /** How many of the camera's frames with results arrived themselves, in percent; 0 where there are none. */
  synchronized int arrivedPercent() {
    int arrived = 0;
    int wanted = 0;
    for (Entry entry : entries.values()) {
      if (!isShown(entry) || (entry.results.size() == 0 && entry.results.followed() == null)) continue;
      ++wanted;
      if (entry.frame != null) ++arrived;
    }
    return wanted == 0 ? 0 : 100 * arrived / wanted;
  }

  private boolean isShown(Entry entry) {
    return entry.id.channel.equals(shown);
  }

  private Entry entry(FrameId id) {
    if (cameras.isEmpty()) shown = id.channel;
    cameras.add(id.channel);
    Entry entry = entries.computeIfAbsent(id, Entry::new);
    ++entry.changes;
    if (entries.size() > KEPT * cameras.size()) entries.remove(entries.keySet().iterator().next());
    return entry;
  }
}
