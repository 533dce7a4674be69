package houghstream.spy;

import java.util.ArrayDeque;

/** Counts events per second over the last two seconds. Times are microseconds of one clock. */
final class RateMeter {
  private static final long WINDOW_US = 2_000_000;
  private final ArrayDeque<Long> times = new ArrayDeque<>();

  synchronized void count(long nowUs) {
    times.addLast(nowUs);
    forget(nowUs);
  }

  synchronized double hertz(long nowUs) {
    forget(nowUs);
    return times.size() < 2 ? 0.0 : (times.size() - 1) * 1e6 / Math.max(1, times.getLast() - times.getFirst());
  }

  private void forget(long nowUs) {
    while (!times.isEmpty() && nowUs - times.getFirst() > WINDOW_US) times.removeFirst();
  }

  static long nowUs() {
    return System.nanoTime() / 1000;
  }
}
