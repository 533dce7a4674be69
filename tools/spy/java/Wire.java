package houghstream.spy;

import java.io.IOException;
import java.nio.ByteBuffer;

/** Decodes messages of the generated types, damaged ones included. */
final class Wire {
  /** A message that cannot be shown; its text is one line for the person at the screen. */
  @SuppressWarnings("serial")
  static final class BadMessage extends Exception {
    BadMessage(String text) {
      super(text);
    }
  }

  /** A generated type's constructor from bytes. */
  interface Decoder<T> {
    T decode(byte[] bytes) throws IOException;
  }

  private Wire() {}

  /** Decodes one message; `type` names it in the error. */
  static <T> T decode(byte[] bytes, String type, Decoder<T> decoder) throws BadMessage {
    try {
      return decoder.decode(bytes);
    } catch (IOException | RuntimeException error) {
      throw new BadMessage("damaged " + type + " of " + bytes.length + " bytes");
    } catch (OutOfMemoryError error) {
      // The generated decoders believe every count. A damaged one asks for an array of gigabytes, which Java refuses
      // before it has allocated anything.
      throw new BadMessage("damaged " + type + ": a count asks for more memory than there is");
    }
  }

  /** utime of any message of this project: it stands behind the fingerprint. */
  static long utime(byte[] bytes) throws BadMessage {
    if (bytes.length < 16) throw new BadMessage("message of " + bytes.length + " bytes, expected at least 16");
    return ByteBuffer.wrap(bytes).getLong(8);
  }
}
