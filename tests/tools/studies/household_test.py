"""Tests of tools/bench household with stand-ins for the programs that it runs. Usage: PYTHONPATH=tools household_test.py"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

from household_fakes import install, write_json, write_store
from studies.household import figures
from studies.household.measured_run import measured
from studies.household.plan import prefixes_of, ranges_of

PROMISED = {"objects", "auc", "auc_alone", "recall", "precision", "ar", "ms_detect", "ms_detect_7", "ms_pose", "teach_gb",
            "teach_s_per_object", "add_s", "store_mb_per_object", "detect_mb", "pose_mb", "ece_score",
            "ece_quality"}  # fmt: skip
ALL_IDS = (*range(1, 22), *range(101, 158))


class Groups(unittest.TestCase):
    def test_a_store_holds_the_next_smaller_one_and_groups_of_at_most_seven(self):
        places = ranges_of((4, 7, 20, 40, 60))
        self.assertEqual(places[4], [(0, 4)])
        self.assertEqual(places[7], [(0, 7)], "seven are taught together, not four and three")
        self.assertEqual(places[20], [(0, 7), (7, 13), (13, 20)])
        self.assertEqual(places[40][:3], places[20])
        self.assertEqual(places[60][:6], places[40])
        for number, groups in places.items():
            self.assertEqual([first for first, _ in groups[1:]], [last for _, last in groups[:-1]])
            self.assertEqual((groups[0][0], groups[-1][1]), (0, number))
            self.assertLessEqual(max(last - first for first, last in groups), 7)

    def test_without_a_small_store_the_large_ones_begin_at_the_first_object(self):
        self.assertEqual(ranges_of((20,))[20], [(0, 6), (6, 13), (13, 20)])
        self.assertEqual(ranges_of((8,))[8], [(0, 4), (4, 8)], "eight are one too many for a group")

    def test_given_stores_stand_for_numbers_that_they_come_near_to(self):
        self.assertEqual(prefixes_of([7, 7, 7, 7, 7, 7, 7, 7, 4], (4, 7, 20, 40, 60)), {7: 1, 20: 3, 40: 6, 60: 9})
        self.assertEqual(prefixes_of([21], (7, 20)), {20: 1})
        self.assertEqual(prefixes_of([7], (20,)), {})


class Figures(unittest.TestCase):
    PROPOSED = [{"precision": 0.95, "score": 0.2, "recall": 0.9}, {"precision": 0.98, "score": None, "recall": None}]

    def test_recall_where_no_value_keeps_the_precision_is_not_known(self):
        self.assertIsNone(figures.recall_at({"proposed": self.PROPOSED}))
        self.assertEqual(figures.recall_at({"proposed": self.PROPOSED}, 0.95), 0.9)

    def test_right_poses_are_counted_of_all_objects_that_stand_there(self):
        summary = {"required": {"a": 10, "b": 10}, "published": 8, "published_right_fraction": 0.75,
                   "published_good_fraction": 0.875,
                   "pose_calibration": {"proposed": [{"precision": 0.98, "score": 0.8, "recall": 0.5}],
                                        "bins": [{"count": 0, "true_fraction": None}, {"count": 20, "true_fraction": 0.4}]}}  # fmt: skip
        told = figures.right_figures(summary)
        self.assertAlmostEqual(told["right_recall"], 6 / 20)
        self.assertEqual((told["right_precision"], told["shape_precision"]), (0.75, 0.875))
        self.assertAlmostEqual(told["right_recall_098"], 0.5 * 8 / 20)

    def test_nothing_published_is_no_right_pose(self):
        summary = {"required": {"a": 4}, "published": 0, "published_right_fraction": None, "published_good_fraction": None,
                   "pose_calibration": {"proposed": [], "bins": []}}  # fmt: skip
        told = figures.right_figures(summary)
        self.assertEqual((told["right_recall"], told["right_precision"], told["right_recall_098"]), (0.0, None, None))

    def test_the_area_alone_is_of_the_same_objects_or_not_known(self):
        summary = {"required": {"a": 1, "b": 3, "c": 0}, "auc": {"a": 0.8, "b": 0.5, "c": None, "mean": 0.6},
                   "operating": {"recall": 0.5, "precision": 0.9}, "published": 0, "published_right_fraction": None, "published_good_fraction": None,
                   "detection_calibration": {"ece": 0.1, "proposed": []},
                   "pose_calibration": {"ece": 0.1, "proposed": [], "bins": []}}  # fmt: skip
        told = figures.found_figures(summary, figures.alone([summary]))
        self.assertAlmostEqual(told["auc"], 0.65)
        self.assertAlmostEqual(told["auc_alone"], 0.65)
        self.assertIsNone(figures.found_figures(summary, {"a": 0.9})["auc_alone"])

    def test_times_are_medians_beside_those_of_seven_objects(self):
        times = {"7": {"detect_ms": [10.0, 30.0, 11.0], "pose_ms": []}, "60": {"detect_ms": [22.0], "pose_ms": [5.0]}}
        self.assertEqual(figures.time_figures(times, 60), {"ms_detect": 22.0, "ms_detect_7": 11.0, "ms_pose": 5.0})
        self.assertEqual(figures.time_figures(times, 7)["ms_pose"], None)
        del times["7"]
        self.assertIsNone(figures.time_figures(times, 60)["ms_detect_7"])

    def test_memory_of_the_largest_teaching_and_seconds_of_all(self):
        runs = [{"seconds": 70.0, "memory_mb": 2000.0}, {"seconds": 50.0, "memory_mb": 3000.0}]
        told = figures.teach_figures(runs, {"seconds": 10.0, "memory_mb": 500.0}, 13)
        self.assertEqual(told, {"teach_gb": 3.0, "teach_s_per_object": 10.0})
        self.assertEqual(figures.teach_figures([None], None, 7), {"teach_gb": None, "teach_s_per_object": None})


class Measured(unittest.TestCase):
    def test_time_and_memory_are_of_the_program(self):
        script = "import time; x = b'1' * 300_000_000; time.sleep(0.3)"
        status, seconds, memory_mb = measured([sys.executable, "-c", script])
        self.assertEqual(status, 0)
        self.assertGreater(seconds, 0.3)
        self.assertTrue(300.0 < memory_mb < 400.0, memory_mb)
        self.assertEqual(measured([sys.executable, "-c", "raise SystemExit(3)"])[0], 3)


class Case(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.folder = pathlib.Path(place.name).resolve()
        self.models, self.out, self.log = self.folder / "models", self.folder / "out", self.folder / "calls"
        self.log.touch()
        write_json(self.models / "models_info.json", {str(one): {"diameter": 100.0} for one in ALL_IDS})
        write_json(self.models / "names.json", {str(one): f"name_{one}" for one in ALL_IDS})
        install(self.folder / "bin")

    def run_it(self, *options):
        words = [sys.executable, "-m", "studies.household", "--bin", self.folder / "bin", "--out", self.out, "--models", self.models,
                 *options]  # fmt: skip
        environment = {**os.environ, "HOUSEHOLD_FAKE_LOG": str(self.log)}
        return subprocess.run(words, env=environment, capture_output=True, text=True)

    def summary(self):
        return json.loads((self.out / "summary.json").read_text())

    def calls(self, name):
        return [line.split() for line in self.log.read_text().splitlines() if line.startswith(name)]


class WholeRun(Case):
    def test_sixty_are_taught_eighteen_are_strangers_and_every_figure_is_there(self):
        done = self.run_it("--rounds", "2")
        self.assertEqual(done.returncode, 0, done.stderr)
        summary = self.summary()
        self.assertEqual(summary["taught"], [*range(1, 22), *range(101, 140)])
        self.assertEqual(summary["strangers"], list(range(140, 158)))
        self.assertEqual(list(summary["by_number"]), ["4", "7", "20", "40", "60"])
        for number, entry in summary["by_number"].items():
            self.assertLessEqual(PROMISED, set(entry))
            self.assertEqual([key for key in PROMISED if entry[key] is None], [], number)
            self.assertEqual(entry["objects"], int(number))
        sixty = summary["by_number"]["60"]
        self.assertAlmostEqual(sixty["auc"], 0.9 - 0.01 * 53)
        self.assertEqual((sixty["ms_detect"], sixty["ms_detect_7"], sixty["ms_pose"]), (70.5, 17.5, 20.0))
        self.assertEqual(sixty["groups"], 9)
        self.assertAlmostEqual(sixty["store_mb_per_object"], 1.0, places=2)
        self.assertIn("at most 7 objects", summary["alone"])
        page = (self.out / "report.md").read_text()
        self.assertIn("| 60 | 9 | 0.370 |", page)
        self.assertIn("| name_1 | 4 | 0.370 | 0.900 |", page)

    def test_an_objects_area_alone_is_that_of_its_group(self):
        self.assertEqual(self.run_it("--numbers", "7,20", "--no-add").returncode, 0)
        twenty = self.summary()["by_number"]["20"]
        self.assertEqual((twenty["auc"], twenty["auc_alone"]), (0.77, 0.9))
        self.assertEqual(self.summary()["by_number"]["7"]["auc_alone"], 0.9)
        self.assertNotIn("name_3", self.summary()["by_object"]["20"], "it stands nowhere")
        self.assertIsNone(twenty["add_s"])

    def test_what_is_done_is_kept_and_a_larger_store_teaches_only_its_own_groups(self):
        self.assertEqual(self.run_it("--numbers", "7", "--no-add").returncode, 0)
        calls = len(self.log.read_text().splitlines())
        self.assertEqual(self.run_it("--numbers", "7", "--no-add").returncode, 0)
        self.assertEqual(len(self.log.read_text().splitlines()), calls)
        self.assertEqual(self.run_it("--numbers", "7,20", "--no-add").returncode, 0)
        taught = [call[call.index("--ids") + 1] for call in self.calls("hs-teach mesh")]
        self.assertEqual(taught, ["1,2,3,4,5,6,7", "8,9,10,11,12,13", "14,15,16,17,18,19,20"])
        self.assertEqual(len(self.calls("hs-study")), 1)

    def test_times_are_measured_in_turn(self):
        self.assertEqual(self.run_it("--numbers", "4,7", "--no-add", "--rounds", "2").returncode, 0)
        looked = [call[call.index("--objects") + 1] for call in self.calls("hs-evaluate")][-4:]
        self.assertEqual([store.split("taught/")[1] for store in looked], ["1_to_4/store", "1_to_7/store"] * 2)

    def test_one_more_object_joins_a_copy_which_is_gone_then(self):
        self.assertEqual(self.run_it("--numbers", "7").returncode, 0)
        added = [call for call in self.calls("hs-teach mesh") if "--add" in call]
        self.assertEqual([call[call.index("--ids") + 1] for call in added], ["140"])
        self.assertEqual([file.name for file in (self.out / "data" / "added" / "7").iterdir()], ["run.json"])
        store = json.loads((self.out / "data" / "taught" / "1_to_7" / "store" / "store.json").read_text())
        self.assertEqual(len(store["objects"]), 7)

    def test_quick_takes_seven_objects_and_few_strangers(self):
        self.assertEqual(self.run_it("--quick").returncode, 0)
        summary = self.summary()
        self.assertEqual((summary["taught"], summary["strangers"]), (list(range(1, 8)), list(range(140, 145))))
        self.assertEqual((list(summary["by_number"]), summary["rooms"], summary["frames"]), (["4", "7"], 2, 4))
        self.assertTrue(all("--practice-rooms" in call for call in self.calls("hs-teach mesh")))

    def test_a_room_is_meant_to_hold_no_more_objects_than_there_are(self):
        done = self.run_it("--quick", "--numbers", "4", "--scenes-only")
        self.assertEqual(done.returncode, 0, done.stderr)
        call = self.calls("hs-study")[0]
        self.assertEqual(call[call.index("--max-objects") + 1], "9", "four and five strangers")

    def test_scenes_can_be_rendered_alone(self):
        self.assertEqual(self.run_it("--scenes-only").returncode, 0)
        self.assertEqual([call[0] for call in map(str.split, self.log.read_text().splitlines())], ["hs-study"])
        self.assertFalse((self.out / "summary.json").exists())


class StoresTaughtBefore(Case):
    def store(self, name, ids):
        write_store(self.folder / "stores" / name, [{"id": one, "name": f"name_{one}"} for one in ids])
        return self.folder / "stores" / name

    def test_they_are_joined_in_order_and_what_is_not_measured_is_null(self):
        first, second = self.store("z.store", range(1, 8)), self.store("a.store", range(101, 115))
        done = self.run_it("--stores", f"{first},{second}", "--no-add")
        self.assertEqual(done.returncode, 0, done.stderr)
        by_number = self.summary()["by_number"]
        self.assertEqual({number: entry["objects"] for number, entry in by_number.items()},
                         {"4": None, "7": 7, "20": 21, "40": None, "60": None})  # fmt: skip
        self.assertEqual({entry["teach_gb"] for entry in by_number.values()}, {None})
        self.assertEqual(set(by_number["60"].values()), {None})
        self.assertAlmostEqual(by_number["7"]["store_mb_per_object"], 1.0, places=2)
        merges = self.calls("hs-teach")
        self.assertEqual([call[1:4] for call in merges], [["merge", str(first), str(second)]])
        self.assertIn("| 60 | not measured |", (self.out / "report.md").read_text())
        self.assertEqual(self.summary()["strangers"][0], 140)

    def test_a_folder_of_stores_is_taken_as_a_whole(self):
        self.store("b.store", range(101, 108)), self.store("a.store", range(1, 8)), self.store(".c.store", range(8, 12))
        done = self.run_it("--stores", self.folder / "stores", "--numbers", "14", "--no-add")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual([pathlib.Path(store).name for store in self.summary()["stores"]], ["a.store", "b.store"])
        self.assertEqual(self.summary()["by_number"]["14"]["objects"], 14)


    def test_one_that_has_been_joined_before_is_taken_as_it_is(self):
        first, second = self.store("a.store", range(1, 8)), self.store("b.store", range(101, 115))
        joined = self.store("both.store", [*range(1, 8), *range(101, 115)])
        stores = ("--stores", f"{first},{second}", "--numbers", "7,20", "--no-add", "--joined")
        done = self.run_it(*stores, joined)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.calls("hs-teach"), [])
        twenty = self.summary()["by_number"]["20"]
        self.assertEqual((twenty["objects"], twenty["groups"], twenty["auc_alone"]), (21, 2, 0.851))  # 0.9 of six, 0.83 of fourteen
        self.assertAlmostEqual(twenty["store_mb_per_object"], 1.0, places=2)
        self.assertEqual(self.run_it(*stores, first).returncode, 0)
        self.assertEqual(len(self.calls("hs-teach merge")), 1, "it holds other objects")
        done = self.run_it("--joined", joined)
        self.assertEqual(done.returncode, 1)
        self.assertIn("--joined goes with --stores", done.stderr)


class BadInput(Case):
    def refused(self, words, *options):
        done = self.run_it(*options)
        self.assertEqual(done.returncode, 1)
        self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
        self.assertIn(words, done.stderr)
        self.assertEqual(self.log.read_text(), "")

    def test_one_line_before_anything_runs(self):
        self.refused("no meshes there, expected a BOP models folder of the 78 objects", "--models", self.folder / "none")
        self.refused("expected each number once, the smallest first", "--numbers", "7,4")
        self.refused("--numbers 61: 60 objects are taught", "--numbers", "61")
        self.refused("no store there, expected one by hs-teach", "--stores", self.folder)
        write_json(self.models / "models_info.json", {str(one): {} for one in ALL_IDS if one != 139})
        self.refused("no object 139, expected 60 that are taught")

    def test_two_stores_of_one_object_are_refused(self):
        for name in ("a", "b"):
            write_store(self.folder / "stores" / name, [{"id": 1, "name": "name_1"}])
        self.refused("name_1 is in", "--stores", self.folder / "stores")
        write_store(self.folder / "strange", [{"id": 1, "name": "unheard"}])
        self.refused("none of their objects", "--stores", self.folder / "strange")


if __name__ == "__main__":
    unittest.main()
