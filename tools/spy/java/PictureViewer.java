package houghstream.spy;

import houghstream.image_t;
import houghstream.spy.Wire.BadMessage;
import java.awt.BorderLayout;
import java.awt.Dimension;
import java.awt.FlowLayout;
import java.awt.image.BufferedImage;
import java.util.ArrayList;
import java.util.List;
import javax.swing.ButtonGroup;
import javax.swing.JComponent;
import javax.swing.JPanel;
import javax.swing.JRadioButton;

/** Shows the newest message of a channel of frames or of single images. */
final class PictureViewer extends MessageViewer<PictureViewer.Content> {
  /** What a message shows. */
  record Content(long utime, BufferedImage colour, BufferedImage depth, String text, String complaint) {}

  private enum Mode { BOTH, COLOUR, DEPTH }

  private final PicturePane pane = new PicturePane();
  private Mode mode = Mode.BOTH;
  private Content shown;

  private PictureViewer(Reader<Content> reader, Dimension size) {
    super(reader, size);
    panel.add(pane, BorderLayout.CENTER);
    panel.add(status, BorderLayout.SOUTH);
  }

  static PictureViewer ofFrames() {
    PictureViewer viewer = new PictureViewer(PictureViewer::readFrame, new Dimension(1100, 500));
    viewer.panel.add(viewer.modeButtons(), BorderLayout.NORTH);
    return viewer;
  }

  static PictureViewer ofImages() {
    return new PictureViewer(PictureViewer::readImage, new Dimension(1100, 640));
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

  @Override
  void show(Content content) {
    shown = content;
    List<BufferedImage> pictures = new ArrayList<>();
    if (content.colour != null && (mode != Mode.DEPTH || content.depth == null)) pictures.add(content.colour);
    if (content.depth != null && (mode != Mode.COLOUR || content.colour == null)) pictures.add(content.depth);
    pane.show(pictures, (graphics, scale) -> { });
    String pixels = pictures.isEmpty() ? "no picture"
        : pictures.get(0).getWidth() + "x" + pictures.get(0).getHeight();
    status.say(String.format("frame %.3f s, %s, %.1f Hz, %s", content.utime * 1e-6, pixels,
        hertz(), content.text), content.complaint);
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
}
