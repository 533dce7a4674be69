"""Tests of the reader of the UW scenes' boxes. Usage: uw_boxes_test.py SOURCE"""

import importlib.util
import math
import os
import pathlib
import sys
import tempfile
import unittest

import numpy
import scipy.io

SCRIPT = pathlib.Path(sys.argv.pop(1), "tools/evaluate/import/uw_boxes.py")
SPEC = importlib.util.spec_from_file_location("uw_boxes", SCRIPT)
uw_boxes = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(uw_boxes)

SIZE = (64, 48)
GOOD = {"category": "cap", "instance": 1.0, "top": 1.0, "bottom": 2.0, "left": 1.0, "right": 2.0}
# A cell array `bboxes` with one cell that is empty, as a big-endian machine writes it.
BIG_ENDIAN = (b" " * 124 + b"\x01\x00MI" + b"".join(word.to_bytes(4, "big") for word in (14, 56, 6, 8, 1, 0, 5, 8, 1, 1, 1, 6))
              + b"bboxes\0\0\0\0\0\x0e\0\0\0\0")


def cell_of(boxes):
    """A frame's cell: an empty array, or a struct array with the fields of its first box."""
    if not boxes:
        return numpy.zeros((0, 0))
    cell = numpy.empty((1, len(boxes)), [(name, object) for name in boxes[0]])
    for number, box in enumerate(boxes):
        cell[0, number] = tuple(box.values())
    return cell


def cells_of(frames):
    cells = numpy.empty((1, len(frames)), object)
    for number, boxes in enumerate(frames):
        cells[0, number] = boxes if isinstance(boxes, numpy.ndarray) else cell_of(boxes)
    return cells


