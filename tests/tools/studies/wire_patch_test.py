"""Tests of what is told of encoded messages, and of logs. Usage: PYTHONPATH=tools:build/python wire_patch_test.py"""

import pathlib
import struct
import tempfile
import unittest
import zlib

from houghstream import detections_t
from houghstream.event_log import DamagedLog, read_log, write_event
from studies.wire_patch import frame_of, utime_of, with_utime


class Log(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.file = pathlib.Path(place.name, "a.lcmlog")

    def write(self, *events):
        with open(self.file, "wb") as log:
            for number, event in enumerate(events):
                write_event(log, number, event)
        return self.file.read_bytes()

    def test_what_is_written_is_read(self):
        events = [(2, "A", b"xyz"), (5, "AB", b"")]
        self.write(*events)
        self.assertEqual(list(read_log(self.file)), events)

    def test_cut_and_damaged_logs_are_refused_by_name(self):
        whole = self.write((2, "A", b"xyz"))
        for log in (whole[:-1], whole[:10], struct.pack(">I", 7) + whole[4:], whole + b"\0" * 28):
            self.file.write_bytes(log)
            with self.assertRaisesRegex(DamagedLog, "a.lcmlog"):
                list(read_log(self.file))

    def test_a_channel_that_is_no_text_is_damage(self):
        whole = self.write((2, "AB", b"xyz"))
        self.file.write_bytes(whole.replace(b"AB", b"\xff\xfe"))
        with self.assertRaisesRegex(DamagedLog, "event 0 has a channel of"):
            list(read_log(self.file))

    def test_seals_are_checked_and_not_shown(self):
        events = [(2, "A", b"xyz"), (5, "AB", b"")]
        sums = [zlib.crc32(struct.pack(">q", time) + name.encode() + data) for time, name, data in events]
        seal = (2, "HOUGHSTREAM_SEAL", b"HSSEAL1\0" + struct.pack(">III", 2, *sums))
        whole = self.write(seal, *events, seal, *events)
        self.assertEqual(list(read_log(self.file)), events * 2)
        self.file.write_bytes(whole.replace(b"xyz", b"xYz"))
        with self.assertRaisesRegex(DamagedLog, "event 1 on A is damaged"):
            list(read_log(self.file))
        self.write(seal, events[0])
        with self.assertRaisesRegex(DamagedLog, "1 sealed events are missing at its end"):
            list(read_log(self.file))
        self.write(seal, events[0], seal, *events)
        with self.assertRaisesRegex(DamagedLog, "1 sealed events are missing before event 2"):
            list(read_log(self.file))
        for wrong in (seal[2][:-1], b"HSSEAL1\0", b"HSSEAL2" + seal[2][7:]):
            self.write((2, "HOUGHSTREAM_SEAL", wrong), *events)
            with self.assertRaisesRegex(DamagedLog, "a damaged seal"):
                list(read_log(self.file))


class Encoded(unittest.TestCase):
    def test_frame_and_time_stand_in_front(self):
        message = detections_t()
        message.utime, message.source_channel = 77, "LEFT"
        self.assertEqual(frame_of(message.encode()), ("LEFT", 77))
        later = with_utime(message.encode(), 78)
        self.assertEqual((utime_of(later), detections_t.decode(later).source_channel), (78, "LEFT"))


if __name__ == "__main__":
    unittest.main()
