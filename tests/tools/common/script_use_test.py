"""The output of programs for scripts: JSON where it is asked for, statuses, colours for a terminal only. Usage:
script_use_test.py EXECUTABLES_FOLDER"""

import json
import os
import pathlib
import pty
import subprocess
import sys
import tempfile
import unittest

from houghstream import images_t
from houghstream.event_log import Event, write_event

EXECUTABLES = pathlib.Path(sys.argv[1]).resolve()
RED = b"\x1b[31m"


def run(*words, **environment):
    command = [str(EXECUTABLES / words[0]), *map(str, words[1:])]
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=60, env={**os.environ, **environment})


def on_terminal(*words, **environment):
    """Returns what a terminal gets of the program."""
    reader, writer = pty.openpty()
    command = [str(EXECUTABLES / words[0]), *map(str, words[1:])]
    child = subprocess.Popen(command, stdin=writer, stdout=writer, stderr=writer, env={**os.environ, **environment})
    os.close(writer)
    said = b""
    try:
        while part := os.read(reader, 4096):
            said += part
    except OSError:  # the other side is closed
        pass
    os.close(reader)
    child.wait()
    return said


class Json(unittest.TestCase):
    def test_hs_log_info(self):
        with tempfile.TemporaryDirectory() as folder:
            log = pathlib.Path(folder) / "a log"
            with open(log, "wb") as out:
                for number, channel in enumerate(("ONCE", "OPENNI_FRAME", "OPENNI_FRAME", "OPENNI_FRAME")):
                    message = images_t()
                    message.utime = 10**15 + number
                    write_event(out, number, Event(10**15 + 500_000 * number, channel, message.encode()))
            done = run("hs-log", "info", log, "--json")
            info = json.loads(done.stdout)
            self.assertEqual((done.returncode, info["file"], info["events"], info["duration_s"]), (0, str(log), 4, 1.5))
            self.assertEqual(info["bytes"], log.stat().st_size)
            once, frames = info["channels"]
            self.assertEqual((once["name"], once["messages"], once["rate_hz"], once["longest_gap_s"]), ("ONCE", 1, None, None))
            self.assertEqual((frames["name"], frames["messages"], frames["rate_hz"]), ("OPENNI_FRAME", 3, 2.0))
            self.assertEqual(frames["types"], ["images_t (bot_core)"])
            self.assertEqual((frames["longest_gap_s"], frames["first_utime"]), (0.5, 10**15 + 500_000))

    def test_hs_doctor(self):
        done = run("hs-doctor", "--json", "-l", "memq://")
        said = json.loads(done.stdout)
        self.assertEqual(said["works"], done.returncode == 0)
        self.assertEqual(said["works"], all(finding["level"] != "wrong" for finding in said["findings"]))
        self.assertGreater(len(said["findings"]), 5)
        self.assertEqual({tuple(finding) for finding in said["findings"]}, {("level", "name", "found", "remedy")})

    def test_hs_capture_lists_devices(self):
        done = run("hs-capture", "--list-devices", "--json", LD_LIBRARY_PATH=str(EXECUTABLES.parent / "virtual_camera"))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIsInstance(json.loads(done.stdout), list)
        refused = run("hs-capture", "--json", "--source", "openni2")
        self.assertEqual((refused.returncode, refused.stderr), (2, "hs-capture: --json goes with --list-devices\n"))


class Statuses(unittest.TestCase):
    def test_what_the_tools_readme_says_of_them(self):
        for words, status in ((("hs-log", "--help"), 0), (("hs-log", "--version"), 0), (("hs-log",), 2), (("hs-log", "--nonsense"), 2),
                              (("hs-capture",), 2), (("hs-detect",), 2), (("hs-stream",), 2), (("hs-detect", "--threshold", "2"), 2),
                              (("hs-detect", "--forest", "/nowhere"), 1),
                              (("hs-log", "info", "/nowhere"), 1)):  # fmt: skip
            self.assertEqual(run(*words).returncode, status, words)


class Colours(unittest.TestCase):
    FAILING = ("hs-log", "info", "/nowhere")

    def test_a_terminal_gets_them(self):
        self.assertTrue(on_terminal(*self.FAILING, TERM="xterm", NO_COLOR="").startswith(RED + b"hs-log:\x1b[0m "))

    def test_nobody_else_does(self):
        self.assertTrue(run(*self.FAILING, TERM="xterm", NO_COLOR="").stderr.startswith("hs-log: "))
        for unwanted in ({"NO_COLOR": "1"}, {"TERM": "dumb"}, {"TERM": ""}):
            said = on_terminal(*self.FAILING, **{"TERM": "xterm", "NO_COLOR": "", **unwanted})
            self.assertTrue(said.startswith(b"hs-log: "), (unwanted, said))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
