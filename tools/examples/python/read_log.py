#!/usr/bin/python3
"""Prints the poses of a log, and draws how each object moved: read_log.py LOG [PLOT.png]. Needs no lcm module."""

import sys

from houghstream import object_pose_t, object_poses_t
from houghstream.event_log import read_log

tracks = {}
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
