package houghstream.spy;

import houghstream.detection_t;
import houghstream.detections_t;
import houghstream.object_pose_t;
import houghstream.object_poses_t;
import houghstream.stage_time_t;
import java.util.ArrayList;
import java.util.Arrays;
import java.util.Comparator;
import java.util.List;
import java.util.stream.IntStream;

/**
 * All that was published of one frame. Several detectors may work on a camera's frames, each with a forest of its own
 * objects: each result has its own poses. As pipeline/types/frame_results.hpp.
 */
final class FrameResults {
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
