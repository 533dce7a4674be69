"""The sample .pmd and the systemd units start executables that exist, with options that they know; what --help says is so.

Usage: samples_test.py SOURCE_FOLDER EXECUTABLES_FOLDER
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

SOURCE, EXECUTABLES = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
SAMPLES = SOURCE / "tools" / "stream"


def check_command(test, name, words):
    """Every option of the command is one that the executable's help names."""
    words_of_help = subprocess.run([str(EXECUTABLES / name), "--help"], capture_output=True, text=True, check=True).stdout
    options = re.findall(r"--[a-z-]+", words)
    test.assertTrue(options)
    for option in options:
        test.assertRegex(words_of_help, rf"(?m)^ .*{option}\b", f"{name} {words}")


def help_of(*words):
    """What --help of a program, or of a program's job, says."""
    return subprocess.run([str(EXECUTABLES / words[0]), *words[1:], "--help"], capture_output=True, text=True, check=False).stdout


class Help(unittest.TestCase):
    def test_the_product_offers_no_settings_that_studies_alone_have(self):
        for word in ("gall", "pfh", "--scale-handling"):
            self.assertNotRegex(help_of("hs-train"), rf"(?<![\w-]){word}\b")
            self.assertRegex(help_of("hs-study-train"), rf"(?<![\w-]){word}\b")

    def test_a_benchmark_names_its_own_options(self):
        self.assertIn("--scene", help_of("hs-bench-kernels"))


class Samples(unittest.TestCase):
    def test_pmd(self):
        commands = re.findall(r'exec = "build/bin/(\S+) ([^"]*)"', (SAMPLES / "houghstream.pmd").read_text())
        self.assertEqual([name for name, _ in commands], ["hs-capture", "hs-detect", "hs-pose", "hs-view"])
        for name, words in commands:
            check_command(self, name, words)

    def test_pmd_is_balanced(self):
        text = (SAMPLES / "houghstream.pmd").read_text()
        self.assertEqual(text.count("{"), text.count("}"))
        groups = set(re.findall(r'^group "(.*)"', text, re.M))
        self.assertEqual(set(re.findall(r'(?:start|stop) group "(.*)"', text)), groups)

    def test_units(self):
        settings = (SAMPLES / "systemd" / "houghstream.env").read_text()
        wanted = (SAMPLES / "systemd" / "houghstream.target").read_text()
        units = sorted((SAMPLES / "systemd").glob("*.service"))
        self.assertEqual(len(units), 3)
        for unit in units:
            text = unit.read_text()
            name, words = re.search(r'exec "\$HOUGHSTREAM_BIN/(\S+)" (.*)\'$', text, re.M).groups()
            check_command(self, name, words)
            self.assertIn(unit.name, wanted)
            for variable in re.findall(r"\$(\w+)", text):
                self.assertRegex(settings, rf"(?m)^{variable}=")

    @unittest.skipUnless(shutil.which("systemd-analyze"), "no systemd here")
    def test_units_are_understood(self):
        with tempfile.TemporaryDirectory() as folder:
            for unit in (SAMPLES / "systemd").iterdir():
                shutil.copy(unit, folder)
            units = [str(path) for path in pathlib.Path(folder).glob("*.service")]
            environment = dict(os.environ, XDG_RUNTIME_DIR=folder)
            result = subprocess.run(["systemd-analyze", "--user", "verify", *units], capture_output=True, text=True,
                                    check=False, env=environment)
            complaints = [line for line in result.stderr.splitlines() if folder in line or "houghstream" in line]
            self.assertEqual(complaints, [])

    @unittest.skipUnless(shutil.which("systemd-analyze"), "no systemd here")
    def test_units_keep_to_what_a_stream_needs(self):
        units = [str(path) for path in (SAMPLES / "systemd").glob("*.service")]
        result = subprocess.run(["systemd-analyze", "security", "--offline=true", "--threshold=60", "--no-pager", *units],
                                capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
