package houghstream.spy;

import houghstream.detections_t;
import houghstream.drake_viewer_draw_t;
import houghstream.drake_viewer_load_robot_t;
import houghstream.image_t;
import houghstream.images_t;
import houghstream.known_objects_t;
import houghstream.object_pose_t;
import houghstream.object_poses_t;
import houghstream.objects_t;
import houghstream.placed_objects_t;
import houghstream.pose_t;
import houghstream.rigid_transform_t;
import houghstream.stage_time_t;
import houghstream.status_t;
import houghstream.teaching_t;
import javax.swing.JDesktopPane;
import lcm.spy.LCMTypeDatabase;
import lcm.spy.SpyPlugin;

/** Types and plug-ins as spy asks for them, and which messages a viewer shows together. */
final class PluginsTest {
  private static final String CHANNEL = "OPENNI_FRAME";

  private PluginsTest() {}

  static void run() {
    Check.test("plug-ins tell name and types without a place", PluginsTest::plugins);
    Check.test("spy knows every type that is sent", PluginsTest::types);
    Check.test("frames, detections and poses meet by the frame's name", PluginsTest::matching);
    Check.test("cameras of equal times and several detectors are kept apart", PluginsTest::cameras);
    Check.test("what is followed needs no detections", PluginsTest::followed);
    Check.test("an answer without the models takes no other's place", PluginsTest::withoutModels);
  }

  private static void plugins() {
    SpyPlugin plugin = new ViewerPlugin();
    long[] types = {images_t.LCM_FINGERPRINT, image_t.LCM_FINGERPRINT, detections_t.LCM_FINGERPRINT,
        object_poses_t.LCM_FINGERPRINT, objects_t.LCM_FINGERPRINT, teaching_t.LCM_FINGERPRINT};
    for (long type : types) Check.that(plugin.canHandle(type), "a viewer of " + type);
    Check.that(!plugin.canHandle(status_t.LCM_FINGERPRINT), "spy itself shows numbers");
    Check.that(plugin.getAction(null, null).getValue("Name") instanceof String, "a name");
    plugin.getAction(null, null).actionPerformed(null);
    plugin.getAction(new JDesktopPane(), null).actionPerformed(null);
  }

  private static void types() {
    LCMTypeDatabase known = new LCMTypeDatabase();
    Check.equal(known.getClassByFingerprint(images_t.LCM_FINGERPRINT), images_t.class);
    Check.equal(known.getClassByFingerprint(image_t.LCM_FINGERPRINT), image_t.class);
    Check.equal(known.getClassByFingerprint(detections_t.LCM_FINGERPRINT), detections_t.class);
    Check.equal(known.getClassByFingerprint(object_poses_t.LCM_FINGERPRINT), object_poses_t.class);
    Check.equal(known.getClassByFingerprint(rigid_transform_t.LCM_FINGERPRINT), rigid_transform_t.class);
    Check.equal(known.getClassByFingerprint(pose_t.LCM_FINGERPRINT), pose_t.class);
    Check.equal(known.getClassByFingerprint(drake_viewer_load_robot_t.LCM_FINGERPRINT), drake_viewer_load_robot_t.class);
    Check.equal(known.getClassByFingerprint(drake_viewer_draw_t.LCM_FINGERPRINT), drake_viewer_draw_t.class);
    Check.equal(known.getClassByFingerprint(status_t.LCM_FINGERPRINT), status_t.class);
    Check.equal(known.getClassByFingerprint(placed_objects_t.LCM_FINGERPRINT), placed_objects_t.class);
    Check.equal(known.getClassByFingerprint(known_objects_t.LCM_FINGERPRINT), known_objects_t.class);
    Check.equal(known.getClassByFingerprint(teaching_t.LCM_FINGERPRINT), teaching_t.class);
  }

  private static void matching() throws Exception {
    ResultMatcher matcher = new ResultMatcher();
    Check.equal(matcher.newest(0), null);
    matcher.addFrame(CHANNEL, ViewersTest.frame(10));
    matcher.addDetections(Samples.detections(10));
    Check.equal(matcher.newest(0).utime, 10L); // poses never came: detections alone
    matcher.addPoses(Samples.poses(10, object_pose_t.VALID), 0);
    matcher.addDetections(Samples.detections(20));
    Check.equal(matcher.newest(1).utime, 10L); // poses of 20 are still to come
    Check.equal(matcher.newest(9_000_000).utime, 10L); // 20 came without its frame
    matcher.addDetections(Samples.detections(3_000_000));
    Check.equal(matcher.newest(9_000_000).utime, 3_000_000L); // a second later the frame of 10 is too old
    Check.equal(matcher.arrivedPercent(), 33);
    for (int i = 0; i < 200; ++i) matcher.addFrame(CHANNEL, ViewersTest.frame(i)); // a log that is played again, from an earlier time
    matcher.addDetections(Samples.detections(150));
    Check.equal(matcher.newest(9_000_000).utime, 150L);
    Check.refused("message of 8 bytes", () -> matcher.addFrame(CHANNEL, new byte[8]));
  }

