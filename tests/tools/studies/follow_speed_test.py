"""Tests of what is measured of hs-pose --follow. Usage: PYTHONPATH=tools:build/python follow_speed_test.py"""

import json
import pathlib
import struct
import tempfile
import unittest

from houghstream.event_log import read_log, write_event
from studies import follow_speed
from studies.wire_patch import utime_of


def observed(p50, p99, received, skipped):
    return {
        "objects_latency_ms": {"p50": p50 + 1.0, "p95": p50 + 1.0, "p99": p99 + 1.0},
        "frames_with_objects": received - skipped,
        "latency_ms": {"total": {"p50": p50, "p95": p50, "p99": p99}, "detect": {}, "pose": {}},
        "processes": {"hs-pose": {"received": received, "skipped": skipped, "lost": 0},
                      "hs-detect": {"received": 600, "skipped": 550, "lost": 0}},
    }  # fmt: skip


class Figures(unittest.TestCase):
    def folder(self, observe):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        folder = pathlib.Path(place.name)
        usage = {"cpu_cores": 0.7, "cores": {"detect": 0.2, "pose": 0.4, "track": 0.1}, "rss_mb": {}}
        (folder / "observe.json").write_text(json.dumps(observe))
        (folder / "usage.json").write_text(json.dumps(usage))
        return folder

    def test_frames_are_those_of_hs_pose_not_those_that_the_detector_skips_by_its_budget(self):
        found = follow_speed.figures(self.folder(observed(5.0, 9.0, 598, 3)), 600)
        expected = {"p50_ms": 5.0, "p99_ms": 9.0, "objects_p50_ms": 6.0, "objects_p99_ms": 10.0, "lost": 2, "skipped": 0.005,
                    "without_objects": 0.00833, "cores": 0.7, "cores_detect": 0.2, "cores_pose": 0.4, "cores_track": 0.1}  # fmt: skip
        self.assertEqual(found, expected)

    def test_of_several_rounds_the_median_of_each_figure_counts(self):
        rounds = [follow_speed.figures(self.folder(observed(p50, p99, 600, 0)), 600) for p50, p99 in ((5, 30), (4, 9), (6, 8))]
        self.assertEqual(follow_speed.medians(rounds)["p50_ms"], 5)
        self.assertEqual(follow_speed.medians(rounds)["p99_ms"], 9)

    def test_frames_get_the_times_of_a_camera_of_that_rate(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        source, target = pathlib.Path(place.name) / "a", pathlib.Path(place.name) / "b"
        with open(source, "wb") as log:
            for i in range(3):
                data = struct.pack(">qq", 42, 33333 * i) + b"pixels"
                write_event(log, i, (16667 * i, "FRAME", data))
        follow_speed.restamp(source, target, 60)
        events = list(read_log(target))
        self.assertEqual([utime_of(data) - follow_speed.FIRST_UTIME for _, _, data in events], [0, 16667, 33333])
        self.assertEqual({(name, data[:8], data[16:]) for _, name, data in events}, {("FRAME", struct.pack(">q", 42), b"pixels")})
        self.assertEqual([timestamp for timestamp, _, _ in events], [0, 16667, 33334])

    def test_a_log_is_made_once_of_each_scene_and_length(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        folder = pathlib.Path(place.name)
        capture, scene, log = folder / "hs-capture", folder / "scene", folder / "following_30.lcmlog"
        capture.write_text('#!/bin/sh\necho "$7" >>"$(dirname "$0")/calls"\n: >"$9"\n')
        capture.chmod(0o755)
        scene.mkdir()
        for image, seconds in (("a", 60), ("a", 60), ("a", 20), ("b", 20)):
            (scene / "picture").write_text(image)
            self.assertEqual(follow_speed.make_log(folder, scene, 30, seconds, log), log)
            self.assertTrue(log.exists())
        self.assertEqual((folder / "calls").read_text().split(), ["1800", "600", "600"])


if __name__ == "__main__":
    unittest.main()
