"""Two cameras, a detector for each on hosts of their own: network namespaces joined by a cable.

Host A publishes both cameras' frames and detects in the first one's; host B detects in the second one's. What A hears of
both detectors must be what each gives offline. Uses what end_to_end_test.py has made.
"""

import os
import subprocess
import sys
import time

from folders import read_arguments
from studies.stream import Process
from end_to_end_test import THRESHOLD
from studies.lcm_log import Wire, detections_by_utime, detections_of, read_log, utime_of

URL = "udpm://239.255.76.67:7667?ttl=1"  # one hop: to the other end of the cable
CHANNELS = {"A": "CAMERA_A", "B": "CAMERA_B"}
RATE = 4


def enter_own_namespace():
    """Starts this script again where it may make networks; says so and passes where that is not allowed."""
    if os.environ.get("HOUGHSTREAM_TWO_HOSTS"):
        return
    if subprocess.run(["unshare", "-rn", "ip", "link", "add", "end_a", "type", "veth", "peer", "name", "end_b"],
                      capture_output=True, check=False).returncode != 0:
        print("skipped: no network namespaces or no veth here")
        sys.exit(77)
    environment = dict(os.environ, HOUGHSTREAM_TWO_HOSTS="1", LCM_DEFAULT_URL=URL)
    sys.exit(subprocess.run(["unshare", "-rn", sys.executable, *sys.argv], env=environment, check=False).returncode)


def ip(*words, host=()):
    subprocess.run([*host, "ip", *words], check=True)


class HostB:
    """A second network namespace at the other end of a cable, as long as a process holds it open."""

    def __init__(self):
        self.holder = subprocess.Popen(["unshare", "-n", "sleep", "600"])
        self.enter = ("nsenter", "-t", str(self.holder.pid), "-n")
        own = os.readlink("/proc/self/ns/net")
        while os.readlink(f"/proc/{self.holder.pid}/ns/net") == own:
            time.sleep(0.01)
        ip("link", "add", "cable_a", "type", "veth", "peer", "name", "cable_b")
        ip("link", "set", "cable_b", "netns", str(self.holder.pid))
        for name, address, host in (("cable_a", "10.77.0.1/24", ()), ("cable_b", "10.77.0.2/24", self.enter)):
            ip("link", "set", "lo", "up", host=host)
            ip("address", "add", address, "dev", name, host=host)
            ip("link", "set", name, "up", host=host)
            ip("route", "add", "224.0.0.0/4", "dev", name, host=host)

    def close(self):
        self.holder.kill()
        self.holder.wait()


def start(folder, *command):
    folder.mkdir()
    process = Process(folder, *command)
    process.wait_until_ready()
    return process


def start_detector(tools, made, folder, channel, host=()):
    return start(folder, *host, tools / "hs-detect", "--forest", made / "small.forest", "--threads", 1,
                 "--threshold", THRESHOLD, "-c", channel)


def publish_cameras(tools, made):
    """Both cameras at once, each the same scene."""
    commands = [[tools / "hs-capture", "--source", f"bop:{made / 'scene'}", "--rate", RATE, "-c", channel]
                for channel in CHANNELS.values()]
    captures = [subprocess.Popen([str(part) for part in command]) for command in commands]
    for capture in captures:
        assert capture.wait(60) == 0, capture.args


def heard_of(recorded):
    """Detections by the channel of their frames and utime."""
    heard = {channel: {} for channel in CHANNELS.values()}
    for _, channel, data in read_log(recorded):
        if channel == "HOUGHSTREAM_DETECTIONS":
            wire = Wire(data)
            wire.read("q")
            heard[wire.text()][utime_of(data)] = detections_of(data)
    return heard


def stream(tools, made, folder, host_b):
    recorded = folder / "recorded.log"
    logger = subprocess.Popen(["lcm-logger", "-f", "-q", "-c", "HOUGHSTREAM_.*", str(recorded)], stderr=subprocess.DEVNULL)
    detectors = []
    try:
        detectors.append(start_detector(tools, made, folder / "a", CHANNELS["A"]))
        detectors.append(start_detector(tools, made, folder / "b", CHANNELS["B"], host_b.enter))
        publish_cameras(tools, made)
        time.sleep(1.0)
        for detector in detectors:
            detector.stop()
    finally:
        for detector in detectors:
            detector.kill()
        logger.terminate()
        logger.wait()
    return heard_of(recorded)


def main():
    enter_own_namespace()
    arguments = read_arguments(__doc__, made="what end_to_end_test.py has made")
    tools, made, folder = arguments.tools, arguments.made, arguments.out
    offline = detections_by_utime(read_log(made / "results.log"))
    host_b = HostB()
    try:
        heard = stream(tools, made, folder, host_b)
    finally:
        host_b.close()
    for channel, detections in heard.items():
        assert detections, f"{channel}: nothing was heard"  # how many depends on how busy the machine is
        for utime, found in detections.items():
            assert found == offline[utime], (channel, utime)
        print(f"{channel}: {len(detections)} of {len(offline)} frames, detections as offline")


if __name__ == "__main__":
    sys.exit(main())
