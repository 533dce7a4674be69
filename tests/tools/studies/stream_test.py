"""Tests of the one stream runner, with stand-ins for the processes. Usage: PYTHONPATH=tools stream_test.py"""

import json
import pathlib
import tempfile
import time
import unittest

from studies.stream import Process, Processes, ProcessFailed, Stream, enter_shared_network

# Says that it is ready, and ends when asked to; hs-observe writes what it was told to, and ends by itself.
STAND_IN = """#!/usr/bin/python3
import os, signal, sys, time
signal.signal(signal.SIGINT, lambda *_: sys.exit(int(os.environ.get("STAND_IN_STATUS", 0))))
print(os.path.basename(sys.argv[0]), *sys.argv[1:], "ready", flush=True)
if "hs-observe" in sys.argv[0]:
    open(sys.argv[sys.argv.index("--out") + 1], "w").write("{}")
    sys.exit()
time.sleep(60)
"""


class Case(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.folder = pathlib.Path(place.name)

    def program(self, name):
        file = self.folder / name
        file.write_text(STAND_IN)
        file.chmod(0o755)
        return file


class OneProcess(Case):
    def test_it_is_ready_when_it_says_so_and_ends_when_asked(self):
        process = Process(self.folder, self.program("hs-detect"), name="detect")
        self.addCleanup(process.kill)
        process.wait_until_ready()
        process.stop(10)
        self.assertIn("hs-detect ready", (self.folder / "detect.txt").read_text())

    def test_its_last_words_are_told_where_it_fails(self):
        process = Process(self.folder, "sh", "-c", "echo no such forest; exit 3")
        with self.assertRaisesRegex(ProcessFailed, "(?s)sh ended before it was ready.*no such forest"):
            process.wait_until_ready()
        with self.assertRaisesRegex(ProcessFailed, "status 3"):
            process.wait(5)

    def test_one_that_does_not_end_is_killed_and_told(self):
        process = Process(self.folder, "sh", "-c", "trap '' INT; echo ready; while :; do sleep 0.1; done")
        process.wait_until_ready()
        with self.assertRaisesRegex(ProcessFailed, "did not end within 0.2 s"):
            process.stop(0.2)
        self.assertFalse(process.runs())

    def test_none_is_left_where_the_run_fails(self):
        with self.assertRaises(ZeroDivisionError), Processes(self.folder / "log") as running:
            process = running.start("detect", self.program("hs-detect"))
            process.wait_until_ready()
            1 / 0
        self.assertFalse(process.runs())


class WholeStream(Case):
    def stream(self, **more):
        for name in ("hs-detect", "hs-pose", "hs-track", "hs-observe"):
            self.program(name)
        enter_shared_network()
        return Stream(self.folder, self.folder / "forest", None, 30, self.folder / "out", **more)

    def test_frames_are_sent_when_all_are_ready(self):
        stream = self.stream(detect=("--threshold", "0.01"), watch=True)
        begin = time.monotonic()
        stream.play("sh", "-c", f"cd {stream.out}/log && cat detect.txt pose.txt observe.txt")
        self.assertLess(time.monotonic() - begin, 8.0)
        said = (stream.out / "log" / "player.txt").read_text()
        self.assertIn("--expect 30", said)
        self.assertIn("--threshold 0.01 ready", said)
        self.assertEqual(set(json.loads((stream.out / "usage.json").read_text())["rss_mb"]), {"detect", "pose"})

    def test_objects_are_tracked_where_that_is_asked_for(self):
        stream = self.stream(watch=True, track=True)
        stream.play("sh", "-c", f"cat {stream.out}/log/track.txt")
        self.assertIn("hs-track ready", (stream.out / "log" / "player.txt").read_text())
        self.assertEqual(set(json.loads((stream.out / "usage.json").read_text())["cores"]), {"detect", "pose", "track"})

    def test_a_sender_that_fails_fails_the_run(self):
        with self.assertRaisesRegex(ProcessFailed, "player ended with status 1"):
            self.stream().play("false")

    def test_a_process_that_fails_at_its_end_fails_the_run(self):
        stream = self.stream()
        (self.folder / "hs-pose").write_text(STAND_IN.replace('STAND_IN_STATUS", 0', 'STAND_IN_STATUS", 5'))
        with self.assertRaisesRegex(ProcessFailed, "pose ended with status 5"):
            stream.play("true")


if __name__ == "__main__":
    unittest.main()
