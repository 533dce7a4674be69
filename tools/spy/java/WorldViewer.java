package houghstream.spy;

import houghstream.objects_t;
import houghstream.tracked_object_t;
import java.awt.BorderLayout;
import java.awt.Color;
import java.awt.Dimension;
import java.awt.Graphics;
import java.awt.Graphics2D;
import java.awt.RenderingHints;
import java.util.ArrayList;
import java.util.List;
import java.util.concurrent.atomic.AtomicReference;
import javax.swing.JComponent;
import javax.swing.JPanel;
import javax.swing.JScrollPane;
import javax.swing.JTable;
import javax.swing.SwingUtilities;
import javax.swing.table.AbstractTableModel;

/** Shows the objects of hs-track: from above, and as a table with state and reason. */
final class WorldViewer implements Viewer {
  private final JPanel panel = new JPanel(new BorderLayout());
  private final Map map = new Map();
  private final Rows rows = new Rows();
  private final StatusLine status = new StatusLine("");
  private final AtomicReference<byte[]> newest = new AtomicReference<>();
  private final List<AutoCloseable> running = new ArrayList<>();

  /** Listens to the channel until it is closed. */
  WorldViewer(String channel) {
    this();
    status.say("waiting for " + channel, "");
    Worker worker = Worker.start("viewer of " + channel, this::work);
    running.add(worker);
    running.add(new ChannelTap(channel, bytes -> {
      newest.set(bytes);
      worker.wake();
    }));
  }

  /** Shows what it is given. */
  WorldViewer() {
    JScrollPane table = new JScrollPane(new JTable(rows));
    table.setPreferredSize(new Dimension(640, 180));
    panel.add(map, BorderLayout.CENTER);
    JPanel below = new JPanel(new BorderLayout());
    below.add(table, BorderLayout.CENTER);
    below.add(status, BorderLayout.SOUTH);
    panel.add(below, BorderLayout.SOUTH);
  }

  private void work() {
    byte[] bytes = newest.getAndSet(null);
    if (bytes == null) return;
    try {
      objects_t world = Wire.decode(bytes, "objects_t", objects_t::new);
      SwingUtilities.invokeLater(() -> show(world));
    } catch (Wire.BadMessage bad) {
      SwingUtilities.invokeLater(() -> status.say("", bad.getMessage()));
    }
  }

  /** On Swing's thread. */
  void show(objects_t world) {
    map.world = world;
    map.repaint();
    rows.show(world);
    status.say(String.format("%d objects in %s after a frame of %s", world.n_objects, world.world,
        world.source_channel), "");
  }

  String said() {
    return status.getText();
  }

  JTable table() {
    return new JTable(rows);
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

  @Override
  public JComponent component() {
    return panel;
  }

  @Override
  public Dimension size() {
    return new Dimension(760, 640);
  }

  @Override
  public void close() {
    Viewer.closeAll(running);
  }

  /** A row per object. */
  @SuppressWarnings("serial")
  private static final class Rows extends AbstractTableModel {
    private static final String[] COLUMNS = {"#", "object", "state", "probability", "x, y, z in m", "m/s", "why"};
    private transient List<String[]> rows = List.of();

    void show(objects_t world) {
      List<String[]> newRows = new ArrayList<>();
      for (tracked_object_t object : world.objects) {
        double speed = Math.sqrt(object.velocity[0] * object.velocity[0] + object.velocity[1] * object.velocity[1]
            + object.velocity[2] * object.velocity[2]);
        newRows.add(new String[] {String.valueOf(object.track_id), object.class_name, word(object.state),
            String.format("%.2f", object.probability),
            String.format("%.3f, %.3f, %.3f", object.trans[0], object.trans[1], object.trans[2]),
            object.moving == 0 ? "" : String.format("%.2f", speed), object.reason});
      }
      rows = newRows;
      fireTableDataChanged();
    }

    @Override
    public int getRowCount() {
      return rows.size();
    }

    @Override
    public int getColumnCount() {
      return COLUMNS.length;
    }

    @Override
    public String getColumnName(int column) {
      return COLUMNS[column];
    }

    @Override
    public Object getValueAt(int row, int column) {
      return rows.get(row)[column];
    }
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
