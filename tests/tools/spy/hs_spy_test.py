"""hs-spy says in one line why it cannot start. Usage: hs_spy_test.py HS_SPY"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

HS_SPY = pathlib.Path(sys.argv.pop(1))


def start(*arguments, program=HS_SPY, **environment):
    environment = {"PATH": os.environ["PATH"], "DISPLAY": ":0", **environment}
    return subprocess.run([str(program), *arguments], capture_output=True, text=True, check=False, timeout=60,
                          env=environment)


class HsSpy(unittest.TestCase):
    def assert_refused(self, result, part):
        self.assertNotEqual(result.returncode, 0)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        self.assertTrue(result.stderr.startswith("hs-spy: "), result.stderr)
        self.assertIn(part, result.stderr)

    def test_help_and_version(self):
        self.assertIn("--lcm-url", start("--help").stdout)
        self.assertRegex(start("--version").stdout, r"^hs-spy \d+\.\d+\.\d+\n$")

    def test_arguments_that_mean_nothing(self):
        self.assert_refused(start("--no-such"), "unknown argument --no-such")
        self.assert_refused(start("-l"), "-l needs a value")
        self.assert_refused(start("--heap", "much"), "--heap much")
        self.assertEqual([start(*words).returncode for words in (["--no-such"], ["-l"], ["--heap", "much"])], [2, 2, 2])
        self.assert_refused(start("-l", "nonsense://x"), "LCM URL nonsense://x: expected udpm://")
        self.assert_refused(start("-l", "file:///tmp/x.lcmlog"), "lcm-logplayer")

    def test_no_java(self):
        self.assert_refused(start(JAVA_HOME="/nowhere"), "/nowhere/bin/java not found; sudo apt-get install")

    def test_no_display(self):
        self.assert_refused(start(DISPLAY=""), "DISPLAY is not set")
        self.assert_refused(start(DISPLAY=":9999"), "no display")

    def test_missing_libraries(self):
        with tempfile.TemporaryDirectory() as folder:
            alone = pathlib.Path(folder, "hs-spy")
            text = HS_SPY.read_text(encoding="utf-8")
            alone.write_text(text, encoding="utf-8")
            alone.chmod(0o755)
            self.assert_refused(start(program=alone), "houghstream_types.jar not found")
            alone.write_text(re.sub("^lcm_jar=.*", "lcm_jar=/nowhere/lcm.jar", text, flags=re.M), encoding="utf-8")
            self.assert_refused(start(program=alone), "/nowhere/lcm.jar not found; sudo apt-get install liblcm-java")


if __name__ == "__main__":
    unittest.main()
