"""The parts that all faults share: the processes, and their accounts."""

import re
import shutil
import time

from studies.soak.wire import bus
from studies.stream import Process

SENT, HEARD = 7667, 7668  # ports
ACCOUNT = re.compile(r"ends: (\d+) received, (\d+) processed, (\d+) skipped, (\d+|unknown) lost, (\d+) refused"
                     r"(?:; (\d+) duplicates)?")  # fmt: skip
RESULTS = {"detect": "HOUGHSTREAM_DETECTIONS", "pose": "HOUGHSTREAM_POSES", "capture": "OPENNI_FRAME"}


def account(process):
    """Returns what a process says of its frames in the end."""
    found = ACCOUNT.search(process.log.read_text(errors="replace"))
    if not found:
        process.fail("has given no account")
    names = ("received", "processed", "skipped", "lost", "refused", "duplicates")
    return {name: int(count or 0) if count != "unknown" else 0 for name, count in zip(names, found.groups())}


def adds_up(sent, counts):
    return sent == counts["processed"] + counts["skipped"] + counts["lost"] + counts["refused"]


def said(process, pattern):
    """The lines that match, without their times; equal ones once."""
    lines = process.log.read_text(errors="replace").splitlines()
    return list(dict.fromkeys(re.sub(r"^[\d:.]+ ", "", line) for line in lines if re.search(pattern, line)))


class Faults:
    """The processes of a stream, on the demo's data."""

    def __init__(self, options, out):
        self.programs = options.programs
        self.data = options.data
        self.models = options.data / "training" / "models"
        self.recording = options.data / "stream.lcmlog"
        self.frames = options.frames
        self.objects = options.objects
        self.out = out

    def folder(self, name):
        folder = self.out / name
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        return folder

    def capture(self, folder, name, port, *words):
        return Process(folder, self.programs / "hs-capture", "--source", f"bop:{self.data / 'scene'}", "--loop", "--frames",
                       self.frames, "--rate", 30, "-l", bus(port), *words, name=name)  # fmt: skip

    def worker(self, folder, program, *words, name=None):
        """A program that hears the stream, ready; hs-detect, hs-pose and hs-track with what the demo knows. `name`: of its log."""
        models = ("--models", self.models)
        known = {"hs-detect": ("--forest", self.data / "forest"), "hs-pose": models, "hs-track": models}.get(program, ())
        process = Process(folder, self.programs / program, *known, "-l", bus(HEARD), *words, name=name)
        try:
            process.wait_until_ready(60)
        except Exception:
            process.kill()
            raise
        return process

    def stream(self, folder, *known, scene=None):
        """hs-stream with a camera; `known`: what it knows of objects, the demo's if nothing is said."""
        known = known or ("--forest", self.data / "forest", "--models", self.models)
        return Process(folder, self.programs / "hs-stream", "--source", f"bop:{scene or self.data / 'scene'}",
                       "--capture-options=--loop", *known, "--no-view", "--every", "0.5", "--hang-patience", "2",
                       "-l", bus(HEARD))  # fmt: skip

    @staticmethod
    def wait_for(process, pattern, seconds, since=0):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            found = list(re.finditer(pattern, process.log.read_text(errors="replace")[since:]))
            if found:
                return found[-1]
            if not process.runs():
                process.fail(f"has ended and not said '{pattern}'")
            time.sleep(0.02)
        process.fail(f"has not said '{pattern}' within {seconds} s")
