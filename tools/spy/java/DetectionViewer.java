package houghstream.spy;

import houghstream.camera_t;
import houghstream.detections_t;
import houghstream.object_poses_t;
import houghstream.spy.Wire.BadMessage;
import java.awt.Dimension;
import java.awt.image.BufferedImage;
import java.util.ArrayList;
import java.util.HashSet;
import java.util.List;
import java.util.Set;
import javax.swing.JComponent;
import javax.swing.SwingUtilities;

/** Listens to detections, poses and their frames, and shows the newest that belong together. */
final class DetectionViewer implements Viewer {
  private static final String DETECTIONS = "HOUGHSTREAM_DETECTIONS";
  private static final String POSES = "HOUGHSTREAM_POSES";
  private static final Dimension PICTURE_SIZE = new Dimension(640, 480); // until a frame tells

  private final DetectionPanel panel = new DetectionPanel(this::choose);
  private final ResultMatcher matcher = new ResultMatcher();
  private final RateMeter arrivals = new RateMeter();
  private final List<AutoCloseable> running = new ArrayList<>();
  private final Worker worker = Worker.start("viewer of detections", this::work);
  private final Set<String> followed = new HashSet<>();
  private ResultMatcher.Entry drawn;
  private int drawnChanges;
  private BufferedImage blank = new BufferedImage(PICTURE_SIZE.width, PICTURE_SIZE.height, BufferedImage.TYPE_INT_RGB);
  private volatile String problem = "";

  private DetectionViewer() {}

  /** `channel` carries detections or poses, as its fingerprint tells; the other one has its usual name. */
  static DetectionViewer open(String channel, long fingerprint) {
    boolean posesChosen = fingerprint == object_poses_t.LCM_FINGERPRINT;
    DetectionViewer viewer = new DetectionViewer();
    synchronized (viewer.running) {
      viewer.running.add(viewer.worker);
      viewer.running.add(new ChannelTap(posesChosen ? DETECTIONS : channel, viewer::takeDetections));
      viewer.running.add(new ChannelTap(posesChosen ? channel : POSES, viewer::takePoses));
    }
    return viewer;
  }

  private void takeDetections(byte[] bytes) {
    take(() -> {
      detections_t detections = Wire.decode(bytes, "detections_t", detections_t::new);
      arrivals.count(RateMeter.nowUs());
      followFrames(detections.source_channel);
      matcher.addDetections(detections);
    });
  }

  private void takePoses(byte[] bytes) {
    take(() -> {
      object_poses_t poses = Wire.decode(bytes, "object_poses_t", object_poses_t::new);
      followFrames(poses.source_channel);
      matcher.addPoses(poses, RateMeter.nowUs());
    });
  }

  private void choose(String camera) {
    matcher.choose(camera);
    worker.wake();
  }

  private interface Step {
    void run() throws BadMessage;
  }

  private void take(Step step) {
    try {
      step.run();
      problem = "";
    } catch (BadMessage bad) {
      problem = bad.getMessage();
    }
    worker.wake();
  }

  // The results say which channels their frames came on. Subscribing from within a handler is left to the worker's
  // thread: LCM holds its list of listeners meanwhile.
  private synchronized void followFrames(String channel) {
    if (channel.isEmpty() || !followed.add(channel)) return;
    SwingUtilities.invokeLater(() -> {
      synchronized (running) {
        if (running.isEmpty()) return;
        running.add(new ChannelTap(channel, bytes -> take(() -> matcher.addFrame(channel, bytes))));
      }
    });
  }

  private void work() {
    ResultMatcher.Snapshot newest = matcher.snapshot(RateMeter.nowUs());
    String said = problem;
    if (newest == null || newest.entry() == drawn && newest.changes() == drawnChanges && said.isEmpty()) {
      if (!said.isEmpty()) SwingUtilities.invokeLater(() -> panel.complain(said));
      return;
    }
    drawn = newest.entry();
    drawnChanges = newest.changes();
    List<String> cameras = matcher.cameras();
    RgbdFrame frame = frameOf(newest);
    BufferedImage picture = frame == null || frame.colour == null ? blank : frame.colour;
    if (picture != blank && picture.getWidth() != blank.getWidth()) {
      blank = new BufferedImage(picture.getWidth(), picture.getHeight(), BufferedImage.TYPE_INT_RGB);
    }
    DetectionPanel.Shown shown = shown(newest, picture, frame == null ? null : frame.camera);
    String channel = newest.entry().id.channel();
    String text = String.format("%s, frame %.3f s, %.1f results a second, %d %% of their frames arrived",
        channel, newest.entry().utime * 1e-6, arrivals.hertz(RateMeter.nowUs()), matcher.arrivedPercent());
    String complaint = said.isEmpty() ? complaint(newest, frame) : said;
    SwingUtilities.invokeLater(() -> {
      panel.offer(cameras, channel);
      panel.show(shown);
      panel.say(text, complaint);
    });
  }

  private static DetectionPanel.Shown shown(ResultMatcher.Snapshot newest, BufferedImage picture, camera_t camera) {
    if (newest.followed() == null) {
      return new DetectionPanel.Shown(picture, newest.detections(), newest.poses(), camera);
    }
    object_poses_t poses = ResultMatcher.valid(newest.followed());
    return new DetectionPanel.Shown(picture, ResultMatcher.boxed(poses, camera), poses, camera);
  }

  private RgbdFrame frameOf(ResultMatcher.Snapshot newest) {
    if (newest.frame() == null) return null;
    try {
      return RgbdFrame.decode(newest.frame());
    } catch (BadMessage bad) {
      problem = bad.getMessage();
      return null;
    }
  }

  private String complaint(ResultMatcher.Snapshot newest, RgbdFrame frame) {
    if (newest.frame() == null) {
      return "Java's receive buffer is too small for frames; HOUGHSTREAM_PREVIEW fits";
    }
    if (frame == null) return problem;
    return frame.camera == null ? "the frame names no camera: no axes" : frame.complaint;
  }

  @Override
  public JComponent component() {
    return panel.component();
  }

  @Override
  public Dimension size() {
    return new Dimension(1240, 620);
  }

  @Override
  public void close() {
    synchronized (running) {
      Viewer.closeAll(running);
    }
  }
}
