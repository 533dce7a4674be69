package houghstream.spy;

import java.awt.Dimension;
import java.util.List;
import javax.swing.JComponent;

/** Something that shows a channel until it is closed. */
interface Viewer {
  JComponent component();

  /** The size that the window should have at first. */
  Dimension size();

  /** Stops listening. */
  void close();

  /** Ends listeners and threads. */
  static void closeAll(List<AutoCloseable> running) {
    for (AutoCloseable one : running) {
      try {
        one.close();
      } catch (Exception error) {
        System.err.println("hs-spy: " + error);
      }
    }
    running.clear();
  }
}
