#!/usr/bin/python3
"""Finds a store's objects in an image, without LCM: find_in_images.py STORE COLOUR DEPTH FX,FY,CX,CY. Depth: 16 bits, millimetres."""

import sys

import numpy
from houghstream import Camera, ObjectFinder
from PIL import Image

if len(sys.argv) != 5:
    sys.exit("find_in_images.py: expected STORE COLOUR DEPTH FX,FY,CX,CY")

try:
    finder = ObjectFinder(sys.argv[1])
    colour = numpy.asarray(Image.open(sys.argv[2]).convert("RGB"))
    depth = numpy.asarray(Image.open(sys.argv[3])).astype(numpy.uint16)
    found = finder.find(colour, depth, Camera(*map(float, sys.argv[4].split(","))))
except (OSError, ValueError, TypeError) as error:
    sys.exit(f"find_in_images.py: {error}")

for pose in found:
    place = " ".join(f"{value:.3f}" for value in pose.position)
    print(f"{pose.name:<20} score {pose.score:.2f}, at {place} m, quality {pose.quality:.2f}")
for entry in found.without_pose:
    print(f"{entry.name:<20} score {entry.score:.2f}, {entry.status}")