  private static detections_t found(String camera, String object, float score) {
    detections_t detections = Samples.detections(5);
    detections.source_channel = camera;
    detections.detections[0].class_name = object;
    detections.detections[0].score = score;
    return detections;
  }

  private static object_poses_t posed(String camera, String object, float score) {
    object_poses_t poses = Samples.poses(5, object_pose_t.VALID);
    poses.source_channel = camera;
    poses.poses[0].class_name = object;
    poses.poses[0].detection_score = score;
    return poses;
  }

  private static void cameras() throws Exception {
    ResultMatcher matcher = new ResultMatcher();
    for (String camera : new String[] {"LEFT", "RIGHT"}) {
      matcher.addFrame(camera, ViewersTest.frame(5));
      matcher.addDetections(found(camera, "bowl", 0.5F));
    }
    matcher.addPoses(posed("LEFT", "can", 0.75F), 0); // before its detections
    matcher.addDetections(found("LEFT", "can", 0.75F));
    Check.equal(matcher.cameras().toString(), "[LEFT, RIGHT]");
    ResultMatcher.Entry left = matcher.newest(9_000_000);
    Check.equal(left.id.channel(), "LEFT");
    detections_t both = left.results.detections();
    Check.equal(both.n_detections, 2);
    Check.equal(both.detections[0].class_name, "can"); // strongest first
    Check.equal(left.results.poses().n_poses, 1);
    Check.equal(left.results.poses().poses[0].detection_index, 0);
    matcher.addPoses(posed("LEFT", "bowl", 0.5F), 0);
    Check.equal(left.results.poses().poses[0].detection_index, 1);
    Check.that(left.results.allPosed(), "each detector's result has its poses");
    matcher.choose("RIGHT");
    ResultMatcher.Entry right = matcher.newest(9_000_000);
    Check.equal(right.id.channel(), "RIGHT");
    Check.equal(right.results.detections().n_detections, 1);
    Check.equal(right.results.poses(), null);
  }

  private static void followed() throws Exception {
    ResultMatcher matcher = new ResultMatcher();
    matcher.addFrame(CHANNEL, ViewersTest.frame(5));
    matcher.addDetections(Samples.detections(4));
    matcher.addPoses(Samples.poses(4, object_pose_t.VALID), 0);
    object_poses_t followed = Samples.poses(5, object_pose_t.VALID);
    followed.poses[0].detection_index = -1;
    matcher.addPoses(followed, 0);
    ResultMatcher.Snapshot newest = matcher.snapshot(1);
    Check.equal(newest.entry().utime, 5L);
    Check.equal(newest.followed(), followed);
    Check.equal(newest.detections(), null);
    matcher.addDetections(Samples.detections(5));
    Check.equal(newest.detections(), null); // as it was
    object_poses_t valid = ResultMatcher.valid(followed);
    Check.equal(valid.poses[0].detection_index, 0);
    Check.equal(followed.poses[0].detection_index, -1);
    detections_t boxed = ResultMatcher.boxed(valid, RgbdFrame.decode(newest.frame()).camera);
    Check.equal(boxed.detections[0].class_name, "soda_can");
    Check.that(Math.abs(boxed.detections[0].box_width - 12) < 1e-3, "ten centimetres half a metre away");
    Check.equal(ResultMatcher.valid(Samples.poses(5, object_pose_t.OCCLUDED)).n_poses, 0);
    object_poses_t none = Samples.poses(6, object_pose_t.VALID);
    none.poses = new object_pose_t[0];
    none.n_poses = 0;
    none.stages = new stage_time_t[] {new stage_time_t()};
    none.stages[0].stage = "pose.following";
    none.n_stages = 1;
    matcher.addPoses(none, 0);
    Check.equal(matcher.arrivedPercent(), 33);
  }

  private static void withoutModels() {
    for (boolean validFirst : new boolean[] {true, false}) {
      ResultMatcher matcher = new ResultMatcher();
      matcher.addDetections(Samples.detections(5));
      matcher.addPoses(Samples.poses(5, validFirst ? object_pose_t.VALID : object_pose_t.NO_MODEL), 0);
      matcher.addPoses(Samples.poses(5, validFirst ? object_pose_t.NO_MODEL : object_pose_t.VALID), 0);
      Check.equal(matcher.snapshot(1).poses().poses[0].status, object_pose_t.VALID);
    }
  }
}
