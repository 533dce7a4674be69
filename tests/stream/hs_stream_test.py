"""hs-stream with the real processes: what is killed or hangs comes back, Ctrl-C and even a killed hs-stream leave nothing behind.

Takes the forest, models and scene that end_to_end_test.py has made.
"""

import os
import pathlib
import re
import signal
import subprocess
import sys
import time

from folders import read_arguments
from houghstream import status_t
from houghstream.event_log import read_log
from studies.stream import enter_private_network

NAMES = ["detect", "pose", "view", "capture"]


class Stream:
    """hs-stream in the background; its log and its processes'."""

    def __init__(self, tools, made, folder, name, forest="small.forest"):
        self.log = folder / f"{name}.err"
        command = [tools / "hs-stream", "--source", f"bop:{made / 'scene'}", "--capture-options=--loop --rate 5",
                   "--forest", made / forest, "--models", made / "views" / "models", "--every", "0.5", "--hang-patience", "4",
                   f"--view-options=--video {folder / name}.mp4"]
        with open(self.log, "w", encoding="utf-8") as log:
            self.process = subprocess.Popen([str(word) for word in command], stderr=log, stdout=subprocess.DEVNULL)

    def find(self, pattern, seconds):
        """The last match in the log, waiting for it."""
        end = time.monotonic() + seconds
        while True:
            found = re.findall(pattern, self.log.read_text())
            if found:
                return found[-1]
            assert time.monotonic() < end, f"no '{pattern}' in\n{self.log.read_text()}"
            time.sleep(0.05)

    def pids(self):
        return {name: int(self.find(rf"{name} started, process (\d+)", 30)) for name in NAMES}


def is_alive(pid):
    """Returns whether the process runs; one that only waits for its burial does not."""
    try:
        return pathlib.Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] not in "ZX"
    except FileNotFoundError:
        return False


def wait_until_gone(pids, seconds):
    end = time.monotonic() + seconds
    while any(is_alive(pid) for pid in pids):
        assert time.monotonic() < end, f"still there: {[pid for pid in pids if is_alive(pid)]}"
        time.sleep(0.02)


def check_restart_and_stop(tools, made, folder):
    stream = Stream(tools, made, folder, "restart")
    before = stream.pids()
    stream.find(r"detect [1-9.]+\d* Hz \d+ ms.* \| capture [1-9.]+\d* Hz", 30)
    os.kill(before["detect"], signal.SIGKILL)
    stream.find(r"detect was killed by signal 9 \(Killed\); starts again at once", 5)
    stream.find(r"detect [1-9.]+\d* Hz \d+ ms[^|]*\(restarts: 1\)", 30)
    after = stream.pids()
    assert after["detect"] != before["detect"] and not is_alive(before["detect"]), (before, after)
    assert all(after[name] == before[name] for name in NAMES if name != "detect"), "the others were left alone"
    os.kill(after["detect"], signal.SIGSTOP)
    stream.find(r"detect has said nothing for 4.0 s: it hangs and is ended", 10)
    stream.find(r"detect hung and was killed by signal 9 \(Killed\); starts again (at once|in 0.\d+ s)", 10)
    stream.find(r"detect [1-9.]+\d* Hz \d+ ms[^|]*\(restarts: 2\)", 30)
    hung, after = after["detect"], stream.pids()
    assert after["detect"] != hung and not is_alive(hung), (hung, after)
    start = time.monotonic()
    stream.process.send_signal(signal.SIGINT)
    assert stream.process.wait(20) == 0, stream.log.read_text()
    took = time.monotonic() - start
    print(f"all ended {took:.2f} s after Ctrl-C")
    words = stream.log.read_text()
    assert "view did not end" not in words, words
    assert re.search(r"restart.mp4: the video is whole, \d+ frames; its end took [\d.]+ s", words), words
    assert b"moov" in (folder / "restart.mp4").read_bytes(), "an MP4 without its index cannot be played"
    assert not any(is_alive(pid) for pid in after.values())


def check_killed_supervisor(tools, made, folder):
    stream = Stream(tools, made, folder, "killed")
    pids = stream.pids()
    stream.find(r"detect [1-9.]+\d* Hz", 30)
    stream.process.kill()
    stream.process.wait()
    wait_until_gone(pids.values(), 20)


def check_bad_start(tools, made, folder):
    """A forest that is not there: one try, one line that says so, a failure."""
    stream = Stream(tools, made, folder, "bad", forest="missing.forest")
    assert stream.process.wait(20) == 1, stream.log.read_text()
    words = stream.log.read_text()
    assert "detect ended with status 1 at its start" in words and str(made / "missing.forest") in words, words
    assert words.count("detect started") == 1, words
    assert "capture started" not in words, words
    wait_until_gone([int(pid) for pid in re.findall(r"started, process (\d+)", words)], 1)


def check_short_scene(tools, made, folder):
    """The source waits until the others hear it, and they for its last frames: of two frames none is lost or passed over."""
    seen = folder / "short.log"
    logger = subprocess.Popen(["lcm-logger", "-f", "-q", "-c", "HOUGHSTREAM_STATUS", str(seen)], stderr=subprocess.DEVNULL)
    command = [tools / "hs-stream", "--source", f"bop:{made / 'scene'}", "--capture-options=--frames 2 --rate 1", "--forest",
               made / "small.forest", "--no-view"]  # fmt: skip
    subprocess.run([str(word) for word in command], check=True, timeout=120, capture_output=True)
    time.sleep(0.5)
    logger.terminate()
    logger.wait()
    states = [status_t.decode(event.data) for event in read_log(seen)]
    received = max(state.frames_received for state in states if state.process == "hs-detect")
    assert received == 2, received
    processed = max(state.frames_processed for state in states if state.process == "hs-detect")
    assert processed == 2, processed


def main():
    enter_private_network()
    arguments = read_arguments(__doc__, made="what end_to_end_test.py has made")
    tools, made, folder = arguments.tools, arguments.made, arguments.out
    check_restart_and_stop(tools, made, folder)
    check_killed_supervisor(tools, made, folder)
    check_bad_start(tools, made, folder)
    check_short_scene(tools, made, folder)


if __name__ == "__main__":
    sys.exit(main())
