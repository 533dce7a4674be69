package houghstream.spy;

import houghstream.camera_t;
import houghstream.detection_t;
import houghstream.detections_t;
import houghstream.object_pose_t;
import houghstream.object_poses_t;
import java.util.Arrays;

/**
 * Poses without detections, as hs-pose --follow sends them, with a detection for each: a box of ten centimetres around
 * its origin. As boxed() of tools/view/drawing/overlay.hpp; models are not known here.
 */
final class FollowedPoses {
  private static final double HALF_M = 0.05;
  private static final double NEAR_M = 0.05; // nothing nearer has a box

  private FollowedPoses() {}

  /** Those that are valid; the place of each is its index. */
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

  /** A detection for each pose. `camera` may be null: then boxes are empty. */
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
}
