"""Tests of tools/bench teach with stand-ins for the programs that it runs. Usage: PYTHONPATH=tools:build/python teach_test.py"""

import json
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

from houghstream import detection_t, detections_t, teaching_t
from houghstream.event_log import read_log, write_event
from studies.wire_patch import utime_of
from studies.teach.joined_log import FIRST_UTIME, Camera, frames_of, write_joined
from studies.teach.live_teaching import events, times_of
from studies.teach.report import faults
from studies.teach.taught_truth import in_taught_frame
from teach_fakes import MOVED, install

PROMISED = {"mesh_mm_median", "mesh_mm_95", "drift_mm", "drift_deg", "mask_iou", "seen_share", "auc", "auc_true", "add_s",
            "add_s_true", "verdict", "seconds"}  # fmt: skip


class WholeRun(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.folder = pathlib.Path(place.name).resolve()
        self.out, self.log = self.folder / "out", self.folder / "calls"
        self.log.touch()
        install(self.folder / "bin")

    def run_it(self, *options, **more):
        words = [sys.executable, "-m", "studies.teach", "--bin", self.folder / "bin", "--out", self.out, "--quick",
                 "--no-stream", *options]  # fmt: skip
        environment = {**os.environ, "TEACH_FAKE_LOG": str(self.log), **more}
        return subprocess.run(words, env=environment, capture_output=True, text=True)

    def summary(self):
        return json.loads((self.out / "summary.json").read_text())

    def calls(self, name):
        return [line.split() for line in self.log.read_text().splitlines() if line.startswith(name)]

    def test_figures_and_page_of_every_object(self):
        done = self.run_it()
        self.assertEqual(done.returncode, 0, done.stderr)
        summary = self.summary()
        self.assertLessEqual({"objects", "seconds_to_found", "stream", "tracking_hz", "cpu", "commit"}, set(summary))
        self.assertEqual(list(summary["objects"]), ["cereal_box", "coffee_mug"])
        for figures in summary["objects"].values():
            self.assertLessEqual(PROMISED, set(figures))
            self.assertEqual((figures["auc"], figures["auc_true"], figures["add_s"]), (0.9, 0.9, 0.8))
            self.assertEqual((figures["verdict"], figures["mask_iou"]), ("good", 0.95))
        self.assertEqual(summary["judged"], {"kept": ["cereal_box", "coffee_mug"], "named_poor": [], "called_good": []})
        self.assertEqual(summary["tracking_hz"], 40.0)
        page = (self.out / "report.html").read_text()
        self.assertEqual(page.count("<figcaption>taught"), 2)
        self.assertEqual(page.count("<figcaption>true"), 2)
        self.assertNotIn("http:", page)

    def test_objects_join_one_store_and_a_second_run_does_nothing(self):
        self.assertEqual(self.run_it("--takes", "2").returncode, 0)
        shown = [call for call in self.calls("hs-teach") if call[1] == "show"]
        self.assertEqual(["--add" in call for call in shown], [False, True])
        self.assertTrue(shown[1][shown[1].index("--source") + 1].endswith("coffee_mug/test/000005"))
        self.assertTrue(shown[1][shown[1].index("--second") + 1].endswith("coffee_mug/test/000006"))
        calls = len(self.log.read_text().splitlines())
        self.assertEqual(self.run_it("--takes", "2").returncode, 0)
        self.assertEqual(len(self.log.read_text().splitlines()), calls)

    def test_a_poor_object_is_not_in_the_store_and_is_told(self):
        done = self.run_it(TEACH_FAKE_POOR="coffee_mug")
        self.assertEqual(done.returncode, 0, done.stderr)
        summary = self.summary()
        mug = summary["objects"]["coffee_mug"]
        self.assertEqual((mug["verdict"], mug["taught"], mug["auc"], mug["auc_true"]), ("poor", False, None, 0.9))
        self.assertEqual(mug["reasons"], ["too short: 90 degrees"])
        self.assertEqual(mug["mesh_mm_median"], 9.0)
        self.assertEqual(summary["judged"], {"kept": ["cereal_box"], "named_poor": ["coffee_mug"], "called_good": []})

    def test_a_refused_object_has_the_words_of_its_refusal(self):
        done = self.run_it(TEACH_FAKE_REFUSED="cereal_box")
        self.assertEqual(done.returncode, 0, done.stderr)
        box = self.summary()["objects"]["cereal_box"]
        self.assertEqual(box["reasons"], ["hs-teach: bop:x: no plane, expected a table"])
        self.assertEqual((box["verdict"], box["mesh_mm_median"]), ("poor", None))
        self.assertEqual(len(self.calls("hs-study shown")), 1)

    def test_a_crash_is_no_answer(self):
        done = self.run_it(TEACH_FAKE_CRASHES="coffee_mug")
        self.assertEqual(done.returncode, 1)
        self.assertIn("shown/coffee_mug: exit status 1", done.stderr.splitlines()[-1])
        self.assertFalse((self.out / "summary.json").exists())

    def test_wrong_objects_are_named(self):
        done = self.run_it("--objects", "bowl,plate")
        self.assertEqual(done.returncode, 1)
        self.assertIn("unknown object plate, expected bowl,", done.stderr)


class Parts(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.folder = pathlib.Path(place.name)

    def test_truth_of_the_taught_frame(self):
        entry = {"obj_id": 2, "cam_R_m2c": [0, -1, 0, 1, 0, 0, 0, 0, 1], "cam_t_m2c": [0, 0, 1000]}
        moved = in_taught_frame(entry, MOVED)
        self.assertEqual(moved["cam_R_m2c"], entry["cam_R_m2c"])
        for value, expected in zip(moved["cam_t_m2c"], (-20.0, 10.0, 1030.0)):
            self.assertAlmostEqual(value, expected)
        turned = in_taught_frame(entry, [0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0])
        self.assertEqual(turned["cam_R_m2c"], [-1, 0, 0, 0, -1, 0, 0, 0, 1])

    def test_faults_are_what_is_beyond_the_limits(self):
        good = {"mesh_mm_median": 1.0, "mesh_mm_95": 4.0, "drift_mm": 1.0, "drift_deg": 1.0, "mask_iou": 0.95, "auc": 0.9,
                "auc_true": 0.92, "add_s": 0.5, "add_s_true": None}  # fmt: skip
        self.assertEqual(faults(good), [])
        self.assertEqual(faults({**good, "auc": 0.88}), ["auc 0.880 beside 0.920"])
        self.assertEqual(faults({**good, "mesh_mm_95": 6.0, "mask_iou": None}), ["mesh_mm_95 6.000", "mask_iou –"])

    def write_log(self, events):
        file = self.folder / "log"
        with open(file, "wb") as log:
            for number, event in enumerate(events):
                write_event(log, number, event)
        return file

    def test_a_joined_log_repeats_frames_but_no_utime(self):
        one = self.write_log([(i, "OPENNI_FRAME", struct.pack(">qq", 7, i) + bytes([i])) for i in range(3)])
        frames = frames_of(one, "OPENNI_FRAME")
        joined = self.folder / "joined"
        write_joined(joined, frames[:2], frames, 6, Camera("OPENNI_FRAME", 30.0))
        found = list(read_log(joined))
        self.assertEqual([data[16] for _, _, data in found], [0, 1, 0, 1, 2, 1, 0, 1])
        utimes = [utime_of(data) for _, _, data in found]
        self.assertEqual(utimes[0], FIRST_UTIME)
        self.assertEqual(sorted(set(utimes)), utimes)
        self.assertEqual(utimes[3] - utimes[0], 100_000)
        self.assertEqual([stamp for stamp, _, _ in found], utimes)

    def test_times_of_a_teaching(self):
        def teaching(state, name="mug"):
            message = teaching_t()
            message.name, message.state = name, state
            return message.encode()

        def detections(name, reported=True):
            message = detections_t()
            message.n_detections, message.detections = 1, [detection_t()]
            message.detections[0].class_name, message.detections[0].reported = name, reported
            return message.encode()

        log = self.write_log([
            (1_000_000, "HOUGHSTREAM_TEACHING", teaching(teaching_t.TRACKING)),
            (2_000_000, "HOUGHSTREAM_TEACHING", teaching(teaching_t.FUSING, "cup")),
            (3_000_000, "HOUGHSTREAM_TEACHING", teaching(teaching_t.FUSING)),
            (5_000_000, "HOUGHSTREAM_TEACHING", teaching(teaching_t.DONE)),
            (6_000_000, "HOUGHSTREAM_DETECTIONS", detections("cup")),
            (6_500_000, "HOUGHSTREAM_DETECTIONS", detections("mug", reported=False)),
            (7_000_000, "HOUGHSTREAM_DETECTIONS", detections("mug")),
        ])  # fmt: skip
        with open(log, "ab") as more:
            more.write(b"half")  # as it is while lcm-logger writes
        times = times_of(events(log), "mug")
        self.assertEqual(times, {"take_over": 3.0, "done": 5.0, "failed": None, "found": 7.0})


if __name__ == "__main__":
    unittest.main()
