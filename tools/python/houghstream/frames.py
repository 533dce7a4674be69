"""images_t as numpy arrays. JPEG needs Pillow (python3-pil)."""

import io
import zlib
from typing import NamedTuple

import numpy

from houghstream import camera_t, image_t, images_t

CAMERA = "houghstream.camera"  # key of the image's metadata that holds a camera_t
CHANNELS = {image_t.PIXEL_FORMAT_GRAY: 1, image_t.PIXEL_FORMAT_RGB: 3, image_t.PIXEL_FORMAT_BGR: 3,
            image_t.PIXEL_FORMAT_RGBA: 4, image_t.PIXEL_FORMAT_BGRA: 4}  # fmt: skip
BLUE_FIRST = (image_t.PIXEL_FORMAT_BGR, image_t.PIXEL_FORMAT_BGRA)


class Frame(NamedTuple):
    utime: int  # microseconds since the epoch; with the channel the frame's name in every result
    colour: numpy.ndarray  # height x width x 3, uint8, RGB
    depth: numpy.ndarray  # height x width, float32, metres along the optical axis; nan where there is none
    camera: camera_t | None  # width, height, fx, fy, cx, cy in pixels; None where the frame came without


def decode_frame(message):
    """The Frame of an images_t, or of its encoded bytes. Raises ValueError naming what is missing or does not fit."""
    if isinstance(message, (bytes, bytearray, memoryview)):
        message = images_t.decode(bytes(message))
    _, colour_image = _image(message, "colour", images_t.LEFT)
    kind, depth_image = _image(message, "depth", images_t.DEPTH_MM, images_t.DEPTH_MM_ZIPPED)
    colour = _colour(colour_image)
    depth = _depth(depth_image, kind == images_t.DEPTH_MM_ZIPPED)
    if colour.shape[:2] != depth.shape:
        raise ValueError(f"frame {message.utime}: colour {colour.shape[:2]} and depth {depth.shape} differ in size")
    return Frame(message.utime, colour, depth, _camera(message))


def _image(message, what, *kinds):
    """The first image of these kinds, and which it is."""
    for kind, image in zip(message.image_types, message.images):
        if kind in kinds:
            return kind, image
    raise ValueError(f"frame {message.utime}: no {what} among its {message.n_images} images")


def _rows(image, bytes_per_pixel):
    """A raw image's bytes, row by row, without the padding that rows, but the last one, end with."""
    used = image.width * bytes_per_pixel
    stride = image.row_stride or used
    whole = stride * image.height
    fits = image.width > 0 and image.height > 0 and stride >= used and whole - stride + used <= len(image.data) <= whole
    if not fits:
        raise ValueError(
            f"image {image.utime}: {len(image.data)} bytes with row stride {image.row_stride}, "
            f"expected {image.width} x {image.height} pixels of {bytes_per_pixel} bytes"
        )
    rows = numpy.frombuffer(bytes(image.data).ljust(whole, b"\0"), numpy.uint8).reshape(image.height, stride)
    return numpy.ascontiguousarray(rows[:, :used])


def _colour(image):
    if image.pixelformat == image_t.PIXEL_FORMAT_MJPEG:
        return _jpeg(image)
    channels = CHANNELS.get(image.pixelformat)
    if channels is None:
        raise ValueError(f"image {image.utime}: pixel format {image.pixelformat}, expected GRAY, RGB, BGR, RGBA, BGRA or MJPEG")
    pixels = _rows(image, channels).reshape(image.height, image.width, channels)
    if channels == 1:
        return pixels.repeat(3, axis=2)
    return numpy.ascontiguousarray(pixels[:, :, 2::-1] if image.pixelformat in BLUE_FIRST else pixels[:, :, :3])


def _jpeg(image):
    from PIL import Image

    try:
        with Image.open(io.BytesIO(image.data)) as decoded:
            size = decoded.size
            if size == (image.width, image.height):
                return numpy.asarray(decoded.convert("RGB"))
    except (OSError, SyntaxError, EOFError, Image.DecompressionBombError) as error:
        raise ValueError(f"image {image.utime}: a JPEG of {len(image.data)} bytes that is damaged or cut: {error}") from error
    raise ValueError(f"image {image.utime}: a JPEG of {size}, expected {image.width} x {image.height}")


def _depth(image, zipped):
    pixels = _unzipped(image) if zipped else _rows(image, 2)
    millimetres = pixels.view("<u2").astype(numpy.float32)
    return numpy.where(millimetres > 0, millimetres * numpy.float32(1e-3), numpy.float32("nan"))


def _unzipped(image):
    size = 2 * image.width * image.height
    if image.width <= 0 or image.height <= 0:
        raise ValueError(f"image {image.utime}: depth of {image.width} x {image.height} pixels")
    try:
        data = zlib.decompressobj().decompress(image.data, size + 1)
    except zlib.error as error:
        raise ValueError(f"image {image.utime}: depth does not unpack: {error}") from error
    if len(data) != size:
        raise ValueError(f"image {image.utime}: depth of {len(data)} bytes, expected {image.width} x {image.height} pixels")
    return numpy.frombuffer(data, numpy.uint8).reshape(image.height, 2 * image.width)


def _camera(message):
    for image in message.images:
        for entry in image.metadata:
            if entry.key == CAMERA:
                return camera_t.decode(bytes(entry.value))
    return None
