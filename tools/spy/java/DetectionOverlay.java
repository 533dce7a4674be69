package houghstream.spy;

import houghstream.camera_t;
import houghstream.detection_t;
import houghstream.detections_t;
import houghstream.object_pose_t;
import houghstream.object_poses_t;
import java.awt.BasicStroke;
import java.awt.Color;
import java.awt.FontMetrics;
import java.awt.Graphics2D;
import java.awt.geom.Line2D;
import java.awt.geom.Rectangle2D;

/** Boxes, names and scores of detections, and the axes of valid poses where the camera is known. */
final class DetectionOverlay implements PicturePane.Overlay {
  static final Color[] AXIS_COLOURS = {new Color(255, 60, 60), new Color(60, 220, 60), new Color(60, 120, 255)};
  private static final int[] CLASS_COLOURS =
      {0xE69F00, 0x56B4E9, 0x009E73, 0xF0E442, 0x0072B2, 0xD55E00, 0xCC79A7, 0xFFFFFF};
  private static final double AXIS_M = 0.06;
  private static final double NEAR_M = 0.05; // nothing nearer is drawn
  private final detections_t detections;
  private final object_poses_t poses;
  private final camera_t camera;
  private final double minScore;

  /** `poses` and `camera` may be null. Detections with scores below `minScore` or not reported, and their poses, are not drawn. */
  DetectionOverlay(detections_t detections, object_poses_t poses, camera_t camera, double minScore) {
    this.detections = detections;
    this.poses = poses;
    this.camera = camera;
    this.minScore = minScore;
  }

  @Override
  public void paint(Graphics2D graphics, double scale) {
    for (int i = 0; i < detections.n_detections; ++i) {
      if (isShown(i)) paintBox(graphics, detections.detections[i], scale);
    }
    if (poses != null && camera != null) {
      for (object_pose_t pose : poses.poses) {
        if (pose.detection_score >= minScore) paintAxes(graphics, pose, scale);
      }
    }
    // Weakest first: nothing covers the name of the surest object.
    for (int i = detections.n_detections; i-- > 0;) {
      if (isShown(i)) paintLabel(graphics, detections.detections[i], scale);
    }
  }

  private boolean isShown(int i) {
    detection_t detection = detections.detections[i];
    return detection.score >= minScore && ObjectsTable.isReported(detection, ObjectsTable.poseOf(i, poses));
  }

  private static void paintBox(Graphics2D graphics, detection_t detection, double scale) {
    Rectangle2D box = new Rectangle2D.Double(detection.box_x * scale, detection.box_y * scale,
        detection.box_width * scale, detection.box_height * scale);
    graphics.setColor(Color.BLACK);
    graphics.setStroke(new BasicStroke(4.0F));
    graphics.draw(box);
    graphics.setColor(classColour(detection.class_id));
    graphics.setStroke(new BasicStroke(2.0F));
    graphics.draw(box);
  }

  private static void paintLabel(Graphics2D graphics, detection_t detection, double scale) {
    String text = String.format("%s %.2f", detection.class_name, detection.score);
    FontMetrics font = graphics.getFontMetrics();
    int left = (int) (detection.box_x * scale) - 1;
    int top = Math.max(0, (int) (detection.box_y * scale) - font.getHeight());
    Color colour = classColour(detection.class_id);
    graphics.setColor(colour);
    graphics.fillRect(left, top, font.stringWidth(text) + 6, font.getHeight());
    graphics.setColor(textColourOn(colour));
    graphics.drawString(text, left + 3, top + font.getAscent());
  }

  private void paintAxes(Graphics2D graphics, object_pose_t pose, double scale) {
    if (!ObjectsTable.hasPose(pose)) return;
    double[] rotation = rotation(pose.quat);
    for (int axis = 0; axis < 3; ++axis) {
      double[] tip = new double[3];
      for (int row = 0; row < 3; ++row) tip[row] = pose.trans[row] + AXIS_M * rotation[3 * row + axis];
      if (!(pose.trans[2] > NEAR_M) || !(tip[2] > NEAR_M)) continue; // NaN too
      Line2D line = new Line2D.Double(x(pose.trans) * scale, y(pose.trans) * scale, x(tip) * scale, y(tip) * scale);
      graphics.setColor(Color.BLACK);
      graphics.setStroke(new BasicStroke(5.0F));
      graphics.draw(line);
      graphics.setColor(AXIS_COLOURS[axis]);
      graphics.setStroke(new BasicStroke(3.0F));
      graphics.draw(line);
    }
  }

  private double x(double[] point) {
    return camera.cx + camera.fx * point[0] / point[2];
  }

  private double y(double[] point) {
    return camera.cy + camera.fy * point[1] / point[2];
  }

  /** The rotation matrix, row by row, of a unit quaternion w, x, y, z. */
  static double[] rotation(double[] quat) {
    double w = quat[0];
    double x = quat[1];
    double y = quat[2];
    double z = quat[3];
    return new double[] {
        1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),
        2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
        2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)};
  }

  /** The same as in hs-view: eight that stay apart for colour-blind eyes (Okabe and Ito 2008). */
  static Color classColour(int classId) {
    return new Color(CLASS_COLOURS[Math.floorMod(classId - 1, CLASS_COLOURS.length)]);
  }

  // Black or white, whichever can be read on it.
  private static Color textColourOn(Color background) {
    double brightness = 0.299 * background.getRed() + 0.587 * background.getGreen() + 0.114 * background.getBlue();
    return brightness > 130 ? Color.BLACK : Color.WHITE;
  }
}
