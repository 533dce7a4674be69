"""Faults of the programs that record: what was recorded stays and can be read."""

import os
import re
import signal
import subprocess
import time

from studies.soak.faults import HEARD, Faults, said
from studies.soak.wire import bus
from studies.stream import Process, virtual_camera_of

KILLS = 3


def atoms(video):
    """The parts of an MP4, whose lengths must add up to the file's; None where they do not."""
    data, found, at = video.read_bytes(), [], 0
    while at + 8 <= len(data):
        found.append(data[at + 4 : at + 8].decode(errors="replace"))
        length = int.from_bytes(data[at : at + 4], "big")
        at += int.from_bytes(data[at + 8 : at + 16], "big") if length == 1 else max(length, 8)
    return found if at == len(data) else None


class RecordingFaults(Faults):
    """Each function is one fault; it returns what it saw, with "good"."""

    def wait_for_bytes(self, process, file, size, seconds=60):
        end = time.monotonic() + seconds
        while not (file.exists() and file.stat().st_size >= size):
            if not process.runs() or time.monotonic() > end:
                process.fail(f"has not written {size} bytes to {file}")
            time.sleep(0.02)

    def frames_in(self, folder, recording):
        """Returns how many frames a recording holds, as hs-log reads them; None where it reads none."""
        log = folder / f"{recording.name}.read"
        source = ["import", recording, log] if recording.suffix == ".oni" else ["filter", recording, log]
        subprocess.run([self.programs / "hs-log", *source], capture_output=True, text=True, timeout=300, check=False)
        if not log.exists():
            return None
        info = subprocess.run([self.programs / "hs-log", "info", log], capture_output=True, text=True, timeout=300, check=False)
        log.unlink()
        return sum(map(int, re.findall(r"images_t \(bot_core\) +(\d+)", info.stdout))) or None

    def killed_log(self):
        """hs-capture --log is killed again and again and started with the same words."""
        folder = self.folder("killed_log")
        log, partial = folder / "take.lcmlog", folder / "take.lcmlog.partial"
        words = [self.programs / "hs-capture", "--source", f"bop:{self.data / 'scene'}", "--loop", "--log", log]
        sizes = []
        kept = [folder / f"take.interrupted-{number + 1}.lcmlog" for number in range(KILLS)]
        for kill in range(KILLS):
            process = Process(folder, *words, "--frames", 1_000_000)
            try:
                if kill > 0:
                    self.wait_for_bytes(process, kept[kill - 1], 1)
                self.wait_for_bytes(process, partial, 2_000_000)
                process.process.send_signal(signal.SIGKILL)
                process.process.wait()
            finally:
                process.kill()
            sizes.append(partial.stat().st_size)
        subprocess.run([str(word) for word in (*words, "--frames", 10)], check=True, capture_output=True, timeout=60)
        frames = [self.frames_in(folder, file) for file in (*kept, log)]
        return {"bytes": sizes, "frames": frames,
                "good": [file.stat().st_size for file in kept if file.exists()] == sizes and None not in frames and frames[-1] == 10}  # fmt: skip

    def killed_oni(self):
        """hs-stream's hs-capture --record is killed again and again, and comes back by itself."""
        folder = self.folder("killed_oni")
        script = folder / "script"
        script.write_text(f"scene {self.data / 'scene'}\n")
        camera = {"LD_LIBRARY_PATH": virtual_camera_of(self.programs), "HOUGHSTREAM_VIRTUAL_CAMERA": str(script)}
        partial = folder / "take.oni.partial.oni"
        stream = Process(folder, self.programs / "hs-stream", "--source", "openni2", "--forest", self.data / "forest",
                         "--no-view", f"--capture-options=--record {folder / 'take.oni'} --replace", "-l", bus(HEARD),
                         **camera)  # fmt: skip
        try:
            for kill in range(KILLS):
                pid = int(self.wait_for(stream, r"capture started, process (\d+)(?![\s\S]*capture was killed)", 60).group(1))
                self.wait_for_bytes(stream, partial, 30_000_000)
                os.kill(pid, signal.SIGKILL)
                self.wait_for(stream, r"interrupted-%d.oni: is ended and can be played" % (kill + 1), 60)
            self.wait_for_bytes(stream, partial, 30_000_000)
            stream.stop(60)
        finally:
            stream.kill()
        kept = [folder / f"take.interrupted-{number + 1}.oni" for number in range(KILLS)]
        frames = [self.frames_in(folder, file) for file in (*kept, folder / "take.oni")]
        return {"frames": frames, "reported": said(stream, "interrupted|can be played"), "good": None not in frames}

    def killed_video(self):
        """hs-view is killed over its video; after that Ctrl-C ends the stream, which waits for the video's end."""
        folder = self.folder("killed_video")
        video, partial = folder / "seen.mp4", folder / "seen.mp4.partial.mkv"
        kept = [folder / f"seen.interrupted-{number}.mkv" for number in (1, 2)]
        stream = Process(folder, self.programs / "hs-stream", "--source", f"bop:{self.data / 'scene'}", "--capture-options=--loop",
                         "--forest", self.data / "forest", f"--view-options=--video {video}", "-l", bus(HEARD))  # fmt: skip
        try:
            for file in kept:
                pid = int(self.wait_for(stream, r"view started, process (\d+)(?![\s\S]*view was killed)", 60).group(1))
                self.wait_for_bytes(stream, partial, 100_000, 300)
                os.kill(pid, signal.SIGKILL)
                self.wait_for_bytes(stream, file, 100_000, 120)
            start = time.monotonic()
            stream.stop(120)
            took = time.monotonic() - start
        finally:
            stream.kill()
        parts = atoms(video) if video.exists() else None
        return {"ended_after_s": round(took, 1), "parts": parts, "bytes": [file.stat().st_size for file in kept if file.exists()],
                "reported": said(stream, "the video is whole|waiting for|killed"),
                "good": all(file.exists() and file.stat().st_size >= 100_000 for file in kept) and "moov" in (parts or [])}  # fmt: skip

    def all(self):
        yield "a log's recorder killed (kill -9)", self.killed_log
        yield "a camera's recorder killed (kill -9)", self.killed_oni
        yield "a video's recorder killed (kill -9), Ctrl-C", self.killed_video
