package houghstream.spy;

import houghstream.objects_t;
import houghstream.tracked_object_t;
import java.awt.BorderLayout;
import java.awt.Color;
import java.awt.Dimension;
import java.awt.Graphics;
import java.awt.Graphics2D;
import java.awt.RenderingHints;
import javax.swing.JComponent;
import javax.swing.JPanel;
import javax.swing.JScrollPane;
import javax.swing.JTable;
import javax.swing.table.DefaultTableModel;
import javax.swing.table.TableModel;

/** Shows the objects of hs-track: from above, and as a table with state and reason. */
final class WorldViewer extends MessageViewer<objects_t> {
  private final Map map = new Map();
  private final DefaultTableModel rows =
      new DefaultTableModel(new String[] {"#", "object", "state", "probability", "x, y, z in m", "m/s", "why"}, 0);

  WorldViewer() {
    super(bytes -> Wire.decode(bytes, "objects_t", objects_t::new), new Dimension(760, 640));
    JTable objects = new JTable(rows);
    objects.setDefaultEditor(Object.class, null); // only to be read
    JScrollPane table = new JScrollPane(objects);
    table.setPreferredSize(new Dimension(640, 180));
    panel.add(map, BorderLayout.CENTER);
    JPanel below = new JPanel(new BorderLayout());
    below.add(table, BorderLayout.CENTER);
    below.add(status, BorderLayout.SOUTH);
    panel.add(below, BorderLayout.SOUTH);
  }

  @Override
  void show(objects_t world) {
    map.world = world;
    map.repaint();
    rows.setRowCount(0);
    for (tracked_object_t object : world.objects) rows.addRow(row(object));
    status.say(String.format("%d objects in %s after a frame of %s", world.n_objects, world.world,
        world.source_channel), "");
  }

  TableModel table() {
    return rows;
  }

  private static String[] row(tracked_object_t object) {
    double speed = Math.sqrt(object.velocity[0] * object.velocity[0] + object.velocity[1] * object.velocity[1]
        + object.velocity[2] * object.velocity[2]);
    return new String[] {String.valueOf(object.track_id), object.class_name, word(object.state),
        String.format("%.2f", object.probability),
        String.format("%.3f, %.3f, %.3f", object.trans[0], object.trans[1], object.trans[2]),
        object.moving == 0 ? "" : String.format("%.2f", speed), object.reason};
  }

  static String word(byte state) {
    return switch (state) {
      case tracked_object_t.VISIBLE -> "visible";
      case tracked_object_t.UNRECOGNISED -> "unrecognised";
      case tracked_object_t.HIDDEN -> "hidden";
      case tracked_object_t.OUT_OF_VIEW -> "out of view";
      case tracked_object_t.GONE -> "gone";
      default -> "state " + state;
    };
  }

  /** The world from above: x to the right, y up. */
  @SuppressWarnings("serial")
  static final class Map extends JComponent {
    static final Color SEEN = new Color(60, 200, 110);
    static final Color UNSEEN = new Color(220, 180, 60);
    private static final Color GROUND = new Color(32, 34, 38);
    private static final double LEAST_M = 0.8; // shown at least, from side to side
    private static final int DISC = 7;
    private transient objects_t world;

    @Override
    protected void paintComponent(Graphics base) {
      Graphics2D graphics = (Graphics2D) base.create();
      graphics.setRenderingHint(RenderingHints.KEY_ANTIALIASING, RenderingHints.VALUE_ANTIALIAS_ON);
      graphics.setColor(GROUND);
      graphics.fillRect(0, 0, getWidth(), getHeight());
      if (world != null) paintWorld(graphics);
      graphics.dispose();
    }

    private void paintWorld(Graphics2D graphics) {
      double[] low = {world.camera_trans[0], world.camera_trans[1]};
      double[] high = low.clone();
      for (tracked_object_t object : world.objects) {
        for (int i = 0; i < 2; ++i) {
          low[i] = Math.min(low[i], object.trans[i]);
          high[i] = Math.max(high[i], object.trans[i]);
        }
      }
      double scale = Math.min(getWidth() / Math.max(LEAST_M, 1.2 * (high[0] - low[0])),
          getHeight() / Math.max(LEAST_M, 1.2 * (high[1] - low[1])));
      for (tracked_object_t object : world.objects) {
        if (object.state == tracked_object_t.GONE) continue;
        int x = (int) (getWidth() / 2 + scale * (object.trans[0] - (low[0] + high[0]) / 2));
        int y = (int) (getHeight() / 2 - scale * (object.trans[1] - (low[1] + high[1]) / 2));
        graphics.setColor(object.state == tracked_object_t.VISIBLE ? SEEN : UNSEEN);
        graphics.fillOval(x - DISC, y - DISC, 2 * DISC, 2 * DISC);
        graphics.setColor(Color.WHITE);
        graphics.drawString("#" + object.track_id + " " + object.class_name, x + DISC + 3, y + 4);
      }
      int x = (int) (getWidth() / 2 + scale * (world.camera_trans[0] - (low[0] + high[0]) / 2));
      int y = (int) (getHeight() / 2 - scale * (world.camera_trans[1] - (low[1] + high[1]) / 2));
      graphics.drawRect(x - 4, y - 4, 8, 8);
      graphics.drawString(world.source_channel, x + 8, y + 4);
    }
  }
}
