package houghstream.spy;

import java.awt.Frame;
import java.awt.GraphicsEnvironment;
import java.io.IOException;
import javax.swing.SwingUtilities;
import lcm.lcm.LCM;
import lcm.spy.Spy;

/** Starts lcm-spy, saying in one line what it would say in a page when it cannot start. */
public final class SpyMain {
  private static final int SPY_WIDTH = 1000;

  private SpyMain() {}

  public static void main(String[] arguments) {
    try {
      if (GraphicsEnvironment.isHeadless()) fail("this Java has no windows; sudo apt-get install default-jre");
      GraphicsEnvironment.getLocalGraphicsEnvironment().getDefaultScreenDevice();
    } catch (java.awt.AWTError error) {
      fail("no display for a window (" + error.getMessage() + ")");
    } catch (LinkageError error) {
      fail("this Java has no windows; sudo apt-get install default-jre");
    }
    tryNetwork();
    Spy.main(arguments);
    // Spy's own window is too narrow for the names of our channels.
    SwingUtilities.invokeLater(() -> {
      for (Frame frame : Frame.getFrames()) frame.setSize(SPY_WIDTH, frame.getHeight());
    });
  }

  // Spy itself would open a window that stays empty.
  private static void tryNetwork() {
    try {
      new LCM().close();
    } catch (IOException error) {
      fail("LCM cannot be opened at " + System.getenv("LCM_DEFAULT_URL") + " (" + error.getMessage()
          + "); is there a multicast route?");
    }
  }

  private static void fail(String reason) {
    System.err.println("hs-spy: " + reason);
    System.exit(1);
  }
}
