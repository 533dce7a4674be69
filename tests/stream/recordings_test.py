"""A recording is never destroyed: what was recorded until a kill -9 stays and is readable, and a second recording of the
same name leaves the first alone. Frames come of the virtual camera.
"""

import hashlib
import os
import re
import signal
import subprocess
import sys
import time
import unittest

from folders import read_arguments
from houghstream.event_log import read_log
from studies.stream import Process, enter_private_network

SECONDS = 60  # at most, for what takes a second where nothing else runs


def run(*command, good=True):
    result = subprocess.run([str(part) for part in command], check=False, text=True, capture_output=True, timeout=120)
    assert not good or result.returncode == 0, result
    return result


def wait_for_bytes(file, size):
    end = time.monotonic() + SECONDS
    while not (file.exists() and file.stat().st_size >= size):
        assert time.monotonic() < end, f"{file} has not got {size} bytes: {sorted(file.parent.iterdir())}"
        time.sleep(0.02)


def kill_when(process, file, size):
    """SIGKILL once so much was recorded. Returns how much there was."""
    try:
        wait_for_bytes(file, size)
        process.process.send_signal(signal.SIGKILL)
        process.process.wait()
    finally:
        process.kill()
    return file.stat().st_size


def digest(file):
    return hashlib.sha256(file.read_bytes()).hexdigest()


def names(folder, start):
    return sorted(file.name for file in folder.glob(f"{start}*"))


