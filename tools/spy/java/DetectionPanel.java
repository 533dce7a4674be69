package houghstream.spy;

import houghstream.detections_t;
import houghstream.object_poses_t;
import houghstream.stage_time_t;
import java.awt.BorderLayout;
import java.awt.Dimension;
import java.awt.event.ComponentAdapter;
import java.awt.event.ComponentEvent;
import java.awt.image.BufferedImage;
import java.util.List;
import javax.swing.JComponent;
import javax.swing.JPanel;
import javax.swing.JScrollPane;
import javax.swing.JSplitPane;
import javax.swing.JTable;

/** The picture with its overlay, beside it the objects and the stages' times. */
final class DetectionPanel {
  private static final int RIGHT_WIDTH = 500;
  private static final int RIGHT_HEIGHT = 320;
  private static final int[] COLUMN_WIDTHS = {100, 50, 150, 140, 60};
  private final PicturePane pane = new PicturePane();
  private final ObjectsTable objects = new ObjectsTable();
  private final StageBars stages = new StageBars();
  private final StatusLine status = new StatusLine("waiting for detections");
  private final JPanel panel = new JPanel(new BorderLayout());

  DetectionPanel() {
    JTable table = new JTable(objects);
    for (int i = 0; i < COLUMN_WIDTHS.length; ++i) {
      table.getColumnModel().getColumn(i).setPreferredWidth(COLUMN_WIDTHS[i]);
    }
    table.setRowHeight(table.getRowHeight() + 4);
    JPanel right = new JPanel(new BorderLayout());
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

  /** Everything about one frame; `poses` may be null. On Swing's thread, like all here. */
  void show(BufferedImage picture, DetectionOverlay overlay, detections_t detections, object_poses_t poses,
      stage_time_t[] times) {
    pane.show(List.of(picture), overlay);
    objects.show(detections, poses);
    stages.show(times);
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
}
