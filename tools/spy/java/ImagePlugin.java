package houghstream.spy;

import houghstream.image_t;
import javax.swing.Action;
import javax.swing.JDesktopPane;
import lcm.spy.ChannelData;
import lcm.spy.SpyPlugin;

/** Shows image_t, for instance the preview channel. */
public final class ImagePlugin implements SpyPlugin {
  @Override
  public boolean canHandle(long fingerprint) {
    return fingerprint == image_t.LCM_FINGERPRINT;
  }

  @Override
  public Action getAction(JDesktopPane place, ChannelData channel) {
    return new ViewerAction("Image viewer", channel == null ? null : place,
        () -> PictureViewer.ofImages(channel.name));
  }
}
