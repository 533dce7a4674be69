"""Tests of tools/bench bop with stand-ins for the programs that it runs. Usage: PYTHONPATH=tools bop_test.py"""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

from bop_fakes import IMAGE, install, write_json
from studies.bop import figures, report
from studies.bop.subset import BadSet, choose, chosen_images, names_of
from studies.bop.dataset import open_dataset
from studies.records import read_csv

PROMISED = {
    "ar", "ar_nothing_withheld", "auc", "precision", "recall", "published_right_fraction",
    "published_good_fraction", "ece_score", "ece_quality", "ece_quality_up_to_shape",
    "ms_detect_median", "ms_pose_median", "targets", "linemod_auc", "ar_prerejective", "ar_ppf",
}  # fmt: skip


def entry(name, z=1000.0):
    return {"obj_id": name, "cam_R_m2c": [1, 0, 0, 0, 1, 0, 0, 0, 1], "cam_t_m2c": [0, 0, z]}


def seen(fraction):
    return {"bbox_visib": [1, 1, 5, 5], "visib_fract": fraction}


def write_scene(folder, images):
    """`images`: {id: [(object id, visible fraction)]}"""
    write_json(folder / "scene_camera.json", {str(i): {"cam_K": [500, 0, 4, 0, 500, 4, 0, 0, 1]} for i in images})
    write_json(
        folder / "scene_gt.json", {str(i): [entry(name) for name, _ in objects] for i, objects in images.items()}
    )
    write_json(
        folder / "scene_gt_info.json", {str(i): [seen(part) for _, part in objects] for i, objects in images.items()}
    )
    for kind in ("rgb", "depth"):
        (folder / kind).mkdir()
        for image in images:
            (folder / kind / f"{image:06}.png").write_bytes(IMAGE)


def write_set(root, split="test"):
    write_json(root / "models" / "models_info.json", {"2": {"diameter": 100.0}, "3": {"diameter": 50.0}})
    write_scene(root / split / "000001", {4: [(2, 1.0)]})
    write_scene(root / split / "000050", {1: [(2, 0.9), (3, 0.5)], 7: [(2, 0.4)]})


def target(scene, image, name, count=1):
    return {"scene_id": scene, "im_id": image, "obj_id": name, "inst_count": count}


