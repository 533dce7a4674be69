package houghstream.spy;

import java.util.function.Consumer;
import java.util.regex.Pattern;
import lcm.lcm.LCM;
import lcm.lcm.LCMDataInputStream;
import lcm.lcm.LCMSubscriber;

/** Copies a channel's messages for a handler, which must be quick: LCM's only receiving thread calls it. */
final class ChannelTap implements LCMSubscriber, AutoCloseable {
  private final String pattern;
  private final Consumer<byte[]> handler;

  /** Listens on LCM's default URL, which hs-spy sets for spy and viewers alike. */
  ChannelTap(String channel, Consumer<byte[]> handler) {
    this.pattern = Pattern.quote(channel);
    this.handler = handler;
    LCM.getSingleton().subscribe(pattern, this);
  }

  @Override
  public void messageReceived(LCM lcm, String channel, LCMDataInputStream stream) {
    byte[] bytes = new byte[stream.available()];
    try {
      stream.readFully(bytes);
    } catch (java.io.IOException impossible) {
      throw new IllegalStateException("bytes that are available cannot be read", impossible);
    }
    handler.accept(bytes);
  }

  @Override
  public void close() {
    LCM.getSingleton().unsubscribe(pattern, this);
  }
}
