package houghstream.spy;

import houghstream.spy.Wire.BadMessage;
import java.util.Objects;

/** Runs tests and counts them: enough for a few plain ones, without a library. */
final class Check {
  interface Step {
    void run() throws Exception;
  }

  private static int failures;

  private Check() {}

  static void test(String name, Step step) {
    try {
      step.run();
      System.out.println("ok      " + name);
    } catch (Exception | AssertionError error) {
      ++failures;
      System.out.println("FAILED  " + name);
      error.printStackTrace(System.out);
    }
  }

  static void that(boolean holds, String what) {
    if (!holds) throw new AssertionError(what);
  }

  static void equal(Object found, Object expected) {
    that(Objects.equals(found, expected), found + ", expected " + expected);
  }

  /** The step is refused as a BadMessage whose text holds `part`. */
  static void refused(String part, Step step) throws Exception {
    try {
      step.run();
    } catch (BadMessage bad) {
      that(bad.getMessage().contains(part), bad.getMessage() + ", expected " + part);
      return;
    }
    throw new AssertionError("not refused: " + part);
  }

  static void end() {
    System.exit(failures == 0 ? 0 : 1);
  }
}