class Case(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.folder = pathlib.Path(place.name).resolve()
        self.root, self.out, self.log = self.folder / "ycbv", self.folder / "out", self.folder / "calls"
        self.log.touch()
        install(self.folder / "bin")

    def run_it(self, *options, **more):
        words = [sys.executable, "-m", "studies.bop", "--bin", self.folder / "bin", "--out", self.out, *options]
        environment = {**os.environ, "BOP_FAKE_LOG": str(self.log), **more}
        return subprocess.run(words, env=environment, capture_output=True, text=True)

    def summary(self):
        return json.loads((self.out / "summary.json").read_text())

    def calls(self, name):
        return [line for line in self.log.read_text().splitlines() if line.startswith(name)]


class WholeRun(Case):
    def test_figures_are_pooled_over_the_scenes(self):
        write_set(self.root)
        done = self.run_it("--dataset", self.root)
        self.assertEqual(done.returncode, 0, done.stderr)
        summary = self.summary()
        self.assertLessEqual({"datasets", "cpu", "commit", "settings"}, set(summary))
        figures = summary["datasets"]["ycbv"]
        self.assertLessEqual(PROMISED | {"teach_seconds", "scenes"}, set(figures))
        self.assertEqual((figures["targets"], figures["ar"]), (5, round((0.9 + 4 * 0.5) / 5, 4)))
        # 0.95 true, 0.9 true, 0.85 true, 0.8 false, 0.7 true of five
        self.assertAlmostEqual(figures["auc"], (1 + 1 + 1 + 4 / 5) / 5, places=3)
        self.assertEqual((figures["precision"], figures["recall"]), (0.75, 0.6))  # 3 of 4 from 0.75 on, of 5
        self.assertAlmostEqual(
            figures["ece_score"], abs(0.8 - (0.3 + 4 * 0.9) / 5), places=3
        )  # not the mean of 0.5, 0.1
        self.assertEqual((figures["published_right_fraction"], figures["published_good_fraction"]), (0.5, 1.0))
        self.assertAlmostEqual(figures["ece_quality_up_to_shape"], 0.1, places=3)
        self.assertEqual((figures["ms_detect_median"], figures["ms_pose_median"]), (8.0, None))
        self.assertEqual(figures["linemod_auc"], 0.4)
        self.assertAlmostEqual(figures["ar_prerejective"], 0.29, places=4)
        self.assertGreater(figures["teach_seconds"], 0.0)
        scene = figures["scenes"]["000001"]
        self.assertLessEqual(PROMISED, set(scene))
        self.assertEqual((scene["ar"], scene["precision"], scene["recall"]), (0.9, 0.5, 1.0))
        self.check_files(figures)

    def check_files(self, figures):
        rows = read_csv(self.out / "ycbv_bop19.csv")
        self.assertEqual([row["scene_id"] for row in rows], ["1", "50"])
        page = (self.out / "report.html").read_text()
        for words in (
            "scene 000050: missed",
            "the worst poses",
            "image/svg+xml",
            "Beside others",
            "LINEMOD looked at 2 of 3",
        ):
            self.assertIn(words, page)
        self.assertNotIn("http:", page)
        self.assertIn("2 of 3", figures["rivals_cut"])

    def test_a_second_run_does_nothing_and_a_changed_model_teaches_again(self):
        write_set(self.root)
        self.assertEqual(self.run_it("--dataset", self.root).returncode, 0)
        calls = len(self.calls("hs-"))
        self.assertEqual(self.run_it("--dataset", self.root).returncode, 0)
        self.assertEqual(len(self.calls("hs-")), calls)
        write_json(self.root / "models" / "models_info.json", {"2": {"diameter": 101.0}, "3": {"diameter": 50.0}})
        self.assertEqual(self.run_it("--dataset", self.root).returncode, 0)
        self.assertEqual(len(self.calls("hs-teach")), 2)

    def test_programs_are_given_the_chosen_images_and_the_known_objects(self):
        write_set(self.root)
        write_json(self.root / "test_targets_bop19.json", [target(50, 1, 2), target(50, 1, 3)])
        done = self.run_it("--dataset", f"mine={self.root}", "--no-rivals")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("left out, unknown to", done.stdout)
        self.assertIn("objects 3", done.stdout)
        self.assertEqual(list(self.summary()["datasets"]["mine"]["scenes"]), ["000050"])
        self.assertEqual(self.summary()["datasets"]["mine"]["targets_named"], 2)
        scene = self.out / "data" / "mine" / "seed_1" / "scenes" / "000050"
        self.assertEqual(json.loads((scene / "scene_gt.json").read_text()), {"1": [entry(2)]})
        self.assertEqual(json.loads((scene / "names.json").read_text()), {"2": "object_2"})
        self.assertTrue((scene / "rgb" / "000001.png").is_file())
        self.assertEqual(self.calls("hs-study linemod"), [])
        self.assertIsNone(self.summary()["datasets"]["mine"]["ar_ppf"])

    def test_seeds_give_means_and_their_spread(self):
        write_set(self.root)
        done = self.run_it("--dataset", self.root, "--seeds", "2", "--no-rivals")
        self.assertEqual(done.returncode, 0, done.stderr)
        figures = self.summary()["datasets"]["ycbv"]
        self.assertEqual(len(figures["runs"]), 2)
        self.assertEqual(figures["spread"]["ar"], [figures["ar"]] * 2)
        self.assertEqual([call.split("--seed ")[1][0] for call in self.calls("hs-teach")], ["1", "2"])


class StoreTaughtBefore(Case):
    def store(self, *objects, diameter=100.0):
        store = self.folder / "store"
        write_json(
            store / "store.json", {"houghstream_store": 1, "objects": [{"id": i, "name": n} for i, n in objects]}
        )
        write_json(store / "models" / "models_info.json", {str(i): {"diameter": diameter} for i, _ in objects})
        return store

    def test_it_is_tested_without_teaching(self):
        write_set(self.root)
        done = self.run_it("--dataset", self.root, "--objects", self.store((2, "object_2")))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.calls("hs-teach"), [])
        # Forest and models alone would leave out where votes point, the tone and what the qualities are learnt from.
        for name in ("hs-evaluate", "hs-study pose", "hs-study failures"):
            for call in self.calls(name):
                self.assertIn(f"--objects {self.folder / 'store'}", call)
                self.assertNotIn("--forest", call)
        self.assertIsNone(self.summary()["datasets"]["ycbv"]["teach_seconds"])

    def refused(self, words, *options, **store):
        done = self.run_it("--dataset", self.root, *options)
        self.assertNotEqual(done.returncode, 0)
        self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
        self.assertIn(words, done.stderr)

    def test_one_that_knows_none_of_the_objects_is_refused(self):
        write_set(self.root)
        self.refused("knows none of the objects of ycbv: 2, 3", "--objects", self.store((9, "object_9")))
        self.refused("knows none", "--objects", self.store((2, "box"), diameter=150.0))  # another object of the same id
        (self.folder / "store" / "store.json").unlink()
        self.refused("store.json: not there", "--objects", self.folder / "store")


