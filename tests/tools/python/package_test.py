"""Tests of the Python package: logs, frames as arrays, what a subscriber asks for. Usage: PYTHONPATH=build/python package_test.py"""

import io
import pathlib
import struct
import subprocess
import sys
import tempfile
import types
import unittest
import zlib
from unittest import mock

import numpy
from houghstream import event_log, image_t, images_t, object_pose_t, object_poses_t, subscriber
from houghstream.frames import decode_frame
from PIL import Image

WIDTH, HEIGHT = 6, 4
DEPTH = numpy.arange(WIDTH * HEIGHT, dtype="<u2").reshape(HEIGHT, WIDTH) * 100


def image_of(data, pixelformat, stride=0):
    image = image_t()
    image.utime, image.width, image.height = 5, WIDTH, HEIGHT
    image.row_stride, image.pixelformat = stride, pixelformat
    image.data, image.size = data, len(data)
    return image


def grey():
    return image_of(bytes(WIDTH * HEIGHT), image_t.PIXEL_FORMAT_GRAY, WIDTH)


def jpeg():
    out = io.BytesIO()
    Image.new("RGB", (WIDTH, HEIGHT), (9, 9, 9)).save(out, "JPEG")
    return image_of(out.getvalue(), image_t.PIXEL_FORMAT_MJPEG)


def raw_depth(stride=0, data=DEPTH.tobytes()):
    return image_of(data, image_t.PIXEL_FORMAT_LE_GRAY16, stride)


def frame_of(colour, depth, kind=images_t.DEPTH_MM):
    frame = images_t()
    frame.utime, frame.n_images = 5, 2
    frame.image_types, frame.images = [images_t.LEFT, kind], [colour, depth]
    return decode_frame(frame.encode())


class Depth(unittest.TestCase):
    def check(self, frame):
        self.assertEqual(frame.depth.dtype, numpy.float32)
        self.assertTrue(numpy.isnan(frame.depth[0, 0]))
        numpy.testing.assert_allclose(frame.depth[1:], 1e-3 * DEPTH[1:], rtol=1e-6)

    def test_raw_with_and_without_a_row_stride(self):
        self.check(frame_of(grey(), raw_depth()))
        self.check(frame_of(grey(), raw_depth(2 * WIDTH)))
        padded = numpy.pad(DEPTH, ((0, 0), (0, 2))).tobytes()
        self.check(frame_of(grey(), raw_depth(2 * WIDTH + 4, padded)))
        self.check(frame_of(grey(), raw_depth(2 * WIDTH + 4, padded[:-4])))

    def test_zipped_is_what_is_said_to_be_so(self):
        zipped = zlib.compress(DEPTH.tobytes())
        self.check(frame_of(grey(), raw_depth(0, zipped), images_t.DEPTH_MM_ZIPPED))
        self.check(frame_of(grey(), raw_depth(2 * WIDTH, zipped), images_t.DEPTH_MM_ZIPPED))
        for wrong in (zipped[:-8], zipped[2:], zlib.compress(bytes(7)), zlib.compress(bytes(1000))):
            with self.assertRaisesRegex(ValueError, "image 5: depth"):
                frame_of(grey(), raw_depth(0, wrong), images_t.DEPTH_MM_ZIPPED)
        with self.assertRaisesRegex(ValueError, "expected 6 x 4 pixels of 2 bytes"):
            frame_of(grey(), raw_depth(0, zipped))

    def test_raw_of_another_size_is_refused(self):
        for stride, size in ((0, 47), (0, 49), (10, 48), (16, 59), (16, 65)):
            with self.assertRaisesRegex(ValueError, "expected 6 x 4 pixels of 2 bytes"):
                frame_of(grey(), raw_depth(stride, bytes(size)))


