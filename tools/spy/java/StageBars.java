package houghstream.spy;

import houghstream.stage_time_t;
import java.awt.Color;
import java.awt.Dimension;
import java.awt.FontMetrics;
import java.awt.Graphics;
import java.awt.Graphics2D;
import java.awt.RenderingHints;
import java.util.LinkedHashMap;
import java.util.Map;
import javax.swing.JComponent;

/** A row per stage: its time for this frame, its mean over the last ones, and a bar of the time. */
@SuppressWarnings("serial")
final class StageBars extends JComponent {
  private static final Color BAR = new Color(120, 170, 220);
  private static final double NEWEST_SHARE = 0.1; // of the running mean
  private final transient Map<String, Double> meansMs = new LinkedHashMap<>();
  private transient stage_time_t[] stages = {};

  void show(stage_time_t[] newStages) {
    stages = newStages;
    for (stage_time_t stage : stages) {
      double ms = stage.duration_us * 1e-3;
      meansMs.merge(stage.stage, ms, (mean, newest) -> mean + NEWEST_SHARE * (newest - mean));
    }
    meansMs.keySet().removeIf(name -> java.util.Arrays.stream(stages).noneMatch(stage -> stage.stage.equals(name)));
    setPreferredSize(new Dimension(300, (stages.length + 2) * rowHeight()));
    revalidate();
    repaint();
  }

  private int rowHeight() {
    return getFontMetrics(getFont()).getHeight() + 4;
  }

  @Override
  protected void paintComponent(Graphics base) {
    Graphics2D graphics = (Graphics2D) base.create();
    graphics.setRenderingHint(RenderingHints.KEY_TEXT_ANTIALIASING, RenderingHints.VALUE_TEXT_ANTIALIAS_ON);
    graphics.setColor(Color.WHITE);
    graphics.fillRect(0, 0, getWidth(), getHeight());
    double longest = 1e-6;
    double sum = 0;
    double sumOfMeans = 0;
    for (stage_time_t stage : stages) {
      longest = Math.max(longest, stage.duration_us * 1e-3);
      sum += stage.duration_us * 1e-3;
      sumOfMeans += meansMs.get(stage.stage);
    }
    paintRow(graphics, 0, "stage", "ms", "mean ms", 0);
    int row = 1;
    for (stage_time_t stage : stages) {
      double ms = stage.duration_us * 1e-3;
      paintRow(graphics, row++, stage.stage, format(ms), format(meansMs.get(stage.stage)), ms / longest);
    }
    if (stages.length > 0) paintRow(graphics, row, "all stages", format(sum), format(sumOfMeans), 0);
    graphics.dispose();
  }

  private void paintRow(Graphics2D graphics, int row, String name, String ms, String mean, double share) {
    int top = row * rowHeight();
    graphics.setColor(BAR);
    graphics.fillRect(0, top + 1, (int) (Math.max(0, share) * getWidth()), rowHeight() - 2);
    graphics.setColor(Color.BLACK);
    FontMetrics font = graphics.getFontMetrics();
    int baseline = top + font.getAscent() + 2;
    graphics.drawString(name, 6, baseline);
    graphics.drawString(ms, getWidth() - 80 - font.stringWidth(ms), baseline);
    graphics.drawString(mean, getWidth() - 6 - font.stringWidth(mean), baseline);
  }

  private static String format(double ms) {
    return String.format("%.1f", ms);
  }
}
