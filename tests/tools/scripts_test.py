"""The scripts that a person starts tell what they do, and refuse what they do not know, before they do anything.

Usage: scripts_test.py SOURCE_FOLDER
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
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


class Setup(unittest.TestCase):
    """tools/setup in a copy of its folder, with stand-ins that note what is installed and install nothing."""

    def installed_by(self, *words):
        with tempfile.TemporaryDirectory(prefix="scripts_test_") as name:
            folder = pathlib.Path(name)
            (folder / "tools").mkdir()
            for file in ("setup", "common.sh", "packages.txt"):
                shutil.copy(TOOLS / file, folder / "tools")
            npm_list = folder / "tests/tools/foxglove"
            npm_list.mkdir(parents=True)
            for file in ("package.json", "package-lock.json"):
                (npm_list / file).write_text("{}")
            stand_ins = {"dpkg-query": "exit 1", "apt-get": f'echo "apt-get $*" >>{name}/calls', "sleep": "exit 0", "sudo": 'exec "$@"',
                         "npm": f'echo "npm $*" >>{name}/calls'}  # fmt: skip
            for program, line in stand_ins.items():
                (folder / program).write_text(f"#!/bin/sh\n{line}\n")
                (folder / program).chmod(0o755)
            said = subprocess.run([str(folder / "tools/setup"), *words], capture_output=True, text=True, timeout=60, check=False,
                                  env={**os.environ, "PATH": f"{name}:{os.environ['PATH']}"})  # fmt: skip
            self.assertEqual(said.returncode, 0, said.stderr)
            return set((folder / "calls").read_text().split())

    def test_the_demo_asks_for_nothing_that_only_tests_and_comparisons_use(self):
        everything, for_demo = self.installed_by(), self.installed_by("--demo")
        beyond = {"libpcl-dev", "default-jdk-headless", "chromium", "clang-tidy", "nodejs", "libgtest-dev", "librosbag-storage-dev"}
        self.assertLess(beyond, everything)
        self.assertFalse(for_demo & (beyond | {"npm"}))
        needed = {"build-essential", "cmake", "liblcm-dev", "libopencv-dev", "libassimp-dev", "python3-matplotlib", "python3-jinja2"}
        self.assertLess(needed, for_demo)
        self.assertLess(for_demo, everything)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
