package houghstream.spy;

import houghstream.camera_t;
import houghstream.detection_t;
import houghstream.detections_t;
import houghstream.object_pose_t;
import houghstream.object_poses_t;
import houghstream.spy.Wire.BadMessage;
import houghstream.stage_time_t;
import java.util.ArrayList;
import java.util.Arrays;
import java.util.Comparator;
import java.util.LinkedHashMap;
import java.util.List;
import java.util.TreeSet;
import java.util.function.Predicate;
import java.util.stream.IntStream;

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
  private static final double HALF_M = 0.05; // of a followed object's box
  private static final double NEAR_M = 0.05; // nothing nearer has a box
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

  /** The valid ones of poses without detections, as hs-pose --follow sends them; the place of each is its index. */
  static object_poses_t valid(object_poses_t followed) {
    object_poses_t all = new object_poses_t();
    all.utime = followed.utime;
    all.source_channel = followed.source_channel;
    all.poses = Arrays.stream(followed.poses).filter(ObjectsTable::hasPose)
        .map(object_pose_t::copy).toArray(object_pose_t[]::new);
    all.n_poses = all.poses.length;
    for (int i = 0; i < all.n_poses; ++i) all.poses[i].detection_index = i;
    all.stages = followed.stages;
    all.n_stages = all.stages.length;
    return all;
  }

  /**
   * A detection for each such pose: a box of ten centimetres around its origin. As boxed() of
   * tools/view/drawing/overlay.hpp; models are not known here. `camera` may be null: then boxes are empty.
   */
  static detections_t boxed(object_poses_t poses, camera_t camera) {
    detections_t all = new detections_t();
    all.utime = poses.utime;
    all.source_channel = poses.source_channel;
    all.detections = Arrays.stream(poses.poses).map(pose -> detection(pose, camera)).toArray(detection_t[]::new);
    all.n_detections = all.detections.length;
    all.stages = poses.stages;
    all.n_stages = all.stages.length;
    return all;
  }

  private static detection_t detection(object_pose_t pose, camera_t camera) {
    double x = pose.trans[0];
    double y = pose.trans[1];
    double z = pose.trans[2];
    detection_t detection = new detection_t();
    detection.class_id = pose.class_id;
    detection.class_name = pose.class_name;
    detection.score = pose.detection_score;
    detection.reported = true;
    detection.centre_camera = new float[] {(float) x, (float) y, (float) z};
    detection.vote_quat = new float[0][4];
    detection.vote_quat_weight = new float[0];
    if (camera == null || !(z > NEAR_M)) return detection; // NaN too
    detection.box_x = (float) (camera.cx + camera.fx * (x - HALF_M) / z);
    detection.box_y = (float) (camera.cy + camera.fy * (y - HALF_M) / z);
    detection.box_width = (float) (2 * camera.fx * HALF_M / z);
    detection.box_height = (float) (2 * camera.fy * HALF_M / z);
    return detection;
  }

  /**
   * All that was published of one frame. Several detectors may work on a camera's frames, each with a forest of its own
   * objects: each result has its own poses. As pipeline/types/frame_results.hpp.
   */
  static final class FrameResults {
    private static final String FOLLOWING_STAGE = "pose.following"; // poses with its time answer no detections

    private static final class Result {
      detections_t detections;
      object_poses_t poses;

      Result(detections_t detections) {
        this.detections = detections;
      }
    }

    private final List<Result> results = new ArrayList<>();
    private final List<object_poses_t> unmatched = new ArrayList<>();
    private object_poses_t followed;

    /** One that finds the very same objects as an earlier one takes its place: it is a log that is played again. */
    void add(detections_t detections) {
      boolean isKnown = false;
      for (Result known : results) {
        if (isKnown || !sameFind(known.detections, detections)) continue;
        known.detections = detections;
        isKnown = true;
      }
      if (!isKnown) results.add(new Result(detections));
      unmatched.removeIf(this::place);
    }

    void add(object_poses_t poses) {
      if (areFollowed(poses)) {
        followed = poses;
      } else if (!place(poses)) {
        unmatched.add(poses);
      }
    }

    /** The poses of the objects that hs-pose follows from frame to frame; null where it follows none. */
    object_poses_t followed() {
      return followed;
    }

    int size() {
      return results.size();
    }

    boolean allPosed() {
      return results.stream().allMatch(result -> result.poses != null);
    }

    boolean anyPosed() {
      return results.stream().anyMatch(result -> result.poses != null);
    }

    /** All results as one, strongest first; null where there are none. */
    detections_t detections() {
      if (results.size() < 2) return results.isEmpty() ? null : results.get(0).detections;
      detections_t all = new detections_t();
      all.utime = results.get(0).detections.utime;
      all.source_channel = results.get(0).detections.source_channel;
      int[] order = order();
      detection_t[] found = inTurn();
      all.detections = Arrays.stream(order).mapToObj(i -> found[i]).toArray(detection_t[]::new);
      all.n_detections = all.detections.length;
      all.stages = stages(results.stream().map(result -> result.detections.stages).toList());
      all.n_stages = all.stages.length;
      return all;
    }

    /** The poses that have come, with indices into detections(); null where there are none. */
    object_poses_t poses() {
      if (!anyPosed()) return null;
      if (results.size() == 1) return results.get(0).poses;
      int[] order = order();
      int[] placeOf = new int[order.length];
      for (int i = 0; i < order.length; ++i) placeOf[order[i]] = i;
      List<object_pose_t> found = new ArrayList<>();
      List<stage_time_t[]> stages = new ArrayList<>();
      object_poses_t all = new object_poses_t();
      int before = 0;
      for (Result result : results) {
        if (result.poses != null) {
          all.utime = result.poses.utime;
          all.source_channel = result.poses.source_channel;
          stages.add(result.poses.stages);
          for (object_pose_t pose : result.poses.poses) found.add(moved(pose, placeOf[before + pose.detection_index]));
        }
        before += result.detections.n_detections;
      }
      all.poses = found.toArray(new object_pose_t[0]);
      all.n_poses = all.poses.length;
      all.stages = stages(stages);
      all.n_stages = all.stages.length;
      return all;
    }

    private static object_pose_t moved(object_pose_t pose, int index) {
      object_pose_t copy = pose.copy();
      copy.detection_index = index;
      return copy;
    }

    private detection_t[] inTurn() {
      return results.stream().flatMap(result -> Arrays.stream(result.detections.detections)).toArray(detection_t[]::new);
    }

    private int[] order() {
      detection_t[] found = inTurn();
      Comparator<Integer> strongest = Comparator.comparingDouble(i -> -found[i].score);
      return IntStream.range(0, found.length).boxed().sorted(strongest).mapToInt(Integer::intValue).toArray();
    }

    // The stages that all begin with are the frame's own and stand once.
    private static stage_time_t[] stages(List<stage_time_t[]> lists) {
      int common = 0;
      while (isCommon(lists, common)) ++common;
      List<stage_time_t> all = new ArrayList<>(Arrays.asList(lists.get(0)));
      for (stage_time_t[] more : lists.subList(1, lists.size())) {
        all.addAll(Arrays.asList(more).subList(common, more.length));
      }
      return all.toArray(new stage_time_t[0]);
    }

    private static boolean isCommon(List<stage_time_t[]> lists, int i) {
      stage_time_t[] first = lists.get(0);
      return i < first.length && lists.stream().allMatch(other -> i < other.length
          && other[i].stage.equals(first[i].stage) && other[i].duration_us == first[i].duration_us);
    }

    private boolean place(object_poses_t poses) {
      Result best = null;
      int bestRank = -1;
      for (Result result : results) {
        if (!answers(poses, result.detections)) continue;
        int rank = (sameScores(poses, result.detections) ? 2 : 0) + (result.poses == null ? 1 : 0);
        if (rank > bestRank) best = result;
        bestRank = Math.max(bestRank, rank);
      }
      if (best == null) return false;
      if (best.poses == null || !withoutModels(poses)) best.poses = poses;
      return true;
    }

    private static boolean areFollowed(object_poses_t poses) {
      if (poses.poses.length > 0) return poses.poses[0].detection_index < 0;
      return Arrays.stream(poses.stages).anyMatch(stage -> stage.stage.equals(FOLLOWING_STAGE));
    }

    // Answered by an hs-pose without models of these objects: on another host one may have them.
    private static boolean withoutModels(object_poses_t poses) {
      return Arrays.stream(poses.poses).allMatch(pose -> pose.status == object_pose_t.NO_MODEL);
    }

    private static boolean answers(object_poses_t poses, detections_t detections) {
      if (poses.poses.length > detections.n_detections) return false;
      if (poses.poses.length == 0 != (detections.n_detections == 0)) return false;
      return Arrays.stream(poses.poses).allMatch(pose -> pose.detection_index >= 0
          && pose.detection_index < detections.n_detections
          && pose.class_name.equals(detections.detections[pose.detection_index].class_name));
    }

    private static boolean sameScores(object_poses_t poses, detections_t detections) {
      return poses.poses.length == detections.n_detections && Arrays.stream(poses.poses)
          .allMatch(pose -> pose.detection_score == detections.detections[pose.detection_index].score);
    }

    private static boolean sameFind(detections_t a, detections_t b) {
      if (a.n_detections == 0 || a.n_detections != b.n_detections) return false;
      return IntStream.range(0, a.n_detections).allMatch(i -> same(a.detections[i], b.detections[i]));
    }

    private static boolean same(detection_t a, detection_t b) {
      return a.class_id == b.class_id && a.class_name.equals(b.class_name) && a.score == b.score && a.reported == b.reported && a.box_x == b.box_x
          && a.box_y == b.box_y && a.box_width == b.box_width && a.box_height == b.box_height
          && a.vote_weight == b.vote_weight && a.n_votes_total == b.n_votes_total;
    }
  }
}
