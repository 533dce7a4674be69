package houghstream.spy;

import houghstream.image_t;
import houghstream.spy.Wire.BadMessage;
import java.awt.BorderLayout;
import java.awt.Dimension;
import java.awt.FlowLayout;
import java.awt.image.BufferedImage;
import java.util.ArrayList;
import java.util.List;
import java.util.concurrent.atomic.AtomicReference;
import javax.swing.ButtonGroup;
import javax.swing.JComponent;
import javax.swing.JPanel;
import javax.swing.JRadioButton;
import javax.swing.SwingUtilities;

/** Shows the newest message of a channel of frames or of single images. */
final class PictureViewer implements Viewer {
  /** What a message shows. */
  record Content(long utime, BufferedImage colour, BufferedImage depth, String text, String complaint) {}

  /** Decodes a message. */
  interface Reader {
    Content read(byte[] bytes) throws BadMessage;
  }

  private enum Mode { BOTH, COLOUR, DEPTH }

  private final JPanel panel = new JPanel(new BorderLayout());
  private final PicturePane pane = new PicturePane();
  private final StatusLine status;
  private final Dimension size;
  private final Reader reader;
  private final AtomicReference<byte[]> newest = new AtomicReference<>();
  private final RateMeter arrivals = new RateMeter();
  private final List<AutoCloseable> running = new ArrayList<>();
  private Mode mode = Mode.BOTH;
  private Content shown;

  PictureViewer(String channel, Reader reader, Dimension size) {
    this.reader = reader;
    this.size = size;
    status = new StatusLine("waiting for " + channel);
    panel.add(pane, BorderLayout.CENTER);
    panel.add(status, BorderLayout.SOUTH);
  }

  static PictureViewer ofFrames(String channel) {
    PictureViewer viewer = new PictureViewer(channel, PictureViewer::readFrame, new Dimension(1100, 500));
    viewer.panel.add(viewer.modeButtons(), BorderLayout.NORTH);
    viewer.listen(channel);
    return viewer;
  }

  static PictureViewer ofImages(String channel) {
    PictureViewer viewer = new PictureViewer(channel, PictureViewer::readImage, new Dimension(1100, 640));
    viewer.listen(channel);
    return viewer;
  }

  private void listen(String channel) {
    Worker worker = Worker.start("viewer of " + channel, this::work);
    running.add(worker);
    running.add(new ChannelTap(channel, bytes -> {
      arrivals.count(RateMeter.nowUs());
      newest.set(bytes);
      worker.wake();
    }));
  }

  private void work() {
    byte[] bytes = newest.getAndSet(null);
    if (bytes == null) return;
    try {
      Content content = reader.read(bytes);
      SwingUtilities.invokeLater(() -> show(content));
    } catch (BadMessage bad) {
      SwingUtilities.invokeLater(() -> status.say("", bad.getMessage()));
    }
  }

  static Content readFrame(byte[] bytes) throws BadMessage {
    RgbdFrame frame = RgbdFrame.decode(bytes);
    String text = frame.depth == null ? "no depth" : frame.depth.summary();
    return new Content(frame.utime, frame.colour, frame.depth == null ? null : frame.depth.picture(), text,
        frame.complaint);
  }

  static Content readImage(byte[] bytes) throws BadMessage {
    image_t image = Wire.decode(bytes, "image_t", image_t::new);
    if (image.pixelformat == image_t.PIXEL_FORMAT_LE_GRAY16) {
      Depth depth = Depth.decode(image, false);
      return new Content(image.utime, null, depth.picture(), depth.summary(), "");
    }
    return new Content(image.utime, ImageDecoder.colour(image), null, String.format("%.1f kB", bytes.length * 1e-3), "");
  }

  /** Shows a message; on Swing's thread. */
  void show(Content content) {
    shown = content;
    List<BufferedImage> pictures = new ArrayList<>();
    if (content.colour != null && (mode != Mode.DEPTH || content.depth == null)) pictures.add(content.colour);
    if (content.depth != null && (mode != Mode.COLOUR || content.colour == null)) pictures.add(content.depth);
    pane.show(pictures, (graphics, scale) -> { });
    String pixels = pictures.isEmpty() ? "no picture"
        : pictures.get(0).getWidth() + "x" + pictures.get(0).getHeight();
    status.say(String.format("frame %.3f s, %s, %.1f Hz, %s", content.utime * 1e-6, pixels,
        arrivals.hertz(RateMeter.nowUs()), content.text), content.complaint);
  }

  private JComponent modeButtons() {
    JPanel buttons = new JPanel(new FlowLayout(FlowLayout.LEFT));
    ButtonGroup group = new ButtonGroup();
    for (Mode choice : Mode.values()) {
      JRadioButton button = new JRadioButton(choice.name().toLowerCase(), choice == mode);
      button.addActionListener(event -> {
        mode = choice;
        if (shown != null) show(shown);
      });
      group.add(button);
      buttons.add(button);
    }
    return buttons;
  }

  @Override
  public JComponent component() {
    return panel;
  }

  @Override
  public Dimension size() {
    return size;
  }

  @Override
  public void close() {
    Viewer.closeAll(running);
  }
}
