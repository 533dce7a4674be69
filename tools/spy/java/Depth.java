package houghstream.spy;

import houghstream.image_t;
import houghstream.spy.Wire.BadMessage;
import java.awt.Color;
import java.awt.image.BufferedImage;
import java.util.zip.DataFormatException;
import java.util.zip.Inflater;

/** Depth in millimetres, 0 where nothing was measured. */
final class Depth {
  private static final int NEAR_MM = 400; // red end of the colour map, as in hs-view
  private static final int FAR_MM = 3500; // blue end; beyond it stays blue
  private static final int[] COLOURS = colours();

  final int width;
  final int height;
  private final byte[] bytes;
  private final int stride;

  private Depth(image_t image, byte[] bytes, int stride) {
    this.width = image.width;
    this.height = image.height;
    this.bytes = bytes;
    this.stride = stride;
  }

  /** Little-endian uint16, raw or, where `zipped`, as a zlib stream. */
  static Depth decode(image_t image, boolean zipped) throws BadMessage {
    ImageDecoder.checkSize(image);
    return zipped ? new Depth(image, unzip(image), 2 * image.width)
        : new Depth(image, image.data, ImageDecoder.stride(image, 2));
  }

  // Never unpacks more than the image's size.
  private static byte[] unzip(image_t image) throws BadMessage {
    byte[] bytes = new byte[2 * image.width * image.height];
    Inflater inflater = new Inflater();
    try {
      inflater.setInput(image.data);
      int unpacked = 0;
      while (unpacked < bytes.length) {
        int more = inflater.inflate(bytes, unpacked, bytes.length - unpacked);
        if (more == 0) throw new BadMessage("depth ends after " + unpacked + " of " + bytes.length + " bytes");
        unpacked += more;
      }
      return bytes;
    } catch (DataFormatException error) {
      throw new BadMessage("damaged depth of " + image.data.length + " bytes");
    } finally {
      inflater.end();
    }
  }

  int millimetres(int x, int y) {
    int at = y * stride + 2 * x;
    return bytes[at] & 255 | (bytes[at + 1] & 255) << 8;
  }

  /** Near is warm, far is cold, no measurement is black. */
  BufferedImage picture() {
    BufferedImage picture = new BufferedImage(width, height, BufferedImage.TYPE_INT_RGB);
    int[] row = new int[width];
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) row[x] = COLOURS[Math.min(millimetres(x, y), FAR_MM)];
      picture.getRaster().setDataElements(0, y, width, 1, row);
    }
    return picture;
  }

  /** Nearest and farthest measurement and the share of measured pixels, for people. */
  String summary() {
    int near = Integer.MAX_VALUE;
    int far = 0;
    int measured = 0;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        int mm = millimetres(x, y);
        if (mm == 0) continue;
        ++measured;
        near = Math.min(near, mm);
        far = Math.max(far, mm);
      }
    }
    if (measured == 0) return "no depth measured";
    return String.format("depth %.2f to %.2f m, %.0f %% measured", near * 1e-3, far * 1e-3,
        100.0 * measured / ((double) width * height));
  }

  private static int[] colours() {
    int[] colours = new int[FAR_MM + 1];
    for (int mm = 1; mm <= FAR_MM; ++mm) {
      float share = Math.max(0.0F, (float) (mm - NEAR_MM) / (FAR_MM - NEAR_MM));
      colours[mm] = Color.HSBtoRGB(0.68F * share, 0.9F, 0.95F);
    }
    return colours;
  }
}