class BadInput(Case):
    def refused(self, words, *options):
        done = self.run_it(*(options or ("--dataset", self.root)))
        self.assertEqual(done.returncode, 1)
        self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
        self.assertIn(words, done.stderr)
        self.assertEqual(self.calls("hs-"), [])

    def test_sets_that_are_none_are_refused_before_anything_runs(self):
        self.refused("no such folder")
        self.root.mkdir()
        self.refused("models_info.json: not there")
        write_json(self.root / "models" / "models_info.json", {"2": {"diameter": 100.0}})
        self.refused("no scenes")
        write_scene(self.root / "test" / "000001", {4: [(2, 1.0)]})
        (self.root / "test" / "000001" / "depth" / "000004.png").unlink()
        self.refused("depth/000004.png: not there")

    def test_targets_that_name_what_is_missing_are_refused(self):
        write_set(self.root)
        for targets, words in (
            ([target(48, 1, 2)], "scene 48 is not in"),
            ([target(50, 3, 2)], "image 3 is not there"),
            ([{"scene_id": 50}], 'entry 0 is {"scene_id": 50}'),
            ([], "no list of targets"),
        ):
            write_json(self.root / "test_targets_bop19.json", targets)
            self.refused(words)

    def test_wrong_options_are_refused(self):
        write_set(self.root)
        self.refused("no --dataset", "--no-rivals")
        self.refused("a second set called ycbv", "--dataset", self.root, "--dataset", self.root)
        self.refused("the name is 'a b'", "--dataset", f"a b={self.root}")
        self.refused("--seeds with --objects", "--dataset", self.root, "--objects", self.root, "--seeds", "2")

    def test_an_interruption_while_sets_are_read_is_one_line(self):
        code = (
            "import signal, sys, studies.bop.__main__ as command\n"
            "command.open_all = lambda _: signal.raise_signal(signal.SIGINT)\n"
            "sys.argv[1:] = ['--dataset', 'ycbv=anywhere']\n"
            "command.main()\n"
        )
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
        self.assertEqual(done.returncode, 1)
        self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
        self.assertIn("interrupted", done.stderr)

    def test_what_a_program_says_is_told(self):
        write_set(self.root)
        done = self.run_it("--dataset", self.root, BOP_FAKE_FAILS="yes")
        self.assertEqual(done.returncode, 1)
        self.assertIn("obj_000002.ply: no faces", done.stderr)
        self.assertIn("exit status 1", done.stderr.splitlines()[-1])


class Chosen(Case):
    def test_every_nth_of_the_targets_or_of_all(self):
        write_scene(self.root, {3: [(2, 1.0)], 5: [], 11: [], 20: []})
        self.assertEqual(chosen_images(self.root, None, 2), [3, 11])
        self.assertEqual(chosen_images(self.root, {20: {}, 5: {}, 3: {}}, 2), [3, 20])

    def test_what_is_there_but_no_target_is_neither_missed_nor_false(self):
        write_scene(self.root, {3: [(2, 0.3), (2, 0.9), (5, 0.8), (2, 0.6), (7, 1.0)]})
        content = choose(self.root, [3], {2: "a", 5: "b"}, {3: {2: 2}})
        visible = [info["visib_fract"] for info in content["scene_gt_info.json"]["3"]]
        self.assertEqual(visible, [0.0, 0.9, 0.0, 0.6])  # of object 2 the two most visible ones; 7 is unknown
        self.assertEqual([one["obj_id"] for one in content["scene_gt.json"]["3"]], [2, 2, 5, 2])

    def test_truth_and_its_infos_must_agree(self):
        write_scene(self.root, {3: [(2, 1.0)]})
        write_json(self.root / "scene_gt_info.json", {"3": []})
        with self.assertRaisesRegex(BadSet, "scene_gt_info.json: image 3 has 0 entries, expected 1"):
            choose(self.root, [3], {2: "a"})

    def test_scenes_may_lie_without_a_folder_of_the_split(self):
        write_set(self.root, split=".")
        self.assertEqual([scene.name for scene in open_dataset(str(self.root), "test", 1).scenes], ["000001", "000050"])

    def test_models_may_be_the_ones_made_by_cad(self):
        write_set(self.root)
        (self.root / "models").rename(self.root / "models_cad")
        self.assertEqual(open_dataset(f"tless={self.root}", "test", 1).models, self.root / "models_cad")

    def test_names_of_an_option(self):
        self.assertEqual(names_of("2=a,5=b_c"), {2: "a", 5: "b_c"})
        self.assertEqual(names_of(""), {})


class Pooling(unittest.TestCase):
    def test_precision_is_unknown_where_nothing_was_found(self):
        self.assertIsNone(figures.share(0, 0))
        self.assertEqual(figures.weighted([(None, 3), (0.5, 2), (1.0, 0)]), 0.5)
        self.assertIsNone(figures.weighted([]))

    def test_what_no_seed_measured_stays_unknown(self):
        run = dict.fromkeys((*figures.FIGURES, *figures.COUNTS, "ar_at_default"))
        pooled = figures.over_seeds([run | {"ar": 0.5}, run | {"ar": 0.7}])
        self.assertAlmostEqual(pooled["ar"], 0.6)
        self.assertEqual(pooled["spread"], {"ar": [0.5, 0.7]})
        self.assertIsNone(pooled["ar_ppf"])
        self.assertEqual(report.with_spread(pooled, "ar"), "0.600 (0.500 to 0.700)")


if __name__ == "__main__":
    unittest.main()
