package houghstream.spy;

import houghstream.object_pose_t;

/** Words for object_pose_t.status. */
final class PoseStatus {
  private PoseStatus() {}

  static String text(int status) {
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
      default -> "status " + status;
    };
  }
}