class Colour(unittest.TestCase):
    def test_a_jpeg_is_decoded(self):
        self.assertEqual(frame_of(jpeg(), raw_depth()).colour.shape, (HEIGHT, WIDTH, 3))

    def test_a_jpeg_that_is_cut_or_none_is_a_value_error(self):
        whole = jpeg().data
        for size in (0, 1, 10, len(whole) // 2, len(whole) - 20):
            with self.assertRaisesRegex(ValueError, "image 5: a JPEG of .* damaged or cut"):
                frame_of(image_of(whole[:size], image_t.PIXEL_FORMAT_MJPEG), raw_depth())


class EventLog(unittest.TestCase):
    def test_lengths_that_lcm_does_not_write_are_damage(self):
        with tempfile.TemporaryDirectory() as folder:
            log = pathlib.Path(folder) / "log"
            for channel_size, data_size in ((7, 0x7FFFFFFF), (0x7FFFFFFF, 5), (-1, 5)):
                log.write_bytes(event_log.HEADER.pack(event_log.SYNC, 0, 1, channel_size, data_size) + b"CHANNEL12345")
                with self.assertRaisesRegex(event_log.DamagedLog, "no valid header"):
                    list(event_log.read_log(log))


class Examples(unittest.TestCase):
    """Those that print lines, as people use them: into a pipe whose reader has had enough."""

    FOLDER = pathlib.Path(__file__).resolve().parents[3] / "tools/examples/python"

    @staticmethod
    def write_poses(log, quaternion):
        """A hundred events of a hundred poses each."""
        pose = object_pose_t()
        pose.class_name, pose.class_id, pose.status, pose.quat = "mug", 1, object_pose_t.VALID, quaternion
        message = object_poses_t()
        message.poses, message.n_poses = 100 * [pose], 100
        channel, data = b"HOUGHSTREAM_POSES", message.encode()
        log.write_bytes(b"".join(struct.pack(">IQQII", 0xEDA1DA01, i, i, len(channel), len(data)) + channel + data
                                 for i in range(100)))  # fmt: skip

    def test_what_the_library_says_is_not_among_what_they_print(self):
        if not hasattr(sys.modules["houghstream"], "listen"):
            self.skipTest("built without pybind11")
        with tempfile.TemporaryDirectory(prefix="package_test_") as folder:
            log = pathlib.Path(folder) / "poses.lcmlog"
            self.write_poses(log, [0.0, 0.0, 0.0, 0.0])
            said = subprocess.run([f"{self.FOLDER}/listen.py", f"file://{log}"], capture_output=True, text=True, timeout=60, check=False)
            self.assertEqual(said.stdout, "")
            self.assertIn("quaternion of length 0", said.stderr)

    def test_head_ends_them_without_a_word(self):
        examples = self.FOLDER
        with tempfile.TemporaryDirectory(prefix="package_test_") as folder:
            log = pathlib.Path(folder) / "poses.lcmlog"
            self.write_poses(log, [1.0, 0.0, 0.0, 0.0])
            for line in (f"{examples}/read_log.py {log}", f"{examples}/listen.py file://{log}"):
                if "listen" in line and not hasattr(sys.modules["houghstream"], "listen"):  # built without pybind11
                    continue
                said = subprocess.run(["sh", "-c", f"{line} | head -n 1"], capture_output=True, text=True, timeout=60, check=False)
                self.assertIn("mug ", said.stdout, line)
                self.assertEqual(said.stderr, "", line)


class Subscriber(unittest.TestCase):
    def test_the_whole_name_must_match(self):
        bus = mock.Mock()
        bus.handle.side_effect = KeyboardInterrupt
        with mock.patch.dict(sys.modules, {"lcm": types.SimpleNamespace(LCM=lambda url: bus)}):
            with self.assertRaises(KeyboardInterrupt):
                subscriber.subscribe("LEFT|RIGHT", print)
        bus.subscribe.assert_called_once_with("(LEFT|RIGHT)", print)


if __name__ == "__main__":
    unittest.main()
