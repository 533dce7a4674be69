"""Tests of the one reader of LCM logs. Usage: PYTHONPATH=tools lcm_log_test.py"""

import pathlib
import struct
import tempfile
import unittest

from studies import lcm_log


def event(channel, data, sync=lcm_log.SYNC):
    return struct.pack(">Iqqii", sync, 1, 2, len(channel), len(data)) + channel + data


class ReadLog(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.file = pathlib.Path(place.name, "a.lcmlog")

    def test_only_events_of_the_channel_count(self):
        self.file.write_bytes(event(b"A", b"xyz") + event(b"AB", b"") + event(b"A", b""))
        self.assertEqual(lcm_log.count_events(self.file, "A"), 2)
        self.assertEqual(list(lcm_log.read_log(self.file))[0], (2, "A", b"xyz"))

    def test_cut_and_damaged_logs_are_refused_by_name(self):
        whole = event(b"A", b"xyz")
        for log in (whole[:-1], whole[:10], event(b"A", b"xyz", sync=7), whole + b"\0" * 28):
            self.file.write_bytes(log)
            with self.assertRaisesRegex(lcm_log.DamagedLog, "a.lcmlog"):
                lcm_log.count_events(self.file, "A")


def text(words):
    return struct.pack(">i", len(words) + 1) + words.encode() + b"\0"


class Messages(unittest.TestCase):
    def test_what_a_process_knows_and_how_a_teaching_goes(self):
        head = bytes(8) + struct.pack(">q", 77)
        known = lcm_log.known_objects_of(
            head + text("hs-pose") + struct.pack(">i", 5) + text("my.store") + struct.pack(">qi", 60, 2)
            + text("mug") + text("bowl") + struct.pack(">2q", 50, 60) + text("cut short")
        )  # fmt: skip
        self.assertEqual((known.utime, known.process, known.since), (77, "hs-pose", 60))
        self.assertEqual((known.objects, known.problem), ({"mug": 50, "bowl": 60}, "cut short"))
        teaching = lcm_log.teaching_of(
            head + text("CAM") + text("mug") + struct.pack(">b", 2) + text("go on") + struct.pack(">fii4f", 0.5, 9, 3, 1, 2, 3, 4)
            + bytes(7 * 8) + struct.pack(">i6f2b", 2, *([0.0] * 6), 1, 0)
        )  # fmt: skip
        self.assertEqual((teaching.utime, teaching.name, teaching.state, teaching.message), (77, "mug", "tracking", "go on"))
        self.assertEqual((teaching.progress, teaching.frames, teaching.keyframes), (0.5, 9, 3))
        self.assertEqual((teaching.box, teaching.seen), ((1, 2, 3, 4), (1, 0)))

    def test_poses_are_read_from_front_to_back(self):
        pose = (
            struct.pack(">i5s", 5, b"bowl\0")
            + struct.pack(">fib", 0.5, 3, 1)
            + struct.pack(">3d4d", 1, 2, 3, 1, 0, 0, 0)
        )
        pose += struct.pack(">bii5f", 1, 2, 3, 0, 0, 0, 0, 0)
        data = bytes(8) + struct.pack(">qi3si", 77, 3, b"CH\0", 2) + 2 * (struct.pack(">i", 4) + pose)
        self.assertEqual(lcm_log.utime_of(data), 77)
        self.assertEqual(lcm_log.poses_of(data), 2 * [("bowl", 3, 1, (1.0, 2.0, 3.0))])


if __name__ == "__main__":
    unittest.main()
