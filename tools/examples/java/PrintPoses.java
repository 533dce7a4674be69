import houghstream.object_pose_t;
import houghstream.object_poses_t;
import java.io.IOException;
import lcm.lcm.LCM;
import lcm.lcm.LCMDataInputStream;

/** Prints poses as they come. In this folder, with houghstream-java installed:
 * java -cp /usr/share/java/lcm.jar:/usr/share/java/houghstream_types.jar PrintPoses.java */
public final class PrintPoses {
  public static void main(String[] arguments) throws Exception {
    new LCM().subscribe("HOUGHSTREAM_POSES", PrintPoses::print); // $LCM_DEFAULT_URL
    Thread.sleep(Long.MAX_VALUE);
  }

  private static void print(LCM bus, String channel, LCMDataInputStream data) {
    try {
      for (object_pose_t pose : new object_poses_t(data).poses) {
        if (pose.status == object_pose_t.VALID) {
          System.out.printf("%s at %.3f %.3f %.3f m, quality %.2f%n", pose.class_name, pose.trans[0], pose.trans[1], pose.trans[2], pose.quality);
        }
      }
    } catch (IOException error) {
      System.err.println(channel + ": " + error.getMessage());
    }
  }
}
