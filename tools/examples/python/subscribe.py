#!/usr/bin/python3
"""Prints poses as they come, and how far the middle of the image is. Needs LCM's Python module; a line says how to get it."""

import signal
import sys

from houghstream import object_pose_t, object_poses_t
from houghstream.frames import decode_frame
from houghstream.subscriber import subscribe

signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # who reads the lines may have enough, as head


def print_message(channel, data):
    if channel == "HOUGHSTREAM_POSES":
        for pose in object_poses_t.decode(data).poses:
            if pose.status == object_pose_t.VALID:
                print(pose.class_name, *(f"{value:.3f}" for value in pose.trans), flush=True)
    else:
        frame = decode_frame(data)  # colour: height x width x 3, depth: height x width in metres, both numpy
        height, width = frame.depth.shape
        print(f"{frame.utime}: {frame.depth[height // 2, width // 2]:.3f} m", flush=True)


try:
    subscribe("HOUGHSTREAM_POSES|OPENNI_FRAME", print_message)
except ImportError as error:
    sys.exit(f"subscribe.py: {error}")
