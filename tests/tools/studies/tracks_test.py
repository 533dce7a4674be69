"""The sums of tools/bench tracks over its sequences, and its requests for them."""

import contextlib
import io
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

from houghstream import objects_t, stage_time_t, tracked_object_t
from houghstream.event_log import write_event
from studies.command import REPOSITORY
from studies.tracks import hosts, host_records
from studies.tracks.__main__ import SEQUENCES, parse
from studies.tracks.plan import Plan
from studies.tracks.report import longest, pooled, tracks_are_equal


def figures(name, required_and_recall, wrong, switches, counts):
    required, recall = required_and_recall
    return {"name": name, "required": required, "recall": recall, "wrong": wrong, "id_switches": switches,
            "hota_counts": [counts, counts], "kept": 10, "error": {"moving": {"mm_p95": None}}}  # fmt: skip


class Heard:
    """A record of a second at 10 Hz: host a's poses come 50 ms after each frame, host b's 100 ms after each second one."""

    def __init__(self):
        self.frames = {number: 100.0 + 0.1 * number for number in range(10)}
        self.poses = [(when + 0.05, number, {"mug"}) for number, when in self.frames.items()]
        self.poses += [(when + 0.1, number, {"can"}) for number, when in self.frames.items() if number % 2 == 0]
        self.poses += [(when + 0.01, number, set()) for number, when in self.frames.items()]  # a host without the model
        self.worlds = [(when + 0.06, number, {"mug": (tracked_object_t.VISIBLE, 1.0), "can": self.can(number)})
                       for number, when in self.frames.items()]  # fmt: skip

    @staticmethod
    def can(number):
        """State and probability after a frame."""
        return (tracked_object_t.VISIBLE, 1.0) if number < 4 else (tracked_object_t.UNRECOGNISED, 0.5) if number < 8 else (tracked_object_t.GONE, 0.1)


class HostsTest(unittest.TestCase):
    PARTS = {"a": ["mug", "bowl"], "b": ["can"]}

    def test_both_parts_hold_as_many_of_what_is_seen(self):
        self.assertEqual(hosts.divided(list("abcdefgh"), {"a", "b", "c", "g"}), [["a", "c", "d", "f"], ["b", "g", "e", "h"]])

    def test_each_hosts_poses_are_counted_by_their_objects(self):
        told = host_records.figures(Heard(), 100.0, 101.0, self.PARTS)
        self.assertEqual(told["sent_hz"], 10.0)
        self.assertEqual((told["a"]["hz"], told["a"]["p50_ms"]), (10.0, 50.0))
        self.assertEqual((told["b"]["hz"], told["b"]["p50_ms"]), (5.0, 100.0))
        self.assertEqual(told["world"]["p50_ms"], 60.0)
        self.assertEqual((told["a"]["objects"], told["b"]["objects"]), (1, 0))
        self.assertEqual(host_records.figures(Heard(), 100.0, 100.35, self.PARTS)["b"]["objects"], 1)

    def test_a_host_that_says_nothing_has_no_times(self):
        heard = Heard()
        heard.poses = []
        self.assertEqual(host_records.figures(heard, 100.0, 101.0, self.PARTS)["a"], {"hz": 0.0, "p50_ms": None, "p99_ms": None, "objects": 1})

    def test_what_becomes_of_a_lost_hosts_objects(self):
        lost = host_records.lost_host(Heard(), {"cut": 100.2, "joined": 100.75, "end": 101.0}, self.PARTS, 3.1)
        self.assertEqual((lost["said_s"], lost["unseen_s"], lost["gone_s"]), (3.1, 0.26, 0.66))
        self.assertEqual((lost["objects"], lost["probability_in_the_end"]), (1, 0.5))
        self.assertAlmostEqual(lost["back_s"], 0.15)
        self.assertIsNone(lost["visible_again_s"])


