"""Tests of the writer of RESULTS.md, with small summaries. Usage: PYTHONPATH=tools results_test.py"""

import pathlib
import tempfile
import unittest

from studies import results
from studies.bench import speed
from studies.bop.figures import COUNTS, FIGURES
from studies.household.figures import empty
from studies.records import write_json
from studies.reproduce.results import Results
from studies.reproduce.summary import summarise

OF_COMMIT = {"cpu": "a | processor", "commit": "abc1234", "date": "2020-02-20", "command": "tools/demo"}
LATENCY = {"p50": 20.0, "p95": 25.0, "p99": 31.0}


class Nothing:
    """A replacement of the store of tools/reproduce: no unit has been run."""

    def is_current(self, unit):
        return False


def demo(commit="abc1234"):
    figures = {
        "auc": {"bowl": 0.72, "mean": 0.72},
        "recall": {"bowl": 0.5},
        "mssd_recall": {"bowl": 0.2, "mean": 0.2},
        "pose_recall_add_s_10": {"bowl": 0.25, "mean": 0.25},
    }
    counts = dict.fromkeys(
        ("frames_sent", "frames_detected", "frames_skipped", "frames_lost", "frames_with_poses"), 300
    )
    return {**figures, "processed": figures, "bop19_ar": {"bowl": 0.6, "all": 0.6}, "latency_ms": {"total": LATENCY}, **counts,
            "false_detections": 1, "rate_hz": 29.9, "train_seconds": 50.0, **OF_COMMIT, "commit": commit, "settings": {}}  # fmt: skip


def reproduced():
    left_out = ["attitudes", "pfh"]
    summary = summarise(Results(Nothing(), [], left_out))
    summary["auc"]["gall"]["desk_1"] = 0.5
    return {**summary, "settings": {**OF_COMMIT, "command": "tools/reproduce", "left_out": left_out}}


