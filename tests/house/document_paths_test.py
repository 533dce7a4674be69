"""Plants stale paths in a small copy of the house and expects each to be found, and nothing in a tidy one."""

import unittest

import document_paths
import seeded_faults

GOOD = {
    "detector/README.md": "See `features/tiles.hpp`, `features/tiles`, `features/`, `detector/detector.cpp`, [the page](../README.md) and\n"
    "`other/thing.cpp`, which is no folder of ours; `--views bop:features`, `features/*.hpp`, `tools/NAME.ply`, `out/report.html`,\n"
    "`/usr/share/doc`, [BOP](https://bop.felk.cvut.cz/tools/x).\n",
    "detector/detector.cpp": "\n",
    "detector/features/tiles.hpp": "\n",
    "tools/view": "\n",
    "README.md": "Start with [detector](detector/README.md#stages).\n",
}
WRONG = {
    "a file that has moved": {"pose/README.md": "`detector/tiles.hpp`\n"},
    "one without its ending": {"detector/README.md": "`features/planes`\n"},
    "a folder": {"README.md": "`detector/voting/`\n"},
    "a link": {"README.md": "[tracks](pose/README.md) and [detector](../nowhere.md)\n", "pose/README.md": "\n"},
}


class DocumentPaths(unittest.TestCase):
    def test_a_tidy_house_has_no_fault(self):
        self.assertEqual(seeded_faults.faults_of(GOOD, lambda root: list(document_paths.find_faults(root))), [])

    def test_every_planted_fault_is_found_once(self):
        for what, extra in WRONG.items():
            with self.subTest(what):
                found = seeded_faults.faults_of({**GOOD, **extra}, lambda root: list(document_paths.find_faults(root)))
                self.assertEqual(len(found), 1, found)


if __name__ == "__main__":
    unittest.main()
