"""Tests of the report of tools/bench pose: its keys, what was not measured, its page. Usage: PYTHONPATH=tools bench_pose_test.py"""

import copy
import pathlib
import tempfile
import unittest

from studies.bench import pose


def variant(ms, share, ar):
    recall = {"detections": 4, "mssd": share / 4, "add_s": share, "add": share / 2}
    return {
        "detections": 9, "published": 5, "ms_median": ms, "ms_p99": 2 * ms, "mm_median": 1.5, "mm_per_m_sq_median": 0.75,
        "deg_median": None, "published_right_fraction": share / 4, "published_good_fraction": share, "recall": recall, "recall_from_0.5": recall,
        "bop_targets": 6, "bop_ar": ar,
    }  # fmt: skip


RESULTS = {
    "frames": 30,
    "rival_frames": 5,
    "variants": {"ours": variant(3.0, 0.9, 0.8), "pcl": variant(40.0, 0.7, 0.6)},
    "on_rival_frames": {
        "ours": variant(3.0, 0.9, 0.75),
        "prerejective": variant(600.0, 0.5, 0.4),
        "ppf": variant(70.0, 0.4, 0.3),
    },
    "withheld": {"rejected by <depth>": {"true": 1, "false": 7, "ignored": 0, "would_have_been_right": 1,
                                         "would_have_been_right_by_mssd": 0}},
}

REAL = {"within_5mm_5deg": 9, "frames": 10, "with_pose": 10, "median_mm": 1.25, "median_deg": 0.5, "per_frame": []}

PROMISED = {
    "ms_per_pose_median", "ms_per_pose_p99", "pcl_ms_median", "mssd_recall", "add_s_recall", "add_recall", "bop_ar", "bop_ar_prerejective",
    "bop_ar_ppf", "published_right_fraction", "published_good_fraction", "real",
}  # fmt: skip


def without_rivals():
    results = copy.deepcopy(RESULTS)
    results["on_rival_frames"], results["rival_frames"] = {}, 0
    return results


class Summary(unittest.TestCase):
    def test_each_figure_is_that_of_its_variant(self):
        summary = pose.summarise(RESULTS, REAL)
        self.assertLessEqual(PROMISED, set(summary))
        self.assertEqual(
            (summary["ms_per_pose_median"], summary["ms_per_pose_p99"], summary["pcl_ms_median"]), (3.0, 6.0, 40.0)
        )
        self.assertEqual((summary["mssd_recall"], summary["pcl_mssd_recall"]), (0.225, 0.175))
        self.assertEqual((summary["add_s_recall"], summary["add_recall"]), (0.9, 0.45))
        self.assertEqual((summary["published_right_fraction"], summary["published_good_fraction"]), (0.225, 0.9))
        self.assertEqual((summary["bop_ar"], summary["bop_ar_prerejective"], summary["bop_ar_ppf"]), (0.8, 0.4, 0.3))
        self.assertEqual(summary["bop_ar_on_rival_frames"], 0.75)
        self.assertEqual(summary["real"]["within_5mm_5deg"], 9)

    def test_what_was_not_measured_is_null(self):
        summary = pose.summarise(without_rivals(), None)
        self.assertLessEqual(PROMISED, set(summary))
        self.assertIsNone(summary["bop_ar_ppf"])
        self.assertIsNone(summary["rotation_deg_median"])
        self.assertEqual(set(summary["real"].values()), {None})

    def test_a_damaged_result_is_no_null(self):
        results = copy.deepcopy(RESULTS)
        del results["variants"]["ours"]["bop_ar"]
        with self.assertRaises(KeyError):
            pose.summarise(results, None)


class Page(unittest.TestCase):
    def render(self, results, real):
        summary = {
            **pose.summarise(results, real),
            "cpu": "a processor",
            "commit": "abc",
            "date": "2020-02-20",
            "command": "tools/bench",
        }
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder)
            (out / "pose").mkdir()
            for number in (1, 2, 10):
                (out / "pose" / f"worst_{number}.png").write_bytes(b"picture")
            return pose.page(out, summary, results)

    def test_it_holds_the_tables_and_the_worst_in_order(self):
        text = self.render(RESULTS, REAL)
        for words in (
            pose.NAMES["ppf"],
            "rejected by &lt;depth&gt;",
            "<td>600.00</td>",
            "Camera-recorded frames",
            "<td>9</td>",
        ):
            self.assertIn(words, text)
        self.assertLess(text.index("worst_2.png"), text.index("worst_10.png"))

    def test_it_leaves_out_what_was_not_measured(self):
        text = self.render(without_rivals(), None)
        self.assertNotIn("Beside other methods", text)
        self.assertNotIn("Camera-recorded frames", text)


if __name__ == "__main__":
    unittest.main()
