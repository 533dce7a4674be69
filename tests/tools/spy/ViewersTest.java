package houghstream.spy;

import houghstream.detections_t;
import houghstream.image_t;
import houghstream.images_t;
import houghstream.object_pose_t;
import houghstream.object_poses_t;
import java.awt.Color;
import java.awt.Component;
import java.awt.Container;
import java.awt.Dimension;
import java.awt.image.BufferedImage;
import java.util.List;
import javax.swing.JDesktopPane;
import lcm.spy.SpyPlugin;

/** The plug-ins as spy asks for them, and what the viewers draw, without a display. */
public final class ViewersTest {
  private static final int[][] SIZES = {{0, 0}, {1, 1}, {3, 200}, {300, 240}, {1200, 300}, {240, 900}};

  private ViewersTest() {}

  public static void main(String[] arguments) {
    ImagesTest.run();
    Check.test("plug-ins tell name and types without a place", ViewersTest::plugins);
    Check.test("frames, detections and poses meet by utime", ViewersTest::matching);
    Check.test("box and axes are drawn where they belong", ViewersTest::overlay);
    Check.test("pictures fit every size", ViewersTest::sizes);
    Check.test("the panel of detections survives every size", ViewersTest::panel);
    Check.end();
  }

  private static void plugins() {
    SpyPlugin[] plugins = {new RgbdPlugin(), new ImagePlugin(), new DetectionPlugin()};
    long[] types = {images_t.LCM_FINGERPRINT, image_t.LCM_FINGERPRINT, detections_t.LCM_FINGERPRINT};
    for (int i = 0; i < plugins.length; ++i) {
      for (int k = 0; k < types.length; ++k) Check.equal(plugins[i].canHandle(types[k]), i == k);
      Check.that(plugins[i].getAction(null, null).getValue("Name") instanceof String, "a name");
      plugins[i].getAction(null, null).actionPerformed(null);
      plugins[i].getAction(new JDesktopPane(), null).actionPerformed(null);
    }
    Check.that(plugins[2].canHandle(object_poses_t.LCM_FINGERPRINT), "poses");
  }

  private static void matching() throws Exception {
    ResultMatcher matcher = new ResultMatcher();
    Check.equal(matcher.newest(0), null);
    matcher.addFrame(frame(10));
    matcher.addDetections(Samples.detections(10));
    Check.equal(matcher.newest(0).utime, 10L); // poses never came: detections alone
    matcher.addPoses(Samples.poses(10, object_pose_t.VALID), 0);
    matcher.addDetections(Samples.detections(20));
    Check.equal(matcher.newest(1).utime, 10L); // poses of 20 are still to come
    Check.equal(matcher.newest(9_000_000).utime, 10L); // 20 came without its frame
    matcher.addDetections(Samples.detections(3_000_000));
    Check.equal(matcher.newest(9_000_000).utime, 3_000_000L); // a second later the frame of 10 is too old
    Check.equal(matcher.arrivedPercent(), 33);
    for (int i = 0; i < 200; ++i) matcher.addFrame(frame(i)); // a log that is played again, from an earlier time
    matcher.addDetections(Samples.detections(150));
    Check.equal(matcher.newest(9_000_000).utime, 150L);
    Check.refused("message of 8 bytes", () -> matcher.addFrame(new byte[8]));
  }

  private static byte[] frame(long utime) throws Exception {
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

  private static BufferedImage drawn(byte status) throws Exception {
    RgbdFrame frame = RgbdFrame.decode(frame(5));
    PicturePane pane = new PicturePane();
    pane.show(List.of(frame.colour),
        new DetectionOverlay(Samples.detections(5), Samples.poses(5, status), frame.camera));
    return painted(pane, 10 * Samples.WIDTH, 10 * Samples.HEIGHT);
  }

  private static void overlay() throws Exception {
    BufferedImage valid = drawn(object_pose_t.VALID);
    // The box's lower edge, at y = 38 of the frame, and the middle of the x axis, which points to the right.
    Check.equal(valid.getRGB(10 * 32 + 5, 10 * 38 + 5), ClassColours.of(4).getRGB());
    Check.equal(valid.getRGB(10 * 35 + 5, 10 * 24 + 5), DetectionOverlay.AXIS_COLOURS[0].getRGB());
    Check.that(count(valid, DetectionOverlay.AXIS_COLOURS[1]) > 50, "y axis");
    Check.equal(count(drawn(object_pose_t.REJECTED_BY_DEPTH), DetectionOverlay.AXIS_COLOURS[0]), 0);
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
    DetectionPanel panel = new DetectionPanel();
    for (int[] size : SIZES) painted(panel.component(), size[0], size[1]);
    RgbdFrame frame = RgbdFrame.decode(frame(5));
    detections_t detections = Samples.detections(5);
    object_poses_t poses = Samples.poses(5, (byte) 77); // a status from the future
    poses.poses[0].detection_index = 12; // of a detection that is not there
    panel.show(frame.colour, new DetectionOverlay(detections, poses, null), detections, poses, poses.stages);
    for (int[] size : SIZES) painted(panel.component(), size[0], size[1]);
    Dimension least = panel.component().getMinimumSize();
    Check.that(least.width > 0 && least.height > 0, "a smallest size");
  }
}
