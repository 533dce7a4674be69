package houghstream.spy;

import java.awt.Dimension;
import javax.swing.JComponent;

/** Something that shows a channel until it is closed. */
interface Viewer {
  JComponent component();

  /** The size that the window should have at first. */
  Dimension size();

  /** Stops listening. */
  void close();
}
