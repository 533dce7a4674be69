"""Tests of what tools/soak sends and counts. Usage: PYTHONPATH=tools:build/python soak_test.py"""

import pathlib
import struct
import tempfile
import unittest

from studies.encoded import utime_of
from studies.soak import __main__ as soak
from studies.soak import faults, frames, relay, wire
from studies.stream import ProcessFailed


def frame(sequence=b"12"):
    key = frames.SEQUENCE
    return (struct.pack(">qq", 7, 1000) + b"x" * 100_000 + struct.pack(">i", len(key) + 1) + key + b"\0"
            + struct.pack(">i", len(sequence)) + sequence + b"rest")  # fmt: skip


class Said:
    """A process that has said something."""

    def __init__(self, words):
        folder = tempfile.mkdtemp()
        self.log = pathlib.Path(folder, "log.txt")
        self.log.write_text(words)

    def fail(self, complaint):
        raise ProcessFailed(complaint)


class Wire(unittest.TestCase):
    def test_a_message_in_fragments_is_whole_again_in_any_order(self):
        payload = frame()
        parts = wire.datagrams(5, "CAMERA", payload)
        self.assertEqual(len(parts), 2)
        self.assertEqual(relay.content(parts[::-1]), ("CAMERA", payload))
        magic, number, size, start, index, count = wire.LONG_HEADER.unpack_from(parts[1])
        self.assertEqual((magic, number, size, index, count), (wire.LONG, 5, len(payload), 1, 2))
        self.assertEqual(parts[1][wire.LONG_HEADER.size :], payload[start:])

    def test_a_small_message_is_one(self):
        self.assertEqual(wire.datagrams(5, "A", b"xyz"), [struct.pack(">II", wire.SHORT, 5) + b"A\0xyz"])


class Frames(unittest.TestCase):
    def test_numbers_of_any_length(self):
        for number in frames.FORGED:
            forged = frames.with_number(frame(), number)
            self.assertEqual(utime_of(forged), 1001)
            self.assertTrue(forged.endswith(struct.pack(">i", len(str(number))) + str(number).encode() + b"rest"))


class Counts(unittest.TestCase):
    WORDS = "12:00:00.000 hs-detect: ends: 290 received, 200 processed, 80 skipped, 10 lost, 10 refused; 3 duplicates\n"

    def test_an_account_is_read_and_added_up(self):
        counts = faults.account(Said(self.WORDS))
        self.assertEqual(counts, {"received": 290, "processed": 200, "skipped": 80, "lost": 10, "refused": 10, "duplicates": 3})
        self.assertTrue(faults.adds_up(300, counts))
        self.assertFalse(faults.adds_up(301, counts))
        with self.assertRaises(ProcessFailed):
            faults.account(Said("nothing\n"))

    def test_what_was_said_is_told_once(self):
        self.assertEqual(faults.said(Said("12:00:00.000 a x\n12:00:01.000 a x\n12:00:01.000 b\n"), "x"), ["a x"])

    def test_the_page_names_each_fault(self):
        seen = {"good": True, "sent": 3, "processed": 2, "skipped": 0, "lost": 1, "refused": 0, "load": 0.1, "reported": ["words"]}
        page = soak.page({"faults": {"loss": seen, "kill": {"good": False, "failed": "why", "load": 2.0}}})
        self.assertIn("| loss | good | 3 sent = 2 + 0 + 1 + 0 |", page)
        self.assertIn("| kill | **WRONG** |", page)
        self.assertIn("    words\n", page)
        self.assertIn("failed why", page)


if __name__ == "__main__":
    unittest.main()
