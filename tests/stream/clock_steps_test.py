"""The host's clock is set back by an hour and forward again, while a camera runs: virtual camera -> OpenNI2 -> hs-capture ->
hs-detect --looks-per-second -> hs-pose --follow -> hs-track. Detections, poses and objects go on, and keep their numbers.

Every process sees the clock that settable_clock.cpp lets a test set; the recorder does not.
"""

import os
import statistics
import struct
import subprocess
import sys
import time

from folders import read_arguments
from result_values import detections_of, poses_of
from houghstream import objects_t
from houghstream.event_log import read_log
from studies.wire_patch import utime_of
from studies.stream import Process, enter_private_network
from end_to_end_test import THRESHOLD, VALID
from live_stream import camera_option, wait_for_results, write_script
from still_scene import make_fullest_scene

HOUR_S = 3600
STEPS = (0, -HOUR_S, 0)  # what the clock is ahead of the true one, part by part
PART_S = 6.0
LOOKS = 5  # a second
RATE_HZ = 10  # of the camera
WITHIN_S = 2.0
LEAST = 4  # results of each kind in a part, however busy this machine is
CHANNELS = {"detections": "HOUGHSTREAM_DETECTIONS", "poses": "HOUGHSTREAM_POSES", "objects": "HOUGHSTREAM_OBJECTS"}


class Clock:
    """The clock that the processes take for the host's."""

    def __init__(self, file):
        self.file = file
        self.set(0)

    def set(self, ahead_s):
        """In place: the processes have the file's memory."""
        with open(self.file, "r+b" if self.file.exists() else "w+b") as out:
            out.write(struct.pack("=q", ahead_s))


def start(arguments, scene, clock):
    folder, made = arguments.out, arguments.made
    script = folder / "camera_script"
    write_script(script, f"scene {scene}\nrate_hz {RATE_HZ}\n")
    environment = {"LD_PRELOAD": str(arguments.clock), "HOUGHSTREAM_SETTABLE_CLOCK": str(clock.file),
                   "HOUGHSTREAM_VIRTUAL_CAMERA": str(script), "LD_LIBRARY_PATH": str(arguments.tools.parent / "virtual_camera")}  # fmt: skip
    models = ("--models", made / "views" / "models")
    commands = (
        ("hs-detect", "--forest", made / "small.forest", "--threshold", THRESHOLD, "--looks-per-second", LOOKS),
        ("hs-pose", *models, "--follow"),
        ("hs-track", *models),
        ("hs-capture", "--source", "openni2", "--mode", f"640x480@{RATE_HZ}", "--camera", camera_option(scene)),
    )
    processes = []
    for name, *words in commands:
        processes.append(Process(folder, arguments.tools / name, *words, **environment))
        if name != "hs-capture":
            processes[-1].wait_until_ready(60)
    return processes


def found_in(kind, data):
    """Returns how many objects a message has found."""
    if kind == "detections":
        return len(detections_of(data))
    if kind == "poses":
        return sum(pose.status == VALID for pose in poses_of(data))
    return len(objects_t.decode(data).objects)


def run(arguments):
    """Returns the recorded events, and when each part began on the true clock, microseconds."""
    recorded, begins = arguments.out / "recorded.log", []
    clock = Clock(arguments.out / "clock")
    scene = make_fullest_scene(arguments.made, arguments.out / "scene")
    logger = subprocess.Popen(["lcm-logger", "-f", "-q", "--flush-interval=1", "-c", "|".join(CHANNELS.values()), str(recorded)],
                              stderr=subprocess.DEVNULL)  # fmt: skip
    processes = []
    try:
        processes = start(arguments, scene, clock)
        wait_for_results(recorded, 3)
        for ahead_s in STEPS:
            clock.set(ahead_s)
            begins.append(int(time.time() * 1e6))
            time.sleep(PART_S)
        begins.append(int(time.time() * 1e6))
        for process in processes[::-1]:
            process.stop(10.0)
    finally:
        logger.terminate()
        logger.wait()
        for process in processes:
            process.kill()
    return list(read_log(recorded)), begins


def check_part(kind, events, part, begin, end):
    """Returns what was stamped in the time of a part: how many messages, how soon the first one that has found something, and
    how long after their stamps they came."""
    ahead_us = int(STEPS[part] * 1e6)
    stamped = [(arrival, utime_of(data) - ahead_us, found_in(kind, data)) for arrival, channel, data in events
               if channel == CHANNELS[kind] and begin <= utime_of(data) - ahead_us < end]  # fmt: skip
    useful = [utime for _, utime, found in stamped if found > 0]
    assert useful, f"{kind}: nothing of part {part}"
    late_s = statistics.median((arrival - utime) * 1e-6 for arrival, utime, _ in stamped)
    return len(stamped), (useful[0] - begin) * 1e-6, late_s


def check_numbers(events, begins):
    """The objects' numbers and the world's are what they were."""
    parts = []
    for part, ahead_s in enumerate(STEPS):
        last = [objects_t.decode(data) for _, channel, data in events
                if channel == CHANNELS["objects"] and begins[part] <= utime_of(data) - ahead_s * 1e6 < begins[part + 1]][-1]  # fmt: skip
        parts.append((last.world_number, sorted((one.class_name, one.track_id) for one in last.objects)))
    print(f"world and objects at the end of each part: {parts}")
    assert parts[0][1] and all(part == parts[0] for part in parts), parts


def main():
    enter_private_network()
    arguments = read_arguments(__doc__, made="folder of end_to_end_test.py", clock="library of settable_clock.cpp")
    os.environ["PYTHONDONTWRITEBYTECODE"] = "1"
    events, begins = run(arguments)
    for kind in CHANNELS:
        seen = [check_part(kind, events, part, begins[part], begins[part + 1]) for part in range(len(STEPS))]
        counts = [count for count, _, _ in seen]
        print(f"{kind}: {counts} in the parts of {PART_S} s, first after {[round(after, 2) for _, after, _ in seen]} s, "
              f"{[round(1e3 * late) for _, _, late in seen]} ms after their stamps")  # fmt: skip
        assert min(counts) >= LEAST, counts
        usual_s = 3.0 * PART_S / counts[0]  # where this machine is too busy for two seconds
        assert max(after for _, after, _ in seen) < max(WITHIN_S, usual_s), f"{kind}: too late after the clock was set"
    check_numbers(events, begins)
    print("clock steps: detections, poses and objects went on")


if __name__ == "__main__":
    sys.exit(main())