class UwBoxes(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.file = pathlib.Path(place.name, "desk_1.mat")

    def write(self, *frames, compressed=False):
        scipy.io.savemat(self.file, {"bboxes": cells_of(frames)}, do_compression=compressed)

    def outcome(self):
        """The frames of the file, or the line of its refusal, or what its reader died of; read by a process of its own."""
        into, out = os.pipe()
        child = os.fork()
        if child == 0:
            try:
                told = str(uw_boxes.frames_of(self.file, SIZE))
            except uw_boxes.Refused as refusal:
                told = f"refused: {refusal}"
            os.write(out, told.encode())
            os._exit(0)
        os.close(out)
        with os.fdopen(into, "rb") as pipe:
            told = pipe.read().decode()
        status = os.waitpid(child, 0)[1]
        return told if status == 0 else f"refused: desk_1.mat: its reader ended with {status}"

    def assert_refused(self, expected):
        told = self.outcome()
        self.assertRegex(told, "^refused: [^\n]*desk_1.mat[^\n]*$")
        self.assertIn(expected, told)

    def test_boxes_are_those_of_the_file_frame_by_frame(self):
        mug = {"category": "coffee_mug", "instance": 5, "top": 11, "bottom": 20, "left": 3, "right": 7}
        for compressed in (False, True):
            self.write([], [mug, {**GOOD, "bottom": 48, "right": 64}], [{**GOOD, "instance": 12}], compressed=compressed)
            self.assertEqual(uw_boxes.frames_of(self.file, SIZE), [
                {"frame": "desk_1_1", "objects": []},
                {"frame": "desk_1_2", "objects": [{"object": "coffee_mug_5", "bbox_xyxy": [2, 10, 7, 20]},
                                                  {"object": "cap_1", "bbox_xyxy": [0, 0, 64, 48]}]},
                {"frame": "desk_1_3", "objects": [{"object": "cap_12", "bbox_xyxy": [0, 0, 2, 2]}]}])

    def test_numbers_may_be_of_any_class_and_edges_one_pixel_outside(self):
        self.write([{**GOOD, "instance": numpy.uint16(7), "top": 0, "bottom": 49, "left": 0, "right": 65}])
        self.assertEqual(uw_boxes.frames_of(self.file, SIZE)[0]["objects"], [{"object": "cap_7", "bbox_xyxy": [0, 0, 64, 48]}])

    def test_halves_are_rounded_away_from_zero(self):
        self.write([{**GOOD, "left": 2.5, "right": 3.4}])
        self.assertEqual(uw_boxes.frames_of(self.file, SIZE)[0]["objects"][0]["bbox_xyxy"], [2, 0, 3, 2])

    def test_files_of_the_other_byte_order_are_read(self):
        self.file.write_bytes(BIG_ENDIAN)
        self.assertEqual(self.outcome(), str([{"frame": "desk_1_1", "objects": []}]))

    def test_files_that_are_no_annotations_are_refused(self):
        self.assert_refused("missing")
        for rubbish in (b"", b"x" * 4000):
            self.file.write_bytes(rubbish)
            self.assert_refused("no MATLAB file")
        scipy.io.savemat(self.file, {"bboxes": 3.0}, format="4")
        self.assert_refused("no MATLAB file")
        self.file.write_bytes(b" " * 124 + b"\x00\x02IM")
        self.assert_refused("version 2, expected 1")
        scipy.io.savemat(self.file, {"boxes": cells_of([[GOOD]])})
        self.assert_refused("no variable 'bboxes'")
        scipy.io.savemat(self.file, {"bboxes": 3.0})
        self.assert_refused("1 numbers, expected one cell for each frame")
        self.write(numpy.full((1, 1), 3.0))
        self.assert_refused("numbers, expected structs")

    def test_fields_of_the_wrong_kind_and_absurd_boxes_are_named(self):
        without_right = {name: value for name, value in GOOD.items() if name != "right"}
        for box, expected in (
                ({**GOOD, "category": 4.0}, "field 'category': numbers of length 1, expected text"),
                ({**GOOD, "category": "caf\xe9"}, "field 'category': 'caf\\xe9', expected printable ASCII"),
                ({**GOOD, "instance": "ab"}, "field 'instance': text, expected a number"),
                ({**GOOD, "instance": 1.5}, "1.5, expected a whole number"),
                ({**GOOD, "top": math.nan}, "field 'top': nan, expected a finite number"),
                (without_right, "no field 'right'"),
                ({**GOOD, "top": 10.0, "bottom": 5.0}, "'bboxes' frame 1 box 1: box from left 1 top 10 to right 2 bottom 5"),
                ({**GOOD, "left": 30.0, "right": 20.0}, "box from"), ({**GOOD, "top": -5.0}, "box from"),
                ({**GOOD, "bottom": 500.0}, "box from"), ({**GOOD, "right": 66.0}, "box from"),
                ({**GOOD, "right": 1e300}, "box from"),
                ({**GOOD, "top": 0.0, "bottom": 0.0, "left": 0.0, "right": 0.0}, "lies outside the 64x48 image")):
            with self.subTest(expected=expected):
                self.write([box])
                self.assert_refused(expected)

    def test_cut_off_files_are_refused_at_any_length(self):
        for compressed in (False, True):
            self.write([GOOD], [GOOD], compressed=compressed)
            whole = self.file.read_bytes()
            for size in range(0, len(whole), 37):
                self.file.write_bytes(whole[:size])
                self.assertRegex(self.outcome(), "^refused: ", f"{size} bytes")

    # Of some such bytes scipy ends its process, which hs-import tells in a line of its own.
    def test_damaged_bytes_are_refused_or_read(self):
        for compressed in (False, True):
            self.write([GOOD], compressed=compressed)
            whole = self.file.read_bytes()
            refused = 0
            for at in range(124, len(whole), 5):
                damaged = bytearray(whole)
                damaged[at] ^= 0x90
                self.file.write_bytes(damaged)
                told = self.outcome()
                self.assertRegex(told, "^(refused: [^\n]*desk_1.mat|\\[)")
                refused += told.startswith("refused")
            self.assertGreater(refused, (len(whole) - 124) // 20)


if __name__ == "__main__":
    unittest.main()