class ResultsOfACommit(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.out = pathlib.Path(place.name, "out")
        self.file = pathlib.Path(place.name, "RESULTS.md")

    def written(self):
        results.write(self.out, self.file, "abc1234")
        return self.file.read_text()

    def section(self, text, title):
        return text.split(f"## {title}")[1].split("\n## ")[0]

    def test_bop_sets_have_their_table_and_say_what_was_cut(self):
        figures = dict.fromkeys((*FIGURES, *COUNTS, "ar_at_default", "teach_seconds"))
        figures |= {"ar": 0.75, "targets": 35, "spread": {"ar": [0.7, 0.8]}, "rivals_cut": "cut after 300 s: PPF"}
        settings = {"rivals": True, "every": 1, "split": "test", "objects": None, "seeds": 3}
        write_json(
            self.out / "bop" / "summary.json", {"datasets": {"ycbv": figures}, **OF_COMMIT, "settings": settings}
        )
        section = self.section(self.written(), "Sets of the BOP challenge")
        for words in ("| ycbv | 35 | 0.750 (0.700 to 0.800) |", "ycbv: cut after 300 s: PPF.", "3 teaching(s) a set"):
            self.assertIn(words, section)

    def test_each_table_names_machine_date_and_command(self):
        write_json(self.out / "demo" / "summary.json", demo())
        section = self.section(self.written(), "Demo: a rendered scene")
        self.assertIn("*`tools/demo`; a | processor; 2020-02-20*", section)
        self.assertIn("| AUC, inspected frames alone | 0.720 | 0.720 |", section)
        self.assertIn("| AUC, all frames | 0.720 | 0.720 |", section)
        self.assertIn("| poses right, all frames | 0.200 | 0.200 |", section)
        self.assertIn("| ADD-S recall, all frames (right up to shape) | 0.250 | 0.250 |", section)
        self.assertLess(section.index("poses right"), section.index("ADD-S recall"))
        self.assertIn("| BOP average recall | 0.600 | 0.600 |", section)

    def test_poses_of_followed_objects_come_before_what_the_detector_found(self):
        by_object = {"bowl": 0.9, "all": 0.8}
        followed = {"frames_followed": 297, "frames_passed_over": 3, "frames_lost": 0, "right_fraction": by_object,
                    "recall": by_object}  # fmt: skip
        write_json(self.out / "demo" / "summary.json", {**demo(), "followed": followed})
        section = self.section(self.written(), "Demo: a rendered scene")
        self.assertIn("| objects in all frames with a right pose | 0.900 | 0.800 |", section)
        self.assertLess(section.index("poses of followed objects: right"), section.index("AUC"))
        self.assertIn("297 frames followed, 3 passed over for newer ones, 0 lost. The detector: 300 frames sent", section)
        self.assertIn("300 not inspected, as meant", section)

    def test_what_is_of_another_commit_is_not_measured(self):
        write_json(self.out / "demo" / "summary.json", demo())
        write_json(self.out / "real" / "summary.json", demo("0ther"))
        text = self.written()
        self.assertIn(
            "Not measured of this commit: `tools/demo --real DIR`", self.section(text, "Demo: camera-recorded")
        )
        self.assertIn("Not measured of this commit: `tools/reproduce`", text)

    def test_parts_of_a_benchmark_are_told_apart(self):
        bench = self.out / "bench"
        times = {
            "threads_1": {"ms": {"p50": 19.0}, "stage_ms": {}},
            "realtime": {"ms": {"p50": 12.0}, "stage_ms": {"detect.leaves": 3.0}},
        }
        write_json(bench / "speed" / "times.json", times)
        write_json(bench / "speed" / "about.json", {**OF_COMMIT, "command": "tools/bench speed"})
        write_json(bench / "growth" / "times.json", {"objects_4": {"ms": {"p50": 12.0}}})
        write_json(bench / "growth" / "about.json", {**OF_COMMIT, "commit": "0ther"})
        write_json(bench / "summary.json", {**speed.summarise(bench), **OF_COMMIT})
        text = self.written()
        section = self.section(text, "Speed: one frame")
        self.assertIn("| realtime, fast engine, all threads | 12.00 | not measured | ranked", section)
        self.assertIn("| realtime | 3.00 |", section)
        self.assertIn("Not measured of this commit: `tools/bench growth`", text)

    def test_objects_that_persist_have_sequences_and_rates(self):
        standing = {"mm_median": 0.17, "mm_p95": 0.85, "within_two_deviations": 0.98}
        walk = {"frames": 900, "recall": 0.997, "precision": 1.0, "id_switches": 0, "hota": 0.996, "error": {"standing": standing}}
        rate = {"p50_ms": 2.6, "p99_ms": 7.2, "objects_p50_ms": 2.8, "objects_p99_ms": 8.0, "lost": 0, "skipped": 0.0, "cores": 0.32}
        summary = {"sequences": {"walk": walk}, "jitter": {"mm": 0.13, "deg": 0.2}, "seconds_to_find": 0.3, "cameras": None}
        write_json(
            self.out / "bench" / "tracks.json", {**summary, "seconds_to_gone": None, "hz60": rate, **OF_COMMIT}
        )
        section = self.section(self.written(), "Objects that persist")
        self.assertIn("round a table | 900 | 0.997 | 1.000 | 0 | 0.996 | 0.17, 0.85 | 0.980 |", section)
        self.assertIn("| 60 Hz | 2.6, 7.2 | 2.8, 8.0 | 0 | 0.000 | 0.32 |", section)
        self.assertIn("gone within not measured s", section)

    def test_objects_that_are_shown_stand_beside_their_true_meshes(self):
        keys = ("mesh_mm_median", "mesh_mm_95", "drift_mm", "drift_deg", "mask_iou", "auc_true", "add_s_true")
        tin = {**dict.fromkeys(keys, 0.5), "auc": None, "add_s": None, "verdict": "poor"}
        summary = {"objects": {"tin": tin}, "tracking_hz": 43.4, "seconds_to_found": None, "stream": None}
        write_json(self.out / "teach" / "summary.json", {**summary, **OF_COMMIT})
        section = self.section(self.written(), "Objects that are shown")
        self.assertIn("| tin | 0.50, 0.50 | 0.50, 0.50 | 0.500 | not measured, 0.500 |", section)
        self.assertIn("followed at 43 Hz.", section)

    def test_a_household_has_a_row_for_each_number_of_objects(self):
        measured = {**empty(), "objects": 21, "auc": 0.673, "auc_alone": 0.654, "ms_detect": 30.0, "ms_detect_7": 20.0}
        summary = {"by_number": {"20": measured, "60": empty()}, "rooms": 8, "frames": 40, "taught": [1, 2], "strangers": [3],
                   "alone": "In its group means that."}  # fmt: skip
        write_json(self.out / "household" / "summary.json", {**summary, **OF_COMMIT})
        section = self.section(self.written(), "A household")
        for words in ("| 21 | not measured | 0.673 | 0.654 |", "| 60 | not measured |", "| 21 | 30.0 | 1.50 |",
                      "8 rooms, 40 frames; 2 objects are taught, 1 never. In its group means that."):  # fmt: skip
            self.assertIn(words, section)

    def test_a_cell_that_was_not_measured_says_so(self):
        write_json(self.out / "reproduce" / "summary.json", reproduced())
        section = self.section(self.written(), "Six rendered scenes")
        self.assertIn("| gall (RGB Hough Forest) | not measured | not measured | 0.500 |", section)
        self.assertNotIn("taught in all attitudes", self.file.read_text())

    def test_nothing_measured_leaves_the_file_alone(self):
        write_json(self.out / "demo" / "summary.json", demo("0ther"))
        self.file.write_text("as it was")
        with self.assertRaisesRegex(SystemExit, "abc1234"):
            self.written()
        self.assertEqual(self.file.read_text(), "as it was")


if __name__ == "__main__":
    unittest.main()
