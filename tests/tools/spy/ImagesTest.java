package houghstream.spy;

import houghstream.image_t;
import houghstream.images_t;
import houghstream.spy.Wire.BadMessage;
import java.util.Arrays;
import java.util.Random;

/** Images and depth of all kinds are decoded, and damaged ones refused with a word on what is wrong. */
final class ImagesTest {
  private ImagesTest() {}

  static void run() {
    Check.test("raw colour, with and without padding", ImagesTest::rawColour);
    Check.test("JPEG", ImagesTest::jpeg);
    Check.test("depth, raw and zipped", ImagesTest::depth);
    Check.test("odd images are refused", ImagesTest::oddImages);
    Check.test("a frame shows what of it can be read", ImagesTest::frames);
    Check.test("damaged messages are refused", ImagesTest::damaged);
  }

  private static int pixel(image_t image) throws BadMessage {
    return ImageDecoder.colour(image).getRGB(Samples.WIDTH - 1, Samples.HEIGHT - 1) & 0xFFFFFF;
  }

  private static void rawColour() throws BadMessage {
    Check.equal(pixel(Samples.raw(image_t.PIXEL_FORMAT_RGB, 0, 250, 2, 3)), 0xFA0203);
    Check.equal(pixel(Samples.raw(image_t.PIXEL_FORMAT_BGR, 5, 250, 2, 3)), 0x0302FA);
    Check.equal(pixel(Samples.raw(image_t.PIXEL_FORMAT_GRAY, 1, 200)), 0xC8C8C8);
  }

  private static void jpeg() throws Exception {
    Check.that(Math.abs((pixel(Samples.jpeg(120)) & 255) - 120) < 4, "grey");
    image_t cut = Samples.jpeg(120);
    cut.data = Arrays.copyOf(cut.data, 100);
    Check.refused("damaged JPEG", () -> ImageDecoder.colour(cut));
    image_t larger = Samples.jpeg(120);
    larger.width = 65;
    Check.refused("JPEG of 64x48", () -> ImageDecoder.colour(larger));
  }

  private static void depth() throws Exception {
    image_t raw = Samples.depth(1234, 6);
    Check.equal(Depth.decode(raw, false).millimetres(63, 47), 1234);
    image_t zipped = Samples.zipped(Samples.depth(2000, 0));
    Depth depth = Depth.decode(zipped, true);
    Check.equal(depth.millimetres(0, 0), 2000);
    Check.equal(depth.summary(), "depth 2.00 to 2.00 m, 100 % measured");
    Check.equal(Depth.decode(Samples.depth(0, 0), false).summary(), "no depth measured");
    Check.equal(Depth.decode(Samples.depth(0, 0), false).picture().getRGB(3, 3) & 0xFFFFFF, 0);
    int near = Depth.decode(Samples.depth(450, 0), false).picture().getRGB(3, 3);
    int far = Depth.decode(Samples.depth(60000, 0), false).picture().getRGB(3, 3);
    Check.that((near >> 16 & 255) > (near & 255) && (far & 255) > (far >> 16 & 255), "near is warm, far is cold");
    zipped.data = Arrays.copyOf(zipped.data, zipped.data.length / 2);
    Check.refused("depth ends after", () -> Depth.decode(zipped, true));
    zipped.data = new byte[50];
    Check.refused("damaged depth", () -> Depth.decode(zipped, true));
  }

  private static void oddImages() throws Exception {
    image_t image = Samples.raw(image_t.PIXEL_FORMAT_RGB, 0, 1, 2, 3);
    image.data = new byte[image.data.length - 1];
    Check.refused("raw image of", () -> ImageDecoder.colour(image));
    image.row_stride = 5;
    Check.refused("raw image of", () -> ImageDecoder.colour(image));
    image.width = -1;
    Check.refused("image of -1x48", () -> ImageDecoder.colour(image));
    image.width = image.height = 60000;
    Check.refused("image of 60000x60000", () -> Depth.decode(image, true));
    Check.refused("pixel format 77", () -> ImageDecoder.colour(Samples.raw(77, 0, 1)));
  }

  private static void frames() throws Exception {
    images_t message = Samples.frame(Samples.jpeg(9), images_t.DEPTH_MM, Samples.depth(900, 0));
    RgbdFrame frame = RgbdFrame.decode(Samples.bytes(message));
    Check.that(frame.colour != null && frame.depth != null && frame.camera.fx == 60, "whole");
    Check.equal(frame.complaint, "");
    message.image_types[1] = images_t.DEPTH_MM_ZIPPED;
    frame = RgbdFrame.decode(Samples.bytes(message));
    Check.that(frame.colour != null && frame.depth == null, "colour only");
    Check.that(frame.complaint.contains("damaged depth"), frame.complaint);
    message.image_types = new short[] {images_t.DISPARITY, images_t.MASK_ZIPPED};
    Check.equal(RgbdFrame.decode(Samples.bytes(message)).complaint, "neither colour nor depth among 2 images");
  }

  // Any bytes give a frame, with or without a complaint, or are refused; nothing else is thrown.
  private static void damaged() throws Exception {
    byte[] good = Samples.bytes(Samples.frame(Samples.jpeg(9), images_t.DEPTH_MM, Samples.depth(900, 0)));
    for (int size : new int[] {0, 7, 8, 16, 100, good.length - 1}) {
      Check.refused("damaged images_t", () -> RgbdFrame.decode(Arrays.copyOf(good, size)));
    }
    Random random = new Random(1);
    int refused = 0;
    for (int i = 0; i < 300; ++i) {
      byte[] bad = good.clone();
      for (int k = 0; k < 3; ++k) bad[8 + random.nextInt(k == 0 ? 60 : bad.length - 8)] = (byte) random.nextInt();
      try {
        RgbdFrame.decode(bad);
      } catch (BadMessage expected) {
        ++refused;
      }
    }
    Check.that(refused > 20, refused + " of 300 refused");
  }
}
