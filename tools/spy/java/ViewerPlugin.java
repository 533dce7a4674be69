package houghstream.spy;

import houghstream.detections_t;
import houghstream.image_t;
import houghstream.images_t;
import houghstream.object_poses_t;
import houghstream.objects_t;
import houghstream.teaching_t;
import java.awt.BorderLayout;
import java.awt.Dimension;
import java.awt.Insets;
import java.awt.Window;
import java.awt.event.ActionEvent;
import java.awt.event.WindowAdapter;
import java.awt.event.WindowEvent;
import java.util.Map;
import java.util.function.Function;
import javax.swing.AbstractAction;
import javax.swing.Action;
import javax.swing.JDesktopPane;
import javax.swing.SwingUtilities;
import lcm.spy.ChannelData;
import lcm.spy.SpyPlugin;

/** What lcm-spy finds: which viewer a channel has. */
public final class ViewerPlugin implements SpyPlugin {
  /** A viewer, with what makes it for a channel of its type. */
  private record Kind(String name, Function<ChannelData, Viewer> maker) {}

  private static final Kind DETECTIONS =
      new Kind("Detections and poses", channel -> DetectionViewer.open(channel.name, channel.fingerprint));
  private static final Map<Long, Kind> KINDS = Map.of(
      images_t.LCM_FINGERPRINT, new Kind("RGB-D viewer", channel -> PictureViewer.ofFrames().listeningTo(channel.name)),
      image_t.LCM_FINGERPRINT, new Kind("Image viewer", channel -> PictureViewer.ofImages().listeningTo(channel.name)),
      objects_t.LCM_FINGERPRINT, new Kind("World", channel -> new WorldViewer().listeningTo(channel.name)),
      teaching_t.LCM_FINGERPRINT, new Kind("Teaching", channel -> new TeachingViewer().listeningTo(channel.name)),
      detections_t.LCM_FINGERPRINT, DETECTIONS,
      object_poses_t.LCM_FINGERPRINT, DETECTIONS);

  @Override
  public boolean canHandle(long fingerprint) {
    return KINDS.containsKey(fingerprint);
  }

  // Spy also asks for an action without a place or a channel, only to read its name.
  @Override
  public Action getAction(JDesktopPane place, ChannelData channel) {
    return new OpenViewer(channel == null ? null : place, channel);
  }

  /** The entry in lcm-spy's menu. */
  @SuppressWarnings("serial")
  private static final class OpenViewer extends AbstractAction {
    private final transient JDesktopPane place;
    private final transient ChannelData channel;

    OpenViewer(JDesktopPane place, ChannelData channel) {
      super(channel == null ? "Houghstream viewer" : KINDS.get(channel.fingerprint).name());
      this.place = place;
      this.channel = channel;
    }

    @Override
    public void actionPerformed(ActionEvent event) {
      if (place == null) return;
      Viewer viewer = KINDS.get(channel.fingerprint).maker().apply(channel);
      place.setLayout(new BorderLayout()); // the viewer fills the window that spy made, and grows with it
      place.add(viewer.component(), BorderLayout.CENTER);
      Window window = SwingUtilities.getWindowAncestor(place);
      if (window != null) takeOver(window, viewer);
      place.revalidate();
    }

    // Spy only hides a closed window: without this the viewer would go on listening.
    private static void takeOver(Window window, Viewer viewer) {
      Insets insets = window.getInsets();
      Dimension size = viewer.size();
      window.setSize(size.width + insets.left + insets.right, size.height + insets.top + insets.bottom);
      window.addWindowListener(new WindowAdapter() {
        @Override
        public void windowClosing(WindowEvent event) {
          viewer.close();
          window.dispose();
        }
      });
    }
  }
}
