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
    colour = _colour(_image(message, "colour", images_t.LEFT))
    depth = _depth(_image(message, "depth", images_t.DEPTH_MM, images_t.DEPTH_MM_ZIPPED))
    if colour.shape[:2] != depth.shape:
        raise ValueError(f"frame {message.utime}: colour {colour.shape[:2]} and depth {depth.shape} differ in size")
    return Frame(message.utime, colour, depth, _camera(message))


def _image(message, what, *kinds):
    for kind, image in zip(message.image_types, message.images):
        if kind in kinds:
            return image
    raise ValueError(f"frame {message.utime}: no {what} among its {message.n_images} images")


def _rows(image, data, bytes_per_pixel):
    used = image.width * bytes_per_pixel
    stride = image.row_stride or used
    if image.width <= 0 or image.height <= 0 or stride < used or len(data) < stride * image.height:
        raise ValueError(f"image {image.utime}: {len(data)} bytes for {image.width} x {image.height} pixels")
    rows = numpy.frombuffer(data, numpy.uint8, stride * image.height).reshape(image.height, stride)
    return numpy.ascontiguousarray(rows[:, :used])


def _colour(image):
    if image.pixelformat == image_t.PIXEL_FORMAT_MJPEG:
        from PIL import Image

        with Image.open(io.BytesIO(image.data)) as picture:
            if picture.size != (image.width, image.height):
                raise ValueError(f"image {image.utime}: a JPEG of {picture.size}, expected {image.width} x {image.height}")
            return numpy.asarray(picture.convert("RGB"))
    channels = CHANNELS.get(image.pixelformat)
    if channels is None:
        raise ValueError(f"image {image.utime}: pixel format {image.pixelformat}, expected GRAY, RGB, BGR, RGBA, BGRA or MJPEG")
    pixels = _rows(image, image.data, channels).reshape(image.height, image.width, channels)
    if channels == 1:
        return pixels.repeat(3, axis=2)
    return numpy.ascontiguousarray(pixels[:, :, 2::-1] if image.pixelformat in BLUE_FIRST else pixels[:, :, :3])


def _depth(image):
    data = image.data
    if image.row_stride == 0 or len(data) != image.row_stride * image.height:
        unpacker = zlib.decompressobj()
        try:
            data = unpacker.decompress(data, 2 * image.width * image.height + 1)
        except zlib.error as error:
            raise ValueError(f"image {image.utime}: depth does not unpack: {error}") from error
        if len(data) != 2 * image.width * image.height:
            raise ValueError(f"image {image.utime}: depth of {len(data)} bytes, expected {image.width} x {image.height} pixels")
    stride = image.row_stride if len(data) == image.row_stride * image.height else 2 * image.width
    pixels = numpy.frombuffer(data, numpy.uint8).reshape(image.height, stride)[:, : 2 * image.width]
    millimetres = numpy.ascontiguousarray(pixels).view("<u2").astype(numpy.float32)
    return numpy.where(millimetres > 0, millimetres * numpy.float32(1e-3), numpy.float32("nan"))


def _camera(message):
    for image in message.images:
        for entry in image.metadata:
            if entry.key == CAMERA:
                return camera_t.decode(bytes(entry.value))
    return None
