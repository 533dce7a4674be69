"""Frames that come out of their order to hs-pose --follow: a pair that is swapped, one that comes a second late, and one with
a wrong stamp cost the poses of one frame each at most, and no object. Poses are counted, not frames: one frame after the
other is sent, and its poses are waited for."""

import os
import re
import subprocess
import sys

from folders import read_arguments
from result_values import poses_of
from studies.soak.frames import FrameSender
from studies.soak.wire import Listener
from studies.stream import Process, enter_private_network
from end_to_end_test import THRESHOLD, VALID
from still_scene import make_fullest_scene

PERIOD_US = 33_333
YEAR = 8760 * 3600 * 30  # in frames
POSES, DETECTIONS = "HOUGHSTREAM_POSES", "HOUGHSTREAM_DETECTIONS"
PATIENCE_S = 60.0
FIRST_US = 1_700_000_000_000_000

# Numbers of frames in the order of their arrival; how many frames have no poses at most.
ORDERS = {
    "as they were taken": (range(10), 0),
    "one pair swapped": ([0, 1, 3, 2, 4, 5, 6], 1),
    "one late by 28 frames": ([0, 1, *range(3, 31), 2, 31, 32, 33], 1),
    "two pairs swapped": ([0, 2, 1, 4, 3, 5, 6], 2),
}
WRONG_STAMPS = {"a year ahead": YEAR, "a year ago": -YEAR, "five seconds ahead": 150}


def followed_in(heard):
    """Returns how many objects are followed with a valid pose; None for poses of detections."""
    poses = poses_of(heard.payload)
    return None if any(pose.detection_index >= 0 for pose in poses) else sum(pose.status == VALID for pose in poses)


def poses_of_frame(listener, utime, seconds=PATIENCE_S):
    found = listener.wait_for(POSES, lambda heard: heard.utime == utime and followed_in(heard) is not None, seconds)
    return None if found is None else followed_in(found)


def begin(sender, listener):
    """Sends the first frames, until what the detector has found in them is followed; returns how many objects."""
    for number in range(20):
        sender.send_one(number, FIRST_US + number * PERIOD_US)
        followed = poses_of_frame(listener, FIRST_US + number * PERIOD_US)
        assert followed is not None, f"no poses of frame {number}"
        if number == 0:
            assert listener.wait_for(DETECTIONS, lambda heard: True, PATIENCE_S), "no detections"
            assert listener.wait_for(POSES, lambda heard: followed_in(heard) is None, PATIENCE_S), "no answer"
        elif followed > 0:
            return followed
    raise AssertionError("nothing is followed")


def check_order(sender, listener, followed, first, order):
    """Sends frames from number `first` on in an order; returns how many had no poses. Each is waited for, but for those
    that newer ones have overtaken."""
    without, newest = 0, -1
    for number in order:
        utime = FIRST_US + (first + number) * PERIOD_US
        sender.send_one(first + number, utime)
        overtaken = number < newest
        newest = max(newest, number)
        valid = poses_of_frame(listener, utime, 0.5 if overtaken else PATIENCE_S)
        without += valid is None
        assert valid == followed or (overtaken and valid is None), f"frame {number} has {valid} poses, expected {followed}"
    return without


def check_wrong_stamp(sender, listener, followed, first, by):
    """The third of six frames has a stamp that is wrong; each has all its poses, under its stamp."""
    for number in range(6):
        utime = FIRST_US + (first + number + (by if number == 2 else 0)) * PERIOD_US
        sender.send_one(first + number, utime)
        valid = poses_of_frame(listener, utime)
        assert valid == followed, f"frame {number} has {valid} poses, expected {followed}"


def check_all(sender, listener):
    followed = begin(sender, listener)
    print(f"{followed} objects are followed")
    first = 100
    for name, (order, cost) in ORDERS.items():
        without = check_order(sender, listener, followed, first, order)
        print(f"{name}: {without} of {len(order)} frames without poses")
        assert without <= cost, name
        first += 100
    for name, by in WRONG_STAMPS.items():
        check_wrong_stamp(sender, listener, followed, first, by)
        print(f"one frame dated {name}: every frame has its poses")
        first += 100


def main():
    enter_private_network()
    arguments = read_arguments(__doc__, made="folder of end_to_end_test.py")
    folder, made, tools = arguments.out, arguments.made, arguments.tools
    scene, recording = make_fullest_scene(made, folder / "scene"), folder / "still.log"
    subprocess.run([tools / "hs-capture", "--source", f"bop:{scene}", "--log", recording], check=True)
    port = int(re.search(r":(\d+)\?", os.environ["LCM_DEFAULT_URL"]).group(1))
    listener = Listener(port, (POSES, DETECTIONS))
    processes = []
    try:
        for command in (
            ("hs-detect", "--forest", made / "small.forest", "--threshold", THRESHOLD, "--looks-per-second", 5),
            ("hs-pose", "--models", made / "views" / "models", "--follow"),
        ):
            processes.append(Process(folder, tools / command[0], *command[1:]))
            processes[-1].wait_until_ready(60)
        check_all(FrameSender(recording, port), listener)
        for process in processes[::-1]:
            process.stop(10.0)
    finally:
        listener.stop()
        for process in processes:
            process.kill()
    print("overtaken frames: none costs more than its own poses")


if __name__ == "__main__":
    sys.exit(main())
