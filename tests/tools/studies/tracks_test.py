"""What tools/bench tracks adds up of its sequences, and how it asks for them."""

import contextlib
import io
import unittest

from studies.tracks.__main__ import SEQUENCES, parse
from studies.tracks.plan import Plan
from studies.tracks.report import longest, pooled


def figures(name, required, recall, wrong, switches=0, hota=0.9):
    return {"name": name, "required": required, "recall": recall, "wrong": wrong, "id_switches": switches, "hota": hota,
            "error": {"moving": {"mm_p95": None}}}  # fmt: skip


class TracksTest(unittest.TestCase):
    def test_shares_follow_the_counts(self):
        both = pooled([figures("pushed", 300, 0.9, {"can": 10}, 1, 0.8), figures("cans", 100, 0.5, {}, 2, 0.4)])
        self.assertEqual(both["sequences"], ["pushed", "cans"])
        self.assertAlmostEqual(both["recall"], (270 + 50) / 400)
        self.assertAlmostEqual(both["precision"], 320 / 330)
        self.assertEqual(both["id_switches"], 3)
        self.assertAlmostEqual(both["hota"], 0.7)

    def test_what_was_never_found_has_no_longest_time(self):
        self.assertEqual(longest([[0.1, 0.4], [0.2]]), 0.4)
        self.assertIsNone(longest([[0.1], [None]]))
        self.assertIsNone(longest([[], []]))

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
                                 "again/cans.json", "single/cans.json"])  # fmt: skip
        plan.sequence("cameras")
        self.assertIn("tracked/CAMERA_2.json", [unit.name for unit in plan.units.all()])


if __name__ == "__main__":
    unittest.main()
