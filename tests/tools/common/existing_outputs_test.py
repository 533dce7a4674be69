"""Outputs of a name that is taken: what is there stays unless --replace is given, and then until the new one is whole. Usage:
existing_outputs_test.py EXECUTABLES_FOLDER"""

import pathlib
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest

from houghstream import images_t
from houghstream.event_log import Event, write_event

EXECUTABLES = pathlib.Path(sys.argv[1]).resolve()
NOWHERE = pathlib.Path("/nonexistent")
OLD = b"of somebody else"
OF_LOG = (("filter",), ("seal",), ("repair",), ("import",), *(("export", kind) for kind in ("csv", "json", "mcap", "objects-csv", "objects-json")))
TRAIN = ("hs-train", "--views", f"bop:{NOWHERE}", "--background", f"bop:{NOWHERE}", "--out")


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.out = self.folder / "out"
        self.out.write_bytes(OLD)

    def run_tool(self, *words):
        command = [str(EXECUTABLES / words[0]), *map(str, words[1:])]
        return subprocess.run(command, capture_output=True, text=True, check=False, timeout=60)

    def expect_refused(self, *words):
        done = self.run_tool(*words)
        said = f"{words[0]}: {self.out}: is there already, expected a new name, or --replace to put the new one in its place\n"
        self.assertEqual((done.returncode, done.stdout, done.stderr), (1, "", said), words)
        self.assertEqual(self.out.read_bytes(), OLD)


class WhatIsThere(Case):
    def test_is_refused_by_each_job_of_hs_log(self):
        for job in OF_LOG:
            self.expect_refused("hs-log", *job, NOWHERE, self.out)

    def test_is_refused_by_hs_train_and_hs_observe(self):
        self.expect_refused(*TRAIN, self.out)
        for option in ("--out", "--csv"):
            self.expect_refused("hs-observe", "--duration", "0.1", "-l", "memq://", option, self.out)

    def test_is_no_folder_for_frames(self):
        for kind in ("bop", "png"):
            done = self.run_tool("hs-log", "export", kind, NOWHERE, self.out)
            self.assertNotIn("--replace", done.stderr)
            self.assertEqual((done.returncode, self.out.read_bytes()), (1, OLD))

    def test_is_refused_through_a_link_too(self):
        link = self.folder / "link"
        link.symlink_to(self.out)
        done = self.run_tool("hs-log", "filter", NOWHERE, link)
        self.assertIn(f"{link}: is there already", done.stderr)

    def test_stays_where_replace_makes_nothing(self):
        for words in (*(("hs-log", *job, NOWHERE, self.out) for job in OF_LOG), (*TRAIN, self.out)):
            done = self.run_tool(*words, "--replace")
            self.assertEqual(done.returncode, 1, words)
            self.assertNotIn("is there already", done.stderr)
            self.assertEqual(self.out.read_bytes(), OLD, words)
        self.assertEqual(list(self.folder.iterdir()), [self.out])


class Replaced(Case):
    def setUp(self):
        super().setUp()
        self.log = self.folder / "log"
        with open(self.log, "wb") as log:
            for number in range(3):
                write_event(log, number, Event(10**15 + number, "A", images_t().encode()))

    def test_by_what_is_whole(self):
        for job in ("filter", "seal"):
            self.out.write_bytes(OLD)
            done = self.run_tool("hs-log", job, self.log, self.out, "--replace")
            self.assertEqual((done.returncode, done.stdout), (0, f"3 events in {self.out}\n"), done.stderr)
            self.assertNotEqual(self.out.read_bytes(), OLD)

    def test_a_device_is_none(self):
        done = self.run_tool("hs-log", "filter", self.log, "/dev/null")
        self.assertEqual((done.returncode, done.stdout), (0, "3 events in /dev/null\n"), done.stderr)

    def test_the_input_is_never_replaced(self):
        before = self.log.read_bytes()
        done = self.run_tool("hs-log", "filter", self.log, self.log, "--replace")
        self.assertEqual(done.returncode, 1)
        self.assertIn("is the source itself", done.stderr)
        self.assertEqual(self.log.read_bytes(), before)


def write_long_log(file, events=800, size=1 << 20):
    """A log whose events hold nothing: holes of the file, which take no space."""
    with open(file, "wb") as log:
        for number in range(events):
            log.write(struct.pack(">IqqII", 0xEDA1DA01, number, 10**15 + number, 1, size) + b"A")
            log.seek(size, 1)
        log.truncate()


class Stopped(Case):
    def test_a_job_of_hs_log_leaves_no_part_behind(self):
        log = self.folder / "log"
        write_long_log(log)
        partial = self.folder / "out.partial"
        for job, number in (("filter", signal.SIGINT), ("filter", signal.SIGTERM), ("seal", signal.SIGINT)):
            command = [str(EXECUTABLES / "hs-log"), job, log, self.out, "--replace"]
            child = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            while child.poll() is None and not partial.exists():
                time.sleep(0.002)
            child.send_signal(number)
            _, said = child.communicate(timeout=60)
            self.assertEqual((child.returncode, said.splitlines()[-1]), (-number, f"hs-log: stopped; {self.out} is as it was"))
            self.assertEqual(self.out.read_bytes(), OLD)
            self.assertEqual(sorted(path.name for path in self.folder.iterdir()), ["log", "out"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
