package houghstream.spy;

import houghstream.camera_t;
import houghstream.detections_t;
import houghstream.object_poses_t;
import houghstream.stage_time_t;
import java.awt.BorderLayout;
import java.awt.Color;
import java.awt.Dimension;
import java.awt.FlowLayout;
import java.awt.FontMetrics;
import java.awt.Graphics;
import java.awt.Graphics2D;
import java.awt.RenderingHints;
import java.awt.event.ComponentAdapter;
import java.awt.event.ComponentEvent;
import java.awt.image.BufferedImage;
import java.util.Arrays;
import java.util.LinkedHashMap;
import java.util.List;
import java.util.Map;
import java.util.function.Consumer;
import javax.swing.JComboBox;
import javax.swing.JComponent;
import javax.swing.JLabel;
import javax.swing.JPanel;
import javax.swing.JScrollPane;
import javax.swing.JSpinner;
import javax.swing.JSplitPane;
import javax.swing.JTable;
import javax.swing.SpinnerNumberModel;

/** The picture with its overlay, beside it the objects and the stages' times. */
final class DetectionPanel {
  /** Everything about one frame; `poses` and `camera` may be null. */
  record Shown(BufferedImage picture, detections_t detections, object_poses_t poses, camera_t camera) {}

  private static final int RIGHT_WIDTH = 500;
  private static final int RIGHT_HEIGHT = 320;
  private static final int[] COLUMN_WIDTHS = {100, 50, 150, 140, 60};
  private final PicturePane pane = new PicturePane();
  private final ObjectsTable objects = new ObjectsTable();
  private final StageBars stages = new StageBars();
  private final StatusLine status = new StatusLine("waiting for detections");
  private final JSpinner leastScore = new JSpinner(new SpinnerNumberModel(0.0, 0.0, 1.0, 0.05));
  private final JComboBox<String> camera = new JComboBox<>();
  private final Consumer<String> chooseCamera;
  private boolean offering; // what the box says meanwhile is not the user's choice
  private Shown shown;
  private final JPanel panel = new JPanel(new BorderLayout());

  /** `chooseCamera` is told when the user asks for another camera. */
  DetectionPanel(Consumer<String> chooseCamera) {
    this.chooseCamera = chooseCamera;
    JTable table = new JTable(objects);
    table.setDefaultEditor(Object.class, null); // only to be read
    for (int i = 0; i < COLUMN_WIDTHS.length; ++i) {
      table.getColumnModel().getColumn(i).setPreferredWidth(COLUMN_WIDTHS[i]);
    }
    table.setRowHeight(table.getRowHeight() + 4);
    JPanel right = new JPanel(new BorderLayout());
    right.add(scoreChooser(), BorderLayout.NORTH);
    right.add(new JScrollPane(table), BorderLayout.CENTER);
    right.add(stages, BorderLayout.SOUTH);
    right.setMinimumSize(new Dimension(RIGHT_WIDTH, RIGHT_HEIGHT));
    right.setPreferredSize(new Dimension(RIGHT_WIDTH, RIGHT_HEIGHT));
    JSplitPane split = new JSplitPane(JSplitPane.HORIZONTAL_SPLIT, pane, right);
    split.setResizeWeight(1.0); // the picture takes what a larger window gives
    split.addComponentListener(new ComponentAdapter() {
      @Override
      public void componentResized(ComponentEvent event) {
        turn(split);
      }
    });
    pane.setMinimumSize(new Dimension(100, 100));
    pane.setPreferredSize(new Dimension(700, 400));
    panel.add(split, BorderLayout.CENTER);
    panel.add(status, BorderLayout.SOUTH);
  }

  // Lists go below the picture where the window is narrow.
  private static void turn(JSplitPane split) {
    boolean narrow = split.getWidth() < 1.3 * split.getHeight();
    int orientation = narrow ? JSplitPane.VERTICAL_SPLIT : JSplitPane.HORIZONTAL_SPLIT;
    if (split.getOrientation() == orientation) return;
    split.setOrientation(orientation);
    split.resetToPreferredSizes();
  }

  /** Shows a frame. On Swing's thread, like all here. */
  void show(Shown frame) {
    shown = frame;
    double minScore = ((Number) leastScore.getValue()).doubleValue();
    pane.show(List.of(frame.picture), new DetectionOverlay(frame.detections, frame.poses, frame.camera, minScore));
    objects.show(frame.detections, frame.poses, minScore);
    stages.show(frame.poses == null ? frame.detections.stages : frame.poses.stages);
  }

  // A change of the least score shows at once, also when nothing comes any more.
  private JComponent scoreChooser() {
    leastScore.setEditor(new JSpinner.NumberEditor(leastScore, "0.00"));
    leastScore.addChangeListener(event -> {
      if (shown != null) show(shown);
    });
    JPanel line = new JPanel(new FlowLayout(FlowLayout.LEFT));
    line.add(new JLabel("from score"));
    line.add(leastScore);
    camera.addActionListener(event -> {
      if (!offering && camera.getSelectedItem() != null) chooseCamera.accept((String) camera.getSelectedItem());
    });
    camera.setVisible(false);
    line.add(camera);
    return line;
  }

  /** Lets the user choose among several cameras, of which one is shown. */
  void offer(List<String> cameras, String shownCamera) {
    if (camera.getItemCount() == cameras.size()) return;
    offering = true;
    camera.removeAllItems();
    cameras.forEach(camera::addItem);
    camera.setSelectedItem(shownCamera);
    camera.setVisible(cameras.size() > 1);
    offering = false;
  }

  void say(String text, String complaint) {
    status.say(text, complaint);
  }

  void complain(String complaint) {
    status.say("", complaint);
  }

  JComponent component() {
    return panel;
  }

  /** A row per stage: its time for this frame, its mean over the last ones, and a bar of the time. */
  @SuppressWarnings("serial")
  private static final class StageBars extends JComponent {
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
      meansMs.keySet().removeIf(name -> Arrays.stream(stages).noneMatch(stage -> stage.stage.equals(name)));
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
}
