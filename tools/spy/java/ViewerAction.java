package houghstream.spy;

import java.awt.BorderLayout;
import java.awt.Dimension;
import java.awt.Insets;
import java.awt.Window;
import java.awt.event.ActionEvent;
import java.awt.event.WindowAdapter;
import java.awt.event.WindowEvent;
import java.util.function.Supplier;
import javax.swing.AbstractAction;
import javax.swing.JDesktopPane;
import javax.swing.SwingUtilities;

/** The entry in lcm-spy's menu. Spy also asks for one without a place or a channel, only to read its name. */
@SuppressWarnings("serial")
final class ViewerAction extends AbstractAction {
  private final transient JDesktopPane place;
  private final transient Supplier<Viewer> maker;

  ViewerAction(String name, JDesktopPane place, Supplier<Viewer> maker) {
    super(name);
    this.place = place;
    this.maker = maker;
  }

  @Override
  public void actionPerformed(ActionEvent event) {
    if (place == null) return;
    Viewer viewer = maker.get();
    place.setLayout(new BorderLayout()); // the viewer fills the window that spy made, and grows with it
    place.add(viewer.component(), BorderLayout.CENTER);
    Window window = SwingUtilities.getWindowAncestor(place);
    if (window != null) takeOver(window, viewer);
    place.revalidate();
  }

  // Spy only hides a closed window: without this the viewer would go on listening.
  private static void takeOver(Window window, Viewer viewer) {
    Insets insets = window.getInsets();
    Dimension size = viewer.size();
    window.setSize(size.width + insets.left + insets.right, size.height + insets.top + insets.bottom);
    window.addWindowListener(new WindowAdapter() {
      @Override
      public void windowClosing(WindowEvent event) {
        viewer.close();
        window.dispose();
      }
    });
  }
}
