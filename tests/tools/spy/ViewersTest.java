package houghstream.spy;

import houghstream.detections_t;
import houghstream.images_t;
import houghstream.object_pose_t;
import houghstream.object_poses_t;
import houghstream.teaching_t;
import houghstream.tracked_object_t;
import houghstream.spy.Wire.BadMessage;
import java.awt.Color;
import java.awt.Component;
import java.awt.Container;
import java.awt.Dimension;
import java.awt.image.BufferedImage;
import java.util.List;
import java.util.Random;

/** What the viewers draw, without a display. */
public final class ViewersTest {
  private static final int[][] SIZES = {{0, 0}, {1, 1}, {3, 200}, {300, 240}, {1200, 300}, {240, 900}};

  private ViewersTest() {}

  public static void main(String[] arguments) {
    ImagesTest.run();
    PluginsTest.run();
    Check.test("box and axes are drawn where they belong", ViewersTest::overlay);
    Check.test("candidates are drawn where a pose confirms them", ViewersTest::candidates);
    Check.test("pictures fit every size", ViewersTest::sizes);
    Check.test("the panel of detections survives every size", ViewersTest::panel);
    Check.test("the sphere fills from where the object was seen", ViewersTest::teaching);
    Check.test("the world is drawn from above, with state and reason", ViewersTest::world);
    Check.test("damaged detections and poses do no harm", ViewersTest::damaged);
    Check.end();
  }

  static byte[] frame(long utime) throws Exception {
    images_t message = Samples.frame(Samples.jpeg(9), images_t.DEPTH_MM, Samples.depth(900, 0));
    message.utime = utime;
    return Samples.bytes(message);
  }

  private static BufferedImage painted(Component component, int width, int height) {
    component.setSize(width, height);
    layOut(component);
    BufferedImage picture = new BufferedImage(Math.max(width, 1), Math.max(height, 1), BufferedImage.TYPE_INT_RGB);
    component.paint(picture.createGraphics());
    return picture;
  }

  private static void layOut(Component component) {
    component.doLayout();
    if (component instanceof Container container) {
      for (Component part : container.getComponents()) layOut(part);
    }
  }

  private static int count(BufferedImage picture, Color colour) {
    int found = 0;
    for (int y = 0; y < picture.getHeight(); ++y) {
      for (int x = 0; x < picture.getWidth(); ++x) {
        if (picture.getRGB(x, y) == colour.getRGB()) ++found;
      }
    }
    return found;
  }

  private static BufferedImage drawn(byte status, double minScore) throws Exception {
    return drawn(Samples.detections(5), status, minScore);
  }

  private static BufferedImage drawn(detections_t detections, byte status, double minScore) throws Exception {
    RgbdFrame frame = RgbdFrame.decode(frame(5));
    PicturePane pane = new PicturePane();
    pane.show(List.of(frame.colour),
        new DetectionOverlay(detections, Samples.poses(5, status), frame.camera, minScore));
    return painted(pane, 10 * Samples.WIDTH, 10 * Samples.HEIGHT);
  }

  private static void candidates() throws Exception {
    detections_t detections = Samples.detections(5);
    detections.detections[0].reported = false;
    BufferedImage confirmed = drawn(detections, object_pose_t.VALID, 0.0);
    Check.that(count(confirmed, DetectionOverlay.classColour(4)) > 50, "its pose is valid");
    BufferedImage open = drawn(detections, object_pose_t.REJECTED_BY_DEPTH, 0.0);
    Check.equal(count(open, DetectionOverlay.classColour(4)), 0);
    ObjectsTable table = new ObjectsTable();
    table.show(detections, Samples.poses(5, object_pose_t.VALID), 0.0);
    Check.equal(table.getRowCount(), 1);
    table.show(detections, null, 0.0);
    Check.equal(table.getRowCount(), 0);
  }

  private static void overlay() throws Exception {
    BufferedImage valid = drawn(object_pose_t.VALID, 0.75);
    // The box's lower edge, at y = 38 of the frame, and the middle of the x axis, which points to the right.
    Check.equal(valid.getRGB(10 * 32 + 5, 10 * 38 + 5), DetectionOverlay.classColour(4).getRGB());
    Check.equal(valid.getRGB(10 * 35 + 5, 10 * 24 + 5), DetectionOverlay.AXIS_COLOURS[0].getRGB());
    Check.that(count(valid, DetectionOverlay.AXIS_COLOURS[1]) > 50, "y axis");
    Check.equal(count(drawn(object_pose_t.REJECTED_BY_DEPTH, 0.5), DetectionOverlay.AXIS_COLOURS[0]), 0);
    BufferedImage weak = drawn(object_pose_t.VALID, 0.8);
    Check.equal(count(weak, DetectionOverlay.classColour(4)) + count(weak, DetectionOverlay.AXIS_COLOURS[0]), 0);
    double[] turned = DetectionOverlay.rotation(new double[] {Math.sqrt(0.5), 0, 0, Math.sqrt(0.5)});
    Check.that(Math.abs(turned[3] - 1) < 1e-12, "a quarter turn about z takes x to y");
  }

