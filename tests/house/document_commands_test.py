"""Plants commands that no program understands and expects each to be found, and nothing in a tidy house."""

import unittest

import document_commands
import seeded_faults

HELP = {
    ("hs-detect", ""): "  --forest TEXT  a forest\n  --threads INT\n",
    ("hs-log", "export"): "  --frames INT\n",
    ("hs-log", "export bop"): "  --camera TEXT\n",
    ("hs-log", "info"): "  --json\n",
}
GOOD = {
    "README.md": "Run\n\n    build/bin/hs-detect --forest F --threads 2    # --made-up is a comment's\n    hs-log export --frames 3 LOG | sort --unique\n",
    "tools/README.md": "`hs-log info --json LOG`, `--anything`, `hs-detect`, `hs-log export bop LOG --camera C`, `hs-spy --log`, `ls --all`\n",
}
WRONG = {
    "an option that is gone": "    build/bin/hs-detect --model F\n",
    "one of another subcommand": "`hs-log info --frames 3`\n",
    "one of a job of another subcommand": "`hs-log export bop LOG --frames 3`\n",
    "a program that is gone": "    hs-find --forest F\n",
    "one in the middle of a line": "    hs-log info LOG && build/bin/hs-detect --treads 2\n",
}


def faults_with(extra):
    return seeded_faults.faults_of({**GOOD, **extra}, lambda root: list(document_commands.find_faults(root, lambda *key: HELP.get(key))))


class DocumentCommands(unittest.TestCase):
    def test_a_tidy_house_has_no_fault(self):
        self.assertEqual(faults_with({}), [])

    def test_every_planted_fault_is_found_once(self):
        for what, text in WRONG.items():
            with self.subTest(what):
                self.assertEqual(len(faults_with({"pose/README.md": text})), 1, faults_with({"pose/README.md": text}))


if __name__ == "__main__":
    unittest.main()
