package houghstream.spy;

import houghstream.spy.Wire.BadMessage;
import java.awt.BorderLayout;
import java.awt.Dimension;
import java.util.ArrayList;
import java.util.List;
import java.util.concurrent.atomic.AtomicReference;
import javax.swing.JComponent;
import javax.swing.JPanel;
import javax.swing.SwingUtilities;

/** Shows the newest message of one channel, read on a thread of its own; those that come meanwhile are passed over. */
abstract class MessageViewer<T> implements Viewer {
  /** Decodes a message. */
  interface Reader<T> {
    T read(byte[] bytes) throws BadMessage;
  }

  protected final JPanel panel = new JPanel(new BorderLayout());
  protected final StatusLine status = new StatusLine("");
  private final Reader<T> reader;
  private final Dimension size;
  private final AtomicReference<byte[]> newest = new AtomicReference<>();
  private final RateMeter arrivals = new RateMeter();
  private final List<AutoCloseable> running = new ArrayList<>();

  /** Shows what it is given, until it is told to listen. */
  MessageViewer(Reader<T> reader, Dimension size) {
    this.reader = reader;
    this.size = size;
  }

  /** On Swing's thread. */
  abstract void show(T content);

  /** Listens to the channel until it is closed; returns itself. */
  final MessageViewer<T> listeningTo(String channel) {
    status.say("waiting for " + channel, "");
    Worker worker = Worker.start("viewer of " + channel, this::work);
    running.add(worker);
    running.add(new ChannelTap(channel, bytes -> {
      arrivals.count(RateMeter.nowUs());
      newest.set(bytes);
      worker.wake();
    }));
    return this;
  }

  private void work() {
    byte[] bytes = newest.getAndSet(null);
    if (bytes == null) return;
    try {
      T content = reader.read(bytes);
      SwingUtilities.invokeLater(() -> show(content));
    } catch (BadMessage bad) {
      SwingUtilities.invokeLater(() -> status.say("", bad.getMessage()));
    }
  }

  /** Messages a second, those that were passed over too. */
  final double hertz() {
    return arrivals.hertz(RateMeter.nowUs());
  }

  final String said() {
    return status.getText();
  }

  @Override
  public final JComponent component() {
    return panel;
  }

  @Override
  public final Dimension size() {
    return size;
  }

  @Override
  public final void close() {
    Viewer.closeAll(running);
  }
}
