package houghstream.spy;

import java.util.List;

/** What viewers share. */
final class Viewers {
  private Viewers() {}

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
