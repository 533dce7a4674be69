package houghstream.spy;

import houghstream.image_t;
import houghstream.spy.Wire.BadMessage;
import java.awt.image.BufferedImage;
import java.io.ByteArrayInputStream;
import java.io.IOException;
import java.util.Iterator;
import javax.imageio.ImageIO;
import javax.imageio.ImageReader;
import javax.imageio.stream.ImageInputStream;

/** Colour or grey pictures out of image_t. */
final class ImageDecoder {
  private static final long MAX_PIXELS = 4096L * 4096L;

  private ImageDecoder() {}

  static BufferedImage colour(image_t image) throws BadMessage {
    checkSize(image);
    switch (image.pixelformat) {
      case image_t.PIXEL_FORMAT_MJPEG:
        return jpeg(image);
      case image_t.PIXEL_FORMAT_RGB:
        return raw(image, 3, 0, 1, 2);
      case image_t.PIXEL_FORMAT_BGR:
        return raw(image, 3, 2, 1, 0);
      case image_t.PIXEL_FORMAT_GRAY:
        return raw(image, 1, 0, 0, 0);
      default:
        throw new BadMessage("pixel format " + image.pixelformat + ", expected RGB, BGR, GRAY or MJPEG");
    }
  }

  static void checkSize(image_t image) throws BadMessage {
    long pixels = (long) image.width * image.height;
    if (image.width <= 0 || image.height <= 0 || pixels > MAX_PIXELS) {
      throw new BadMessage("image of " + image.width + "x" + image.height + " pixels");
    }
  }

  /** Bytes from one row to the next; checks that all rows are there. */
  static int stride(image_t image, int bytesPerPixel) throws BadMessage {
    int row = image.width * bytesPerPixel;
    int stride = image.row_stride == 0 ? row : image.row_stride;
    if (stride < row || (long) stride * (image.height - 1) + row > image.data.length) {
      throw new BadMessage("raw image of " + image.data.length + " bytes, expected " + row + " for each of "
          + image.height + " rows");
    }
    return stride;
  }

  private static BufferedImage raw(image_t image, int bytesPerPixel, int red, int green, int blue) throws BadMessage {
    int stride = stride(image, bytesPerPixel);
    int[] row = new int[image.width];
    BufferedImage picture = new BufferedImage(image.width, image.height, BufferedImage.TYPE_INT_RGB);
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        int at = y * stride + x * bytesPerPixel;
        row[x] = (image.data[at + red] & 255) << 16 | (image.data[at + green] & 255) << 8 | image.data[at + blue] & 255;
      }
      picture.getRaster().setDataElements(0, y, image.width, 1, row);
    }
    return picture;
  }

  // The size in the JPEG's own header is compared before memory is asked for.
  private static BufferedImage jpeg(image_t image) throws BadMessage {
    Iterator<ImageReader> readers = ImageIO.getImageReadersByFormatName("jpeg");
    if (!readers.hasNext()) throw new BadMessage("this Java cannot read JPEG");
    ImageReader reader = readers.next();
    ImageIO.setUseCache(false);
    try (ImageInputStream stream = ImageIO.createImageInputStream(new ByteArrayInputStream(image.data))) {
      reader.setInput(stream, true, true);
      if (reader.getWidth(0) != image.width || reader.getHeight(0) != image.height) {
        throw new BadMessage("JPEG of " + reader.getWidth(0) + "x" + reader.getHeight(0) + " pixels, expected "
            + image.width + "x" + image.height);
      }
      return reader.read(0);
    } catch (IOException | RuntimeException error) {
      throw new BadMessage("damaged JPEG of " + image.data.length + " bytes");
    } finally {
      reader.dispose();
    }
  }
}
