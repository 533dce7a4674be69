"""Tests of what tools/bench attitudes adds up. Usage: PYTHONPATH=tools bench_attitudes_test.py"""

import json
import pathlib
import shutil
import tempfile
import unittest

from bop_fakes import write_evaluation, write_json
from studies.bench import attitudes
from studies.command import TEST_SCENES

# By how it was taught: whose figures of bop_fakes.SCENES stand for every scene, AUC 1 and 0.75, average recall 0.9 and 0.5.
FAKES = {"upright": "000001", "resting": "000050"}


class Attitudes(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.out = pathlib.Path(place.name)
        for name, fake in FAKES.items():
            for scene in (*attitudes.LYING, *TEST_SCENES):
                folders = attitudes.scene_folders(self.out, name, scene)
                write_evaluation(folders.ranked, fake)
                write_evaluation(folders.default, fake, 0.8)
        write_json(self.out / "attitudes" / "teach_seconds.json", {"upright": 70.0, "resting": None})

    def test_each_store_stands_in_each_scene_and_group(self):
        summary = attitudes.summarise(self.out)
        self.assertEqual([summary["scenes"][name]["table_tilted"]["auc"] for name in FAKES], [1.0, 0.75])
        for group in ("lying", "standing"):
            found = summary["groups"][group]
            self.assertEqual([found[name]["ar"] for name in FAKES], [0.9, 0.5])
            self.assertEqual([found[name]["precision"] for name in FAKES], [0.5, 1.0])
        self.assertEqual(summary["auc_lost_standing"], 0.25)

    def test_a_group_s_auc_is_the_mean_of_its_scenes(self):
        ranked = attitudes.scene_folders(self.out, "resting", "desk_1").ranked
        shutil.rmtree(ranked)
        write_evaluation(ranked, "000001")
        summary = attitudes.summarise(self.out)
        self.assertAlmostEqual(summary["groups"]["standing"]["resting"]["auc"], (5 * 0.75 + 1.0) / 6)
        self.assertEqual(summary["groups"]["lying"]["resting"]["auc"], 0.75)

    def test_the_file_holds_commit_and_figures_and_the_words_what_was_not_measured(self):
        attitudes.write(self.out)
        written = json.loads((self.out / "attitudes.json").read_text())
        self.assertEqual(written["command"], "tools/bench attitudes")
        self.assertIn("mean of what is lying", [row[0] for row in attitudes.rows(written)])
        self.assertEqual(attitudes.default_rows(written)[1][:3], ("lying, taught upright", "0.500", "1.000"))
        self.assertIn("taught upright 70 s, taught as they come to rest – s", attitudes.words(written))


if __name__ == "__main__":
    unittest.main()