  private static void sizes() throws Exception {
    RgbdFrame frame = RgbdFrame.decode(frame(5));
    PicturePane pane = new PicturePane();
    pane.show(List.of(frame.colour, frame.depth.picture()), (graphics, scale) -> { });
    for (int[] size : SIZES) {
      painted(pane, size[0], size[1]);
      pane.places().forEach(place -> Check.that(place.x >= 0 && place.y >= 0 && place.x + place.width <= size[0]
          && place.y + place.height <= size[1], place + " in " + size[0] + "x" + size[1]));
    }
    Check.that(pane.places().get(0).y < pane.places().get(1).y, "below each other where it is narrow");
  }

  private static void panel() throws Exception {
    DetectionPanel panel = new DetectionPanel(camera -> { });
    for (int[] size : SIZES) painted(panel.component(), size[0], size[1]);
    RgbdFrame frame = RgbdFrame.decode(frame(5));
    detections_t detections = Samples.detections(5);
    object_poses_t poses = Samples.poses(5, (byte) 77); // a status from the future
    poses.poses[0].detection_index = 12; // of a detection that is not there
    panel.show(new DetectionPanel.Shown(frame.colour, detections, poses, null));
    for (int[] size : SIZES) painted(panel.component(), size[0], size[1]);
    Dimension least = panel.component().getMinimumSize();
    Check.that(least.width > 0 && least.height > 0, "a smallest size");
  }

  private static void world() {
    WorldViewer viewer = new WorldViewer();
    for (int[] size : SIZES) painted(viewer.component(), size[0], size[1]); // before anything comes
    viewer.show(Samples.world(tracked_object_t.VISIBLE));
    Check.that(count(painted(viewer.component(), 640, 600), WorldViewer.Map.SEEN) > 50, "an object that is seen");
    Check.equal(viewer.said(), "1 objects in WORLD after a frame of LEFT");
    Check.equal(viewer.table().getValueAt(0, 2), "visible");
    viewer.show(Samples.world(tracked_object_t.HIDDEN));
    Check.equal(count(painted(viewer.component(), 640, 600), WorldViewer.Map.SEEN), 0);
    Check.equal(viewer.table().getValueAt(0, 6), "occluded by a nearer surface");
    viewer.show(Samples.world((byte) 99));
    viewer.close();
  }

  private static void teaching() {
    TeachingViewer viewer = new TeachingViewer();
    for (int[] size : SIZES) painted(viewer.component(), size[0], size[1]); // before anything comes
    viewer.show(Samples.teaching(teaching_t.TRACKING));
    BufferedImage picture = painted(viewer.component(), 640, 400);
    Check.that(count(picture.getSubimage(0, 0, 320, 350), TeachingViewer.Spheres.SEEN) > 500, "the near side");
    Check.equal(count(picture.getSubimage(330, 0, 310, 350), TeachingViewer.Spheres.SEEN), 0); // the far side
    Check.equal(viewer.said(), "mug: tracking, 70 frames, 7 kept - from behind nothing yet");
    viewer.show(Samples.teaching(teaching_t.LOST));
    Check.equal(viewer.said(), "mug: lost, 70 frames, 7 kept - from behind nothing yet");
    teaching_t odd = Samples.teaching((byte) 99);
    odd.progress = Float.NaN;
    odd.quat = new double[] {Double.NaN, 0, 0, 0};
    odd.directions[2][1] = Float.NaN;
    viewer.show(odd);
    for (int[] size : SIZES) painted(viewer.component(), size[0], size[1]);
  }

  // Whatever can be decoded can be drawn: boxes of NaN, of astronomic size, poses inside out.
  private static void damaged() throws Exception {
    byte[] detections = Samples.bytes(Samples.detections(5));
    byte[] poses = Samples.bytes(Samples.poses(5, object_pose_t.VALID));
    RgbdFrame frame = RgbdFrame.decode(frame(5));
    DetectionPanel panel = new DetectionPanel(camera -> { });
    Random random = new Random(1);
    int shown = 0;
    for (int i = 0; i < 80; ++i) {
      try {
        detections_t odd = Wire.decode(damaged(detections, random), "detections_t", detections_t::new);
        object_poses_t oddPoses = Wire.decode(damaged(poses, random), "object_poses_t", object_poses_t::new);
        panel.show(new DetectionPanel.Shown(frame.colour, odd, oddPoses, frame.camera));
        painted(panel.component(), 800, 300);
        ++shown;
      } catch (BadMessage refused) {
        Check.that(refused.getMessage().startsWith("damaged"), refused.getMessage());
      }
    }
    Check.that(shown > 10 && shown < 70, shown + " of 80 shown");
  }

  private static byte[] damaged(byte[] good, Random random) {
    byte[] bad = good.clone();
    for (int i = 0; i < 3; ++i) bad[8 + random.nextInt(bad.length - 8)] = (byte) random.nextInt();
    return bad;
  }
}
