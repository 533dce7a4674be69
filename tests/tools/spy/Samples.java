package houghstream.spy;

import houghstream.camera_t;
import houghstream.detection_t;
import houghstream.detections_t;
import houghstream.image_metadata_t;
import houghstream.image_t;
import houghstream.images_t;
import houghstream.object_pose_t;
import houghstream.object_poses_t;
import houghstream.objects_t;
import houghstream.stage_time_t;
import houghstream.teaching_t;
import houghstream.tracked_object_t;
import java.awt.image.BufferedImage;
import java.io.ByteArrayOutputStream;
import java.io.DataOutputStream;
import java.io.IOException;
import java.util.Arrays;
import java.util.zip.Deflater;
import javax.imageio.ImageIO;
import lcm.lcm.LCMEncodable;

/** Messages as drivers and detectors send them, 64 x 48 pixels. */
final class Samples {
  static final int WIDTH = 64;
  static final int HEIGHT = 48;

  private Samples() {}

  static byte[] bytes(LCMEncodable message) throws IOException {
    ByteArrayOutputStream out = new ByteArrayOutputStream();
    message.encode(new DataOutputStream(out));
    return out.toByteArray();
  }

  static image_t image(int format, int stride, byte[] data) {
    image_t image = new image_t();
    image.utime = 5;
    image.width = WIDTH;
    image.height = HEIGHT;
    image.row_stride = stride;
    image.pixelformat = format;
    image.size = data.length;
    image.data = data;
    image.metadata = new image_metadata_t[0];
    return image;
  }

  /** Each pixel has these bytes; rows end with `padding` more. */
  static image_t raw(int format, int padding, int... pixel) {
    int stride = WIDTH * pixel.length + padding;
    byte[] data = new byte[stride * HEIGHT];
    for (int y = 0; y < HEIGHT; ++y) {
      for (int i = 0; i < WIDTH * pixel.length; ++i) data[y * stride + i] = (byte) pixel[i % pixel.length];
    }
    return image(format, padding == 0 ? 0 : stride, data);
  }

  static image_t jpeg(int grey) throws IOException {
    BufferedImage picture = new BufferedImage(WIDTH, HEIGHT, BufferedImage.TYPE_INT_RGB);
    for (int i = 0; i < WIDTH * HEIGHT; ++i) picture.setRGB(i % WIDTH, i / WIDTH, 0x010101 * grey);
    ByteArrayOutputStream out = new ByteArrayOutputStream();
    ImageIO.write(picture, "jpeg", out);
    return image(image_t.PIXEL_FORMAT_MJPEG, 0, out.toByteArray());
  }

  static image_t depth(int millimetres, int padding) {
    return raw(image_t.PIXEL_FORMAT_LE_GRAY16, padding, millimetres & 255, millimetres >> 8);
  }

  static image_t zipped(image_t image) {
    Deflater deflater = new Deflater(1);
    deflater.setInput(image.data);
    deflater.finish();
    byte[] all = new byte[2 * image.data.length];
    return image(image.pixelformat, 0, Arrays.copyOf(all, deflater.deflate(all)));
  }

  static images_t frame(image_t colour, short depthType, image_t depth) throws IOException {
    camera_t camera = new camera_t();
    camera.width = WIDTH;
    camera.height = HEIGHT;
    camera.fx = camera.fy = 60;
    camera.cx = 0.5 * WIDTH;
    camera.cy = 0.5 * HEIGHT;
    image_metadata_t entry = new image_metadata_t();
    entry.key = "houghstream.camera";
    entry.value = bytes(camera);
    entry.n = entry.value.length;
    colour.metadata = new image_metadata_t[] {entry};
    colour.nmetadata = 1;
    images_t frame = new images_t();
    frame.utime = 5;
    frame.n_images = 2;
    frame.image_types = new short[] {images_t.LEFT, depthType};
    frame.images = new image_t[] {colour, depth};
    return frame;
  }

  static detections_t detections(long utime) {
    detection_t detection = new detection_t();
    detection.class_id = 4;
    detection.class_name = "soda_can";
    detection.score = 0.75F;
    detection.reported = true;
    detection.box_x = 20;
    detection.box_y = 18;
    detection.box_width = 24;
    detection.box_height = 20;
    detection.centre_camera = new float[] {Float.NaN, Float.NaN, Float.NaN};
    detection.vote_quat = new float[0][4];
    detection.vote_quat_weight = new float[0];
    detections_t message = new detections_t();
    message.utime = utime;
    message.source_channel = "OPENNI_FRAME";
    message.n_detections = 1;
    message.detections = new detection_t[] {detection};
    message.stages = new stage_time_t[0];
    return message;
  }

  /** One pose half a metre ahead, not turned. */
  static object_poses_t poses(long utime, byte status) {
    object_pose_t pose = new object_pose_t();
    pose.class_name = "soda_can";
    pose.detection_score = 0.75F;
    pose.status = status;
    pose.trans = new double[] {0, 0, 0.5};
    pose.quat = new double[] {1, 0, 0, 0};
    object_poses_t message = new object_poses_t();
    message.utime = utime;
    message.source_channel = "OPENNI_FRAME";
    message.n_poses = 1;
    message.poses = new object_pose_t[] {pose};
    message.stages = new stage_time_t[0];
    return message;
  }

  /** One mug on the table, in that state. */
  static objects_t world(byte state) {
    tracked_object_t mug = new tracked_object_t();
    mug.track_id = 3;
    mug.class_id = 2;
    mug.class_name = "mug";
    mug.state = state;
    mug.probability = 0.9f;
    mug.trans = new double[] {0.1, 0.2, 0.05};
    mug.quat = new double[] {1, 0, 0, 0};
    mug.reason = "occluded by a nearer surface";
    mug.seen_channel = "LEFT";
    objects_t message = new objects_t();
    message.utime = 5;
    message.source_channel = "LEFT";
    message.world = "WORLD";
    message.world_number = 1;
    message.camera_trans = new double[] {0, -0.8, 0.6};
    message.camera_quat = new double[] {1, 0, 0, 0};
    message.objects = new tracked_object_t[] {mug};
    message.n_objects = 1;
    message.stages = new stage_time_t[0];
    return message;
  }

  /** Six directions, the first seen, of an object that is not turned. */
  static teaching_t teaching(byte state) {
    teaching_t message = new teaching_t();
    message.name = "mug";
    message.source_channel = "OPENNI_FRAME";
    message.state = state;
    message.message = "from behind nothing yet";
    message.progress = 0.25F;
    message.n_frames = 70;
    message.n_keyframes = 7;
    message.trans = new double[] {0, 0, 0.5};
    message.quat = new double[] {1, 0, 0, 0};
    message.directions = new float[][] {{0, 0, -1}, {0, 0, 1}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}};
    message.seen = new byte[] {1, 0, 0, 0, 0, 0};
    message.n_directions = 6;
    return message;
  }
}
