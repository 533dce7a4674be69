#!/usr/bin/python3
"""Prints where objects are as a stream says it, or a log: listen.py [URL], file://LOG for a log. Ctrl-C ends it."""

import signal
import sys

from houghstream import FoundPoses, InputError, listen

signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # who reads the lines may have enough, as head

try:
    for result in listen(*sys.argv[1:2]):
        kind = "camera" if isinstance(result, FoundPoses) else result.world
        for entry in result:
            x, y, z = entry.position
            print(f"{result.utime} {entry.name:<20} at {x:.3f} {y:.3f} {z:.3f} m in {kind}", flush=True)
except InputError as error:
    sys.exit(f"listen.py: {error}")
except KeyboardInterrupt:
    pass
