package houghstream.spy;

import houghstream.images_t;
import javax.swing.Action;
import javax.swing.JDesktopPane;
import lcm.spy.ChannelData;
import lcm.spy.SpyPlugin;

/** Shows images_t: colour, depth, or both. */
public final class RgbdPlugin implements SpyPlugin {
  @Override
  public boolean canHandle(long fingerprint) {
    return fingerprint == images_t.LCM_FINGERPRINT;
  }

  @Override
  public Action getAction(JDesktopPane place, ChannelData channel) {
    return new ViewerAction("RGB-D viewer", channel == null ? null : place,
        () -> PictureViewer.ofFrames(channel.name));
  }
}
