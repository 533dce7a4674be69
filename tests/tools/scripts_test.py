"""The scripts that a person starts tell what they do, and refuse what they do not know, before they do anything.

Usage: scripts_test.py SOURCE_FOLDER
"""

import pathlib
import subprocess
import sys
import unittest

TOOLS = pathlib.Path(sys.argv[1]).resolve() / "tools"
SCRIPTS = sorted(path for path in TOOLS.iterdir() if path.is_file() and path.read_bytes()[:2] == b"#!")


def start(script, word):
    return subprocess.run([str(script), word], capture_output=True, text=True, timeout=60, check=False)


class Scripts(unittest.TestCase):
    def test_help_begins_with_what_they_are_or_how_they_are_started(self):
        self.assertGreater(len(SCRIPTS), 7)
        for script in SCRIPTS:
            said = start(script, "--help")
            self.assertEqual(said.returncode, 0, script)
            self.assertIn(script.name, said.stdout, script)
            self.assertNotIn(" s] ", said.stdout, f"{script}: has begun its work")

    def test_what_they_do_not_know_is_refused_in_a_line(self):
        for script in SCRIPTS:
            said = start(script, "--nonsense")
            self.assertNotEqual(said.returncode, 0, script)
            self.assertEqual(said.stderr.count("\n"), 1, said.stderr)
            self.assertIn("--nonsense", said.stderr, script)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
