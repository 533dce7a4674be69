package houghstream.spy;

import houghstream.teaching_t;
import java.awt.BorderLayout;
import java.awt.Color;
import java.awt.Dimension;
import java.awt.FontMetrics;
import java.awt.Graphics;
import java.awt.Graphics2D;
import java.awt.RenderingHints;
import javax.swing.JComponent;

/** Shows how it goes with an object that is shown to be taught: from where it was seen, state, words and progress. */
final class TeachingViewer extends MessageViewer<teaching_t> {
  private final Spheres spheres = new Spheres();

  TeachingViewer() {
    super(bytes -> Wire.decode(bytes, "teaching_t", teaching_t::new), new Dimension(640, 420));
    panel.add(spheres, BorderLayout.CENTER);
    panel.add(status, BorderLayout.SOUTH);
  }

  @Override
  void show(teaching_t teaching) {
    spheres.teaching = teaching;
    spheres.repaint();
    boolean wrong = teaching.state == teaching_t.LOST || teaching.state == teaching_t.FAILED;
    String counts = String.format("%s: %s, %d frames, %d kept", teaching.name, word(teaching.state), teaching.n_frames,
        teaching.n_keyframes);
    status.say(wrong ? counts : counts + " - " + teaching.message, wrong ? teaching.message : "");
  }

  private static String word(byte state) {
    return switch (state) {
      case teaching_t.CHOOSING -> "choosing";
      case teaching_t.TRACKING -> "tracking";
      case teaching_t.LOST -> "lost";
      case teaching_t.FUSING -> "fusing";
      case teaching_t.TRAINING -> "training";
      case teaching_t.DONE -> "done";
      case teaching_t.FAILED -> "failed";
      default -> "state " + state;
    };
  }

  /** The sphere of directions from where the camera is and from behind, filled where the object was seen from. */
  @SuppressWarnings("serial")
  static final class Spheres extends JComponent {
    static final Color SEEN = new Color(60, 200, 110); // as in hs-view
    private static final Color UNSEEN = new Color(86, 90, 95);
    private static final Color GROUND = new Color(32, 34, 38);
    private static final int LINE = 26;
    private static final int BAR = 8;
    // From the front and a little above, while the pose is not known: rows are the view's x, y (down) and z (away).
    private static final double[] FROM_FRONT = {0, -1, 0, -0.447, 0, -0.894, 0.894, 0, -0.447};
    private transient teaching_t teaching;

    @Override
    protected void paintComponent(Graphics base) {
      Graphics2D graphics = (Graphics2D) base.create();
      graphics.setRenderingHint(RenderingHints.KEY_ANTIALIASING, RenderingHints.VALUE_ANTIALIAS_ON);
      graphics.setRenderingHint(RenderingHints.KEY_TEXT_ANTIALIASING, RenderingHints.VALUE_TEXT_ANTIALIAS_ON);
      graphics.setColor(GROUND);
      graphics.fillRect(0, 0, getWidth(), getHeight());
      if (teaching != null) paintTeaching(graphics);
      graphics.dispose();
    }

    private void paintTeaching(Graphics2D graphics) {
      int side = Math.max(0, Math.min(getWidth() / 2, getHeight() - 2 * LINE - BAR) - 10);
      double[] near = Double.isNaN(teaching.quat[0]) ? FROM_FRONT : DetectionOverlay.rotation(teaching.quat);
      double[] far = near.clone();
      for (int i = 0; i < 9; ++i) far[i] = i / 3 == 1 ? near[i] : -near[i];
      int left = getWidth() / 2 - side - 5;
      paintSphere(graphics, near, left + side / 2, LINE + side / 2, side / 2);
      paintSphere(graphics, far, left + 10 + side + side / 2, LINE + side / 2, side / 2);
      int seen = 0;
      for (byte direction : teaching.seen) seen += direction == 0 ? 0 : 1;
      graphics.setColor(Color.WHITE);
      paintText(graphics, "from here", left + side / 2, LINE - 8);
      paintText(graphics, "from behind", left + 10 + side + side / 2, LINE - 8);
      paintText(graphics, "seen from " + seen + " of " + teaching.n_directions + " directions", getWidth() / 2,
          2 * LINE + side - 8);
      graphics.setColor(SEEN);
      if (teaching.progress >= 0) { // not NaN
        graphics.fillRect(0, getHeight() - BAR, (int) (Math.min(1, teaching.progress) * getWidth()), BAR);
      }
    }

    private static void paintText(Graphics2D graphics, String text, int middle, int baseline) {
      FontMetrics font = graphics.getFontMetrics();
      graphics.drawString(text, middle - font.stringWidth(text) / 2, baseline);
    }

    private void paintSphere(Graphics2D graphics, double[] view, int x, int y, int radius) {
      graphics.setColor(UNSEEN);
      graphics.drawOval(x - radius, y - radius, 2 * radius, 2 * radius);
      for (int i = 0; i < teaching.n_directions; ++i) {
        float[] direction = teaching.directions[i];
        double[] at = new double[3];
        for (int k = 0; k < 9; ++k) at[k / 3] += view[k] * direction[k % 3];
        if (!(at[2] <= 0)) continue; // away from the camera, or no direction
        int dot = Math.max(1, (int) (radius * (0.07 - 0.07 * Math.max(at[2], -1))));
        graphics.setColor(teaching.seen[i] == 0 ? UNSEEN : SEEN);
        graphics.fillOval((int) (x + 0.86 * radius * at[0]) - dot, (int) (y + 0.86 * radius * at[1]) - dot, 2 * dot,
            2 * dot);
      }
    }
  }
}
