package houghstream.spy;

import java.awt.Color;
import java.awt.Graphics;
import java.awt.Graphics2D;
import java.awt.Rectangle;
import java.awt.RenderingHints;
import java.awt.image.BufferedImage;
import java.util.List;
import javax.swing.JComponent;

/** Shows pictures of one size as large as fits, beside or below each other, and what is drawn over the first. */
@SuppressWarnings("serial")
final class PicturePane extends JComponent {
  /** Draws over a picture whose pixel (0,0) has its centre at the origin; a picture's pixel is `scale` wide. */
  interface Overlay {
    void paint(Graphics2D graphics, double scale);
  }

  private static final int GAP = 4;
  private transient List<BufferedImage> pictures = List.of();
  private transient Overlay overlay = (graphics, scale) -> { };

  void show(List<BufferedImage> newPictures, Overlay newOverlay) {
    pictures = List.copyOf(newPictures);
    overlay = newOverlay;
    repaint();
  }

  @Override
  protected void paintComponent(Graphics base) {
    Graphics2D graphics = (Graphics2D) base.create();
    graphics.setColor(new Color(32, 34, 38));
    graphics.fillRect(0, 0, getWidth(), getHeight());
    graphics.setRenderingHint(RenderingHints.KEY_INTERPOLATION, RenderingHints.VALUE_INTERPOLATION_BILINEAR);
    graphics.setRenderingHint(RenderingHints.KEY_ANTIALIASING, RenderingHints.VALUE_ANTIALIAS_ON);
    graphics.setRenderingHint(RenderingHints.KEY_TEXT_ANTIALIASING, RenderingHints.VALUE_TEXT_ANTIALIAS_ON);
    List<Rectangle> places = places();
    for (int i = 0; i < places.size(); ++i) {
      Rectangle place = places.get(i);
      graphics.drawImage(pictures.get(i), place.x, place.y, place.width, place.height, null);
    }
    if (!places.isEmpty()) paintOverlay(graphics, places.get(0));
    graphics.dispose();
  }

  private void paintOverlay(Graphics2D graphics, Rectangle place) {
    double scale = (double) place.width / pictures.get(0).getWidth();
    graphics.clip(place);
    graphics.translate(place.x + 0.5 * scale, place.y + 0.5 * scale);
    overlay.paint(graphics, scale);
  }

  /** Where the pictures are drawn; empty where there is none, or no room. */
  List<Rectangle> places() {
    int count = pictures.size();
    if (count == 0) return List.of();
    double beside = scale(count, 1);
    double below = scale(1, count);
    boolean row = beside >= below;
    int width = (int) (Math.max(beside, below) * pictures.get(0).getWidth());
    int height = (int) (Math.max(beside, below) * pictures.get(0).getHeight());
    if (width <= 0 || height <= 0) return List.of();
    int left = (getWidth() - (row ? count * (width + GAP) - GAP : width)) / 2;
    int top = (getHeight() - (row ? height : count * (height + GAP) - GAP)) / 2;
    Rectangle[] places = new Rectangle[count];
    for (int i = 0; i < count; ++i) {
      places[i] = new Rectangle(left + (row ? i * (width + GAP) : 0), top + (row ? 0 : i * (height + GAP)), width, height);
    }
    return List.of(places);
  }

  private double scale(int columns, int rows) {
    double across = (double) (getWidth() - (columns - 1) * GAP) / (columns * pictures.get(0).getWidth());
    double down = (double) (getHeight() - (rows - 1) * GAP) / (rows * pictures.get(0).getHeight());
    return Math.min(across, down);
  }
}
