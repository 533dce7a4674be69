package houghstream.spy;

/** A thread that does its step again whenever it has been woken since; calls that come meanwhile count as one. */
final class Worker implements AutoCloseable {
  private final Runnable step;
  private boolean woken;
  private boolean closed;

  private Worker(Runnable step) {
    this.step = step;
  }

  static Worker start(String name, Runnable step) {
    Worker worker = new Worker(step);
    Thread thread = new Thread(worker::run, name);
    thread.setDaemon(true);
    thread.start();
    return worker;
  }

  synchronized void wake() {
    woken = true;
    notifyAll();
  }

  @Override
  public synchronized void close() {
    closed = true;
    notifyAll();
  }

  private synchronized boolean awaitWork() {
    while (!woken && !closed) {
      try {
        wait();
      } catch (InterruptedException interrupted) {
        closed = true;
      }
    }
    woken = false;
    return !closed;
  }

  private void run() {
    while (awaitWork()) {
      try {
        step.run();
      } catch (RuntimeException error) {
        System.err.println("hs-spy: " + error); // one odd message must not end the viewer
      }
    }
  }
}
