"""Two cameras, a detector for each on hosts of their own: network namespaces at a switch.

Host A publishes both cameras' frames and detects in the first one's; host B detects in the second one's. What A hears of
both detectors must be what each gives offline. Uses what end_to_end_test.py has made.
"""

import os
import subprocess
import sys
import time

from folders import read_arguments
from result_values import detections_by_utime, detections_of
from houghstream.event_log import read_log
from studies.wire_patch import frame_of
from studies.network import URL, Network
from studies.stream import Process
from end_to_end_test import THRESHOLD

CHANNELS = {"A": "CAMERA_A", "B": "CAMERA_B"}
RATE = 4


def enter_own_namespace():
    """Starts this script again where it may make networks; says so and passes where that is not allowed."""
    if os.environ.get("HOUGHSTREAM_TWO_HOSTS"):
        return
    if subprocess.run(["unshare", "-rn", "sh", "-c", "ip link add end_a type veth peer name end_b && ip link add switch type bridge"],
                      capture_output=True, check=False).returncode != 0:
        print("skipped: no network namespaces, veth or bridge here")
        sys.exit(77)
    environment = dict(os.environ, HOUGHSTREAM_TWO_HOSTS="1", LCM_DEFAULT_URL=URL)
    sys.exit(subprocess.run(["unshare", "-rn", sys.executable, *sys.argv], env=environment, check=False).returncode)


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
            camera, utime = frame_of(data)
            heard[camera][utime] = detections_of(data)
    return heard


def stream(tools, made, folder, network):
    recorded = folder / "recorded.log"
    logger = subprocess.Popen(["lcm-logger", "-f", "-q", "-c", "HOUGHSTREAM_.*", str(recorded)], stderr=subprocess.DEVNULL)
    detectors = []
    try:
        detectors.append(start_detector(tools, made, folder / "a", CHANNELS["A"]))
        detectors.append(start_detector(tools, made, folder / "b", CHANNELS["B"], network.enter("b")))
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
    first, recorded = min(offline), [offline[utime] for utime in sorted(offline)]
    with Network("b") as network:
        heard = stream(tools, made, folder, network)
    for channel, detections in heard.items():
        assert detections, f"{channel}: nothing was heard"  # how many depends on how busy the machine is
        for utime, found in detections.items():  # stamps are those of the rate at which frames were sent
            assert found == recorded[round((utime - first) * RATE / 1e6)], (channel, utime)
        print(f"{channel}: {len(detections)} of {len(offline)} frames, detections as offline")


if __name__ == "__main__":
    sys.exit(main())