class TracksTest(unittest.TestCase):
    def test_shares_follow_the_counts(self):
        both = pooled([figures("pushed", (300, 0.9), {"can": 10}, 1, (90, 10, 0, 81)), figures("cans", (100, 0.5), {}, 2, (0, 60, 40, 0))])
        self.assertEqual(both["sequences"], ["pushed", "cans"])
        self.assertAlmostEqual(both["recall"], (270 + 50) / 400)
        self.assertAlmostEqual(both["precision"], 340 / 350)
        self.assertEqual(both["id_switches"], 3)
        self.assertAlmostEqual(both["hota"], math.sqrt(81 / 200))
        self.assertIsNone(both["moving_mm_p95"], "nothing moved")

    def test_what_was_never_found_has_no_longest_time(self):
        self.assertEqual(longest([[0.1, 0.4], [0.2]]), 0.4)
        self.assertIsNone(longest([[0.1], [None]]))
        self.assertIsNone(longest([[], []]))

    def test_tracks_are_equal_bit_for_bit_but_for_the_times_of_stages(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        (pathlib.Path(place.name) / "tracks").mkdir()

        class Store:
            def path(self, name):
                return pathlib.Path(place.name) / name

        def write(name, duration_us, x):
            world = objects_t()
            world.utime, world.source_channel, world.world = 5, "CAMERA_1", "WORLD"
            world.camera_trans[0] = x
            stage = stage_time_t()
            stage.stage, stage.duration_us = "track.update", duration_us
            world.n_stages, world.stages = 1, [stage]
            with open(Store().path(f"tracks/{name}.lcmlog"), "wb") as log:
                write_event(log, 0, (5, "HOUGHSTREAM_OBJECTS", world.encode()))

        write("walk", 100, 0.1)
        write("walk_again", 200, 0.1)
        write("cans", 100, 0.1)
        write("cans_again", 100, math.nextafter(0.1, 1.0))
        self.assertTrue(tracks_are_equal(Store(), ["walk"]))
        self.assertFalse(tracks_are_equal(Store(), ["walk", "cans"]))

    def test_programs_without_their_messages_are_named(self):
        with tempfile.TemporaryDirectory() as folder:
            words = [sys.executable, "-m", "studies.tracks", "--no-stream", "--no-hosts", "--bin", folder, "--out", f"{folder}/out"]
            environment = {**os.environ, "PYTHONPATH": "tools"}
            run = subprocess.run(words, cwd=REPOSITORY, env=environment, capture_output=True, text=True, check=False)
        self.assertEqual(run.returncode, 1)
        self.assertIn(f"{os.path.realpath(folder)}: no Python package houghstream", run.stderr)
        self.assertNotIn("Traceback", run.stderr)

    def test_options(self):
        options = parse(["--sequences", "cans,walk", "--forest", "f", "--models", "m", "--out", "here"])
        self.assertEqual(options.sequences, ("walk", "cans"))
        self.assertEqual(parse([]).sequences, SEQUENCES)
        for words in (["--sequences", "dance"], ["--forest", "f"]):
            with self.assertRaises(SystemExit), contextlib.redirect_stderr(io.StringIO()):
                parse(words)

    def test_each_sequence_is_rendered_searched_tracked_twice_and_compared(self):
        plan = Plan(parse(["--forest", "f", "--models", "m"]))
        plan.sequence("cans")
        names = [unit.name for unit in plan.units.all()]
        self.assertEqual(names, ["rendered/cans", "frames/cans.lcmlog", "detected/cans.lcmlog", "posed/cans.lcmlog",
                                 "found/cans.lcmlog", "tracks/cans.lcmlog", "tracks/cans_again.lcmlog", "tracked/cans.json",
                                 "single/cans.json"])  # fmt: skip
        plan.sequence("cameras")
        self.assertIn("tracked/CAMERA_2.json", [unit.name for unit in plan.units.all()])


if __name__ == "__main__":
    unittest.main()