class Recordings(unittest.TestCase):
    arguments = None

    def setUp(self):
        self.tools, self.made = self.arguments.tools, self.arguments.made
        self.folder = self.arguments.out / self.id().rpartition(".")[2]
        self.folder.mkdir()
        script = self.folder / "script"
        script.write_text("")
        os.environ["HOUGHSTREAM_VIRTUAL_CAMERA"] = str(script)

    def camera(self, *words):
        return (self.tools / "hs-capture", "--source", "openni2", *words)

    def test_a_killed_log(self):
        log = self.folder / "take.lcmlog"
        size = kill_when(Process(self.folder, *self.camera("--log", log)), self.folder / "take.lcmlog.partial", 1_000_000)
        again = run(*self.camera("--frames", 5, "--log", log))
        interrupted = self.folder / "take.interrupted-1.lcmlog"
        self.assertEqual(names(self.folder, "take"), ["take.interrupted-1.lcmlog", "take.lcmlog"])
        self.assertEqual(interrupted.stat().st_size, size)
        self.assertIn(str(interrupted), again.stderr)
        self.assertEqual(len(list(read_log(log))), 5)
        info = run(self.tools / "hs-log", "info", interrupted, good=False)
        found = re.search(r"OPENNI_FRAME\s+images_t \(bot_core\)\s+(\d+)", info.stdout)
        self.assertTrue(found and int(found[1]) >= 5, info)

    def test_a_second_log(self):
        log = self.folder / "take.lcmlog"
        for _ in range(3):
            result = run(*self.camera("--frames", 3, "--log", log))
        self.assertEqual(names(self.folder, "take"), ["take.lcmlog", "take_2.lcmlog", "take_3.lcmlog"])
        self.assertIn("3 frames of", result.stderr)
        self.assertIn(f"to {self.folder / 'take_3.lcmlog'}", result.stderr)
        first, second = digest(log), digest(self.folder / "take_2.lcmlog")
        run(*self.camera("--frames", 2, "--log", log, "--replace"))
        self.assertNotEqual(digest(log), first)
        self.assertEqual(len(list(read_log(log))), 2)
        self.assertEqual(digest(self.folder / "take_2.lcmlog"), second)

    def test_a_killed_oni(self):
        oni = self.folder / "take.oni"
        partial = self.folder / "take.oni.partial.oni"
        size = kill_when(Process(self.folder, *self.camera("--record", oni)), partial, 20_000_000)
        run(self.tools / "hs-log", "repair", partial, self.folder / "repaired.oni")
        run(*self.camera("--frames", 40, "--record", oni))
        interrupted = self.folder / "take.interrupted-1.oni"
        self.assertEqual(names(self.folder, "take"), ["take.interrupted-1.oni", "take.oni"])
        self.assertGreater(interrupted.stat().st_size, size - 2_000_000, "more than the last image is gone")
        for file, least in ((interrupted, 15), (oni, 20), (self.folder / "repaired.oni", 15)):
            played = self.folder / f"{file.stem}.lcmlog"
            run(self.tools / "hs-capture", "--source", f"oni:{file}", "--log", played)
            self.assertGreaterEqual(len(list(read_log(played))), least, file)

    def test_a_second_oni(self):
        oni = self.folder / "take.oni"
        run(*self.camera("--frames", 30, "--record", oni))
        first = digest(oni)
        run(*self.camera("--frames", 30, "--record", oni))
        self.assertEqual(names(self.folder, "take"), ["take.oni", "take_2.oni"])
        self.assertEqual(digest(oni), first)
        size = oni.stat().st_size
        run(*self.camera("--frames", 15, "--record", oni, "--replace"))
        self.assertEqual(names(self.folder, "take"), ["take.oni", "take_2.oni"])
        self.assertLess(oni.stat().st_size, size, "the old recording still stands there")

    def test_results_of_a_log(self):
        frames, results = self.folder / "frames.lcmlog", self.folder / "found.lcmlog"
        run(self.tools / "hs-capture", "--source", f"bop:{self.made / 'scene'}", "--frames", 2, "--log", frames)
        detect = (self.tools / "hs-detect", "--forest", self.made / "small.forest", "-l", f"file://{frames}", "--output-log", results)
        run(*detect)
        (self.folder / "found_2.lcmlog.partial").write_bytes(b"of a killed one")
        run(*detect, "--keep-frames")
        self.assertEqual(names(self.folder, "found"), ["found.lcmlog", "found_2.interrupted-1.lcmlog", "found_2.lcmlog"])
        self.assertLess(results.stat().st_size, (self.folder / "found_2.lcmlog").stat().st_size)
        run(*detect, "--keep-frames", "--replace")
        self.assertEqual(results.stat().st_size, (self.folder / "found_2.lcmlog").stat().st_size)

    def start_view(self, *words):
        view = Process(self.folder, self.tools / "hs-view", "--rate", 10, *words, name=f"view{len(names(self.folder, 'view'))}")
        view.wait_until_ready()
        return view

    def test_a_video(self):
        video = self.folder / "take.mp4"
        capture = Process(self.folder, self.tools / "hs-capture", "--source", f"bop:{self.made / 'scene'}", "--loop", "--rate", 10)
        try:
            (self.folder / "take.mp4.partial.mkv").write_bytes(b"of a killed one")
            view = self.start_view("--video", video)
            wait_for_bytes(self.folder / "take.interrupted-1.mkv", 1)
            view.stop(4 * SECONDS)  # a busy machine encodes slowly
            second = self.start_view("--video", video)
            wait_for_bytes(self.folder / "take_2.mp4.partial.mkv", 0)
            second.stop(4 * SECONDS)  # a busy machine encodes slowly
        finally:
            capture.kill()
        self.assertEqual(names(self.folder, "take"), ["take.interrupted-1.mkv", "take.mp4", "take_2.mp4"])
        self.assertRegex(view.log.read_text(), "take.mp4: the end of the video is being written")
        self.assertRegex(view.log.read_text(), r"take.mp4: the video is whole, \d+ frames; its end took [\d.]+ s")
        self.assertIn(b"moov", video.read_bytes())

    def test_images_that_are_there(self):
        """Each run of hs-capture sends frames of the same times."""
        images = self.folder / "pictures"
        send = (self.tools / "hs-capture", "--source", f"bop:{self.made / 'scene'}", "--frames", 20, "--rate", 10)
        for wanted in (r"\d+\.jpg", r"\d+_2\.jpg"):
            before = {name: digest(images / name) for name in names(images, "")}
            view = self.start_view("--pictures", images)
            run(*send)
            end = time.monotonic() + SECONDS
            while not any(re.fullmatch(wanted, name) for name in names(images, "")):
                assert time.monotonic() < end, f"no {wanted} in {names(images, '')}"
                time.sleep(0.1)
            view.stop(SECONDS)
            self.assertEqual(before, {name: digest(images / name) for name in before})


def main():
    enter_private_network()
    Recordings.arguments = read_arguments(__doc__, made="what end_to_end_test.py has made")
    return not unittest.main(argv=sys.argv[:1], exit=False).result.wasSuccessful()


if __name__ == "__main__":
    sys.exit(main())
