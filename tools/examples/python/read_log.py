#!/usr/bin/python3
"""Prints the poses of a log, and draws how each object moved: read_log.py LOG [PLOT.png]. Needs no lcm module."""

import signal
import sys

from houghstream import object_pose_t, object_poses_t
from houghstream.event_log import read_log

signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # who reads the lines may have enough, as head

if len(sys.argv) not in (2, 3):
    sys.exit("read_log.py: expected LOG [PLOT.png]")

tracks = {}
try:
    for event in read_log(sys.argv[1]):
        if event.channel != "HOUGHSTREAM_POSES":
            continue
        message = object_poses_t.decode(event.data)
        for pose in message.poses:
            if pose.status != object_pose_t.VALID:
                continue
            x, y, z = pose.trans
            print(f"{message.utime} {pose.class_name:<20} at {x:.3f} {y:.3f} {z:.3f} m, quality {pose.quality:.2f}")
            tracks.setdefault(pose.class_name, []).append((1e-6 * message.utime, z))
except (OSError, ValueError) as error:  # no such log, or one that is damaged or cut: what was whole has been printed
    sys.exit(f"read_log.py: {error}")

if len(sys.argv) > 2:
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    for name, points in tracks.items():
        pyplot.plot(*zip(*points), ".", label=name)
    pyplot.xlabel("time, s")
    pyplot.ylabel("distance, m")
    pyplot.legend()
    pyplot.savefig(sys.argv[2])
