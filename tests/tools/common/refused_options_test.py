"""A combination that an option cannot honour is refused by every program, before anything is done, in one line that names
program and option.

Usage: refused_options_test.py EXECUTABLES_FOLDER
"""

import pathlib
import subprocess
import sys
import unittest

EXECUTABLES = pathlib.Path(sys.argv[1]).resolve()
# Nothing can be made there, whoever tries.
NOWHERE = "/dev/null/nowhere"
TRAIN = ("hs-train", "--views", f"bop:{NOWHERE}", "--background", f"bop:{NOWHERE}", "--out", "/dev/null")
EVALUATE = ("hs-evaluate", "--scene", NOWHERE)
FILTER = ("hs-log", "filter", f"{NOWHERE}/in.log", f"{NOWHERE}/out.log")
RENDER = ("hs-render", "training", "--out", NOWHERE)
SHOW = ("hs-teach", "show", "--source", NOWHERE, "--name", "mug", "--no-teach")
MESH = ("hs-teach", "mesh", f"{NOWHERE}.ply", "--out", NOWHERE)

# Program and command, option, values that it refuses.
REFUSED = (
    (("hs-capture",), "--frames", ("0", "nan")),
    (("hs-capture",), "--rate", ("nan", "inf", "1e-300", "-5")),
    (("hs-detect",), "--candidates", ("nan", "2")),
    (("hs-detect",), "--group-interval", ("nan", "-1")),
    (("hs-detect", "--forest", NOWHERE), "--group-interval", ("0.5",)),
    (("hs-detect",), "--looks-per-second", ("nan", "0")),
    (("hs-detect",), "--threshold", ("nan", "5", "-1")),
    (EVALUATE, "--min-iou", ("nan", "-1", "2")),
    (EVALUATE, "--min-mass", ("nan", "2")),
    (EVALUATE, "--min-visible", ("nan", "7")),
    (EVALUATE, "--operating-score", ("nan", "7")),
    (EVALUATE, "--threshold", ("nan",)),
    (FILTER, "--start", ("nan", "-5", "abc")),
    (FILTER, "--end", ("nan", "-5")),
    (("hs-observe",), "--duration", ("nan", "-1")),
    (("hs-observe",), "--expect", ("-1",)),
    (("hs-observe",), "--quiet", ("nan", "-1")),
    (("hs-pose",), "--min-quality", ("nan", "1.5")),
    (("hs-pose",), "--model-unit", ("inch",)),
    (RENDER, "--distance", ("nan",)),
    (RENDER, "--seed", ("-1",)),
    (("hs-stream",), "--every", ("nan",)),
    (MESH, "--camera", ("bogus",)),
    (MESH, "--seed", ("-1",)),
    (SHOW, "--at", ("1", "1,2,3")),
    (SHOW, "--box", ("1,2,3", "1,2,0,5")),
    (("hs-track",), "--wait", ("nan",)),
    (TRAIN, "--camera", ("1",)),
    (TRAIN, "--image-scale", ("nan",)),
    (TRAIN, "--min-distance", ("nan", "3", "-1")),
    (TRAIN, "--offset-share", ("nan",)),
    (TRAIN, "--threads", ("0", "-5")),
    (("hs-view",), "--after", ("0",)),
    (("hs-view",), "--duration", ("nan", "-1")),
    (("hs-view",), "--http-host", ("robot:80", "")),
    (("hs-view",), "--min-score", ("nan", "7")),
)  # fmt: skip


class RefusedOptions(unittest.TestCase):
    def check(self, words, option):
        done = subprocess.run([str(EXECUTABLES / words[0]), *words[1:]], capture_output=True, text=True, check=False, timeout=20)
        self.assertNotEqual(done.returncode, 0)
        self.assertEqual(done.stdout, "")
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        self.assertLess(len(done.stderr), 200)
        self.assertTrue(done.stderr.startswith(words[0]), done.stderr)
        self.assertIn(option, done.stderr)

    def test_results_to_evaluate(self):
        self.check(EVALUATE, "neither --log nor --forest nor --objects")

    def test_an_address_that_is_none_is_a_mistake_of_the_command_line(self):
        for address in ("99999", "here", "[::1:8080"):
            done = subprocess.run([EXECUTABLES / "hs-view", "--http", address], capture_output=True, text=True, check=False, timeout=20)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(f"--http {address}: ", done.stderr)

    def test_a_store_to_add_to_and_to_replace(self):
        for command in (MESH, (*SHOW, "--out", NOWHERE)):
            self.check((*command, "--replace", "--add"), "--add and --replace, expected at most one of them")

    def test_an_empty_name(self):
        self.check(("hs-log", "filter", f"{NOWHERE}/in.log", ""), "out: nothing, expected a value")

    def test_values(self):
        for command, option, values in REFUSED:
            for value in values:
                with self.subTest(program=command[0], option=option, value=value):
                    self.check((*command, option, value), option)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
