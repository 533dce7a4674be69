package houghstream.spy;

import houghstream.camera_t;
import houghstream.image_metadata_t;
import houghstream.image_t;
import houghstream.images_t;
import houghstream.spy.Wire.BadMessage;
import java.awt.image.BufferedImage;

/** A frame as far as it can be read: what is missing is null, and `complaint` says why. */
final class RgbdFrame {
  private static final String CAMERA_KEY = "houghstream.camera";

  final long utime;
  BufferedImage colour;
  Depth depth;
  camera_t camera;
  String complaint = "";

  private RgbdFrame(long utime) {
    this.utime = utime;
  }

  static RgbdFrame decode(byte[] bytes) throws BadMessage {
    images_t message = Wire.decode(bytes, "images_t", images_t::new);
    RgbdFrame frame = new RgbdFrame(message.utime);
    for (int i = 0; i < message.n_images; ++i) {
      try {
        frame.take(message.image_types[i], message.images[i]);
      } catch (BadMessage bad) {
        frame.complaint = bad.getMessage();
      }
    }
    if (frame.colour == null && frame.depth == null && frame.complaint.isEmpty()) {
      frame.complaint = "neither colour nor depth among " + message.n_images + " images";
    }
    return frame;
  }

  private void take(short type, image_t image) throws BadMessage {
    for (image_metadata_t entry : image.metadata) {
      if (CAMERA_KEY.equals(entry.key)) camera = Wire.decode(entry.value, "camera_t", camera_t::new);
    }
    switch (type) {
      case images_t.LEFT -> colour = ImageDecoder.colour(image);
      case images_t.DEPTH_MM -> depth = Depth.decode(image, false);
      case images_t.DEPTH_MM_ZIPPED -> depth = Depth.decode(image, true);
      default -> { } // other people's images: disparity, masks
    }
  }
}
