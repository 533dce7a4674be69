package houghstream.spy;

import houghstream.detections_t;
import houghstream.object_poses_t;
import javax.swing.Action;
import javax.swing.JDesktopPane;
import lcm.spy.ChannelData;
import lcm.spy.SpyPlugin;

/** Shows detections and poses over the frame that they belong to. */
public final class DetectionPlugin implements SpyPlugin {
  @Override
  public boolean canHandle(long fingerprint) {
    return fingerprint == detections_t.LCM_FINGERPRINT || fingerprint == object_poses_t.LCM_FINGERPRINT;
  }

  @Override
  public Action getAction(JDesktopPane place, ChannelData channel) {
    return new ViewerAction("Detections and poses", channel == null ? null : place,
        () -> DetectionViewer.open(channel.name, channel.fingerprint));
  }
}
