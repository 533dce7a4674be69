package houghstream.spy;

/** A message that cannot be shown; its text is one line for the person at the screen. */
@SuppressWarnings("serial")
final class BadMessage extends Exception {
  BadMessage(String text) {
    super(text);
  }
}
