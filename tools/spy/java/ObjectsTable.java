package houghstream.spy;

import houghstream.detection_t;
import houghstream.detections_t;
import houghstream.object_pose_t;
import houghstream.object_poses_t;
import javax.swing.table.DefaultTableModel;

/** A row per detection that is reported: what it is, how sure, where, and what became of its pose. */
@SuppressWarnings("serial")
final class ObjectsTable extends DefaultTableModel {
  ObjectsTable() {
    super(new String[] {"object", "score", "x, y, z in m", "pose", "quality"}, 0);
  }

  /** `poses` may be null. Detections with scores below `minScore` are left out. */
  void show(detections_t detections, object_poses_t poses, double minScore) {
    setRowCount(0);
    for (int i = 0; i < detections.n_detections; ++i) {
      detection_t detection = detections.detections[i];
      object_pose_t pose = poseOf(i, poses);
      if (detection.score >= minScore && isReported(detection, pose)) addRow(row(detection, pose));
    }
  }

  /** A candidate counts where its pose is valid, another detection where its pose does not refute it. `pose` may be
   *  null. */
  static boolean isReported(detection_t detection, object_pose_t pose) {
    if (pose == null) return detection.reported;
    return hasPose(pose) || (detection.reported && pose.status != object_pose_t.REFUTED);
  }

  static boolean hasPose(object_pose_t pose) {
    return pose.status == object_pose_t.VALID || pose.status == object_pose_t.VALID_UP_TO_SYMMETRY;
  }

  static object_pose_t poseOf(int detection, object_poses_t poses) {
    if (poses == null) return null;
    for (object_pose_t pose : poses.poses) {
      if (pose.detection_index == detection) return pose;
    }
    return null;
  }

  private static String[] row(detection_t detection, object_pose_t pose) {
    boolean valid = pose != null && hasPose(pose);
    float[] centre = detection.centre_camera;
    String place = valid ? place(pose.trans[0], pose.trans[1], pose.trans[2]) : place(centre[0], centre[1], centre[2]);
    return new String[] {detection.class_name, String.format("%.2f", detection.score), place,
        pose == null ? "-" : word(pose.status), pose == null ? "-" : String.format("%.2f", pose.quality)};
  }

  private static String place(double x, double y, double z) {
    return Double.isNaN(z) ? "-" : String.format("%.3f, %.3f, %.3f", x, y, z);
  }

  private static String word(int status) {
    return switch (status) {
      case object_pose_t.VALID -> "valid";
      case object_pose_t.NO_MODEL -> "no model";
      case object_pose_t.TOO_FEW_POINTS -> "too few points";
      case object_pose_t.NO_INITIAL_POSE -> "no initial pose";
      case object_pose_t.NOT_CONVERGED -> "not converged";
      case object_pose_t.REJECTED_BY_DEPTH -> "rejected by depth";
      case object_pose_t.LOW_SCORE -> "low score";
      case object_pose_t.REJECTED_BY_OUTLINE -> "rejected by outline";
      case object_pose_t.REJECTED_BY_COLOUR -> "rejected by colour";
      case object_pose_t.OCCLUDED -> "occluded";
      case object_pose_t.REFUTED -> "refuted";
      case object_pose_t.VALID_UP_TO_SYMMETRY -> "valid up to its shape's symmetry";
      default -> "status " + status;
    };
  }
}
