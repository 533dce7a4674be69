"""Tests of the parts of tools/reproduce: plan, verdicts, views of the UW dataset.

Usage: PYTHONPATH=tools reproduce_parts_test.py"""

import json
import pathlib
import tempfile
import unittest

from studies.reproduce import plan, results, uw_views, variants
from studies.unit_runner import Units


class UwViews(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.folder, self.out = pathlib.Path(place.name, "rgbd-dataset"), pathlib.Path(place.name, "out")

    def test_views_of_a_turn_are_spread_evenly(self):
        instance = self.folder / "soda_can" / "soda_can_4"
        instance.mkdir(parents=True)
        for video, number in [(1, number) for number in range(1, 73)] + [(2, 1)]:
            for ending in uw_views.FILES:
                (instance / f"soda_can_4_{video}_{number}{ending}").touch()
        uw_views.link_views(self.folder, self.out, "soda_can_4")
        links = sorted((self.out / "soda_can" / "soda_can_4").iterdir())
        self.assertEqual(len(links), 37 * len(uw_views.FILES))
        names = {link.name for link in links}
        self.assertIn("soda_can_4_1_71_loc.txt", names)
        self.assertNotIn("soda_can_4_1_72_loc.txt", names)
        self.assertTrue(all(link.is_file() for link in links))

    def test_an_instance_without_views_is_refused(self):
        with self.assertRaises(SystemExit):
            uw_views.link_views(self.folder, self.out, "bowl_1")

    def test_instances_are_those_of_the_scenes(self):
        scenes = [self.folder / name for name in ("desk_1", "desk_2")]
        for scene, names in zip(scenes, ({"1": "cap_1", "2": "bowl_2"}, {"1": "bowl_2"})):
            scene.mkdir(parents=True)
            (scene / "names.json").write_text(json.dumps(names))
        self.assertEqual(uw_views.instances(scenes), ["bowl_2", "cap_1"])


class Reliability(unittest.TestCase):
    def test_recall_tells_which_detections_are_true(self):
        curve = [
            {"object": "bowl", "score": "0.9", "recall": "0.5"},
            {"object": "bowl", "score": "0.8", "recall": "0.5"},
            {"object": "mug", "score": "0.7", "recall": "0.0"},
            {"object": "mug", "score": "0.6", "recall": "1.0"},
        ]
        self.assertEqual(results.verdicts(curve), [(0.9, True), (0.8, False), (0.7, False), (0.6, True)])

    def test_bins_hold_the_share_that_is_true(self):
        curve = [{"object": "bowl", "score": "0.95", "recall": str(0.1 * (i + 1))} for i in range(3)]
        curve += [
            {"object": "bowl", "score": "0.92", "recall": "0.3"},
            {"object": "bowl", "score": "1.0", "recall": "0.3"},
        ]
        rows = results.reliability([curve])
        self.assertEqual([(row["count"], row["share_true"]) for row in rows], [(5, 0.6)])
        self.assertTrue(0.2 < rows[0]["low"] < 0.6 < rows[0]["high"] < 0.9)
        self.assertIsNone(results.calibration_error([]))


class Plan(unittest.TestCase):
    def test_every_input_is_made_before_it_is_used(self):
        with tempfile.TemporaryDirectory() as folder:
            self.make_uw_folders(pathlib.Path(folder))
            for dataset in ("rendered", "uw", "real"):
                made = set()
                for unit in plan.make_plan(dataset, folder, "/recorded", plan.Protocol()):
                    self.assertLessEqual(set(unit.inputs), made, unit.name)
                    made.add(unit.name)

    def make_uw_folders(self, folder):
        for scene in variants.SCENES:
            (folder / "rgbd-scenes" / scene.rpartition("_")[0] / scene).mkdir(parents=True)
        (folder / "rgbd-scenes" / "background").mkdir()
        (folder / "rgbd-dataset" / "soda_can").mkdir(parents=True)

    def test_folders_that_the_uw_datasets_lack_are_named(self):
        with tempfile.TemporaryDirectory() as folder, self.assertRaisesRegex(
            SystemExit, "no table_small/table_small_1"
        ):
            plan.make_plan("uw", folder, "", plan.Protocol())

    def quick_and_full(self):
        plans = (plan.quick(plan.Protocol()), plan.Protocol())
        return [{unit.name: unit for unit in plan.make_plan("rendered", "", "/recorded", each)} for each in plans]

    def test_a_quick_run_leaves_features_out_and_looks_at_few_frames(self):
        quick, full = self.quick_and_full()
        trained = {name.split("/")[1] for name in quick if name.startswith("train/")}
        for feature in set(variants.NOT_IN_QUICK) & set(variants.FEATURES):
            self.assertNotIn(feature, trained)
            self.assertIn(f"train/{feature}/seed1", full)
        self.assertFalse({"objects_20_realtime", "real_gall", "real_paper"} & trained)
        self.assertFalse([name for name in quick if "_20" in name])
        self.assertIn("train/objects_20_realtime/seed1", full)
        self.assertIn("evaluate_every_6/final/table_small_1/seed1", quick)
        self.assertIn("evaluate_every_6/normalised/desk_2/seed1", quick)
        self.assertIn("evaluate_every_3/realtime/desk_1/seed1", quick)
        self.assertIn("evaluate/real_realtime/scenes/seed1", quick)
        self.assertIn("evaluate/real_gall/scenes/seed1", full)
        self.assertFalse([name for name in full if name.startswith("evaluate_")])

    def options(self, unit, *names):
        return [unit.command[unit.command.index(name) + 1] if name in unit.command else None for name in names]

    def test_each_score_has_its_threshold(self):
        _, full = self.quick_and_full()
        names = ("--threshold", "--min-mass", "--operating-score")
        for what in ("gall", "final", "single"):
            unit = full[f"evaluate/{what}/table_small_1/seed1"]
            self.assertEqual(self.options(unit, *names), ["0.1", None, None], what)
        for what in ("paper", "realtime", "stride_4"):
            unit = full[f"evaluate/{what}/table_small_1/seed1"]
            self.assertEqual(self.options(unit, *names), ["0", "0.05", None], what)

    def test_the_product_s_programs_are_asked_what_they_know(self):
        _, full = self.quick_and_full()
        for unit in full.values():
            product = unit.command[0] in ("hs-train", "hs-evaluate")
            if product:
                self.assertFalse({"gall", "--features", "--reference", "--scale-handling"} & set(unit.command), unit)
        for name in ("evaluate/gall/desk_1/seed1", "time_every_20/stride_2", "evaluate/real_gall/scenes/seed1"):
            self.assertEqual(full[name].command[:2], ("hs-study", "evaluate"))
        for what in ("gall", "pfh", "single", "half_size"):
            self.assertEqual(full[f"train/{what}/seed1"].command[:2], ("hs-study", "train"))

    def test_time_and_auc_are_of_the_same_settings(self):
        _, full = self.quick_and_full()
        names = ("--threshold", "--min-mass", "--stride")
        for time, auc in (
            ("time_every_20/original", "gall"),
            ("time_every_6/fast_engine_one_thread", "gall"),
            ("time_every_6/final", "paper"),
            ("time_every_6/realtime", "realtime"),
        ):
            timed, judged = full[time], full[f"evaluate/{auc}/table_small_1/seed1"]
            self.assertEqual(self.options(timed, *names), self.options(judged, *names), time)
        detectors = [word for word in full["side_by_side/objects_20_a.json"].command if "=" in word]
        self.assertTrue(all(word.endswith(",min-mass=0.05,threshold=0") for word in detectors), detectors)

    def test_another_sensor_sees_the_scenes_but_does_not_teach(self):
        _, full = self.quick_and_full()
        scene = full["data/scene_time_of_flight/table_small_1"]
        self.assertEqual(self.options(scene, "--sensor"), ["time_of_flight"])
        unit = full["evaluate/time_of_flight_realtime/table_small_1/seed5"]
        self.assertEqual(unit.inputs, ("data/scene_time_of_flight/table_small_1", "train/realtime/seed5"))
        self.assertFalse([name for name in full if name.startswith("train/") and "time_of_flight" in name])

    def test_linemod_is_taught_the_distances_of_the_scenes(self):
        _, full = self.quick_and_full()
        for name, distances in (("linemod", ["0.75", "2.1"]), ("real_linemod", ["0.3", "0.8"])):
            for ending, checks in (("", True), ("_no_check", False)):
                unit = full[f"linemod/{name}{ending}"]
                self.assertEqual(self.options(unit, "--min-distance", "--max-distance"), distances)
                self.assertEqual("--check-depth" in unit.command, checks)

    def test_no_two_units_share_a_name(self):
        collected = Units()
        collected.add("train/a", "1", "hs-train", "--seed", 1)
        collected.add("train/a", "2", "hs-train", "--seed", 1)
        self.assertEqual(collected.all()[0].figures, ("1", "2"))
        with self.assertRaises(ValueError):
            collected.add("train/a", "1", "hs-train", "--seed", 2)


if __name__ == "__main__":
    unittest.main()
