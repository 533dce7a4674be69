"""Links 36 views a turn (paper, Section 4) of the instances that stand in imported scenes of the UW RGB-D Scenes Dataset
from the RGB-D Object Dataset (Lai et al. 2011), which has many more of both: OUT/CATEGORY/INSTANCE/INSTANCE_V_N_*."""

import collections
import json
import pathlib
import re
import sys

VIEWS_A_TURN = 36
VIEW = re.compile(r".+_\d+_(\d+)_(\d+)_crop\.png")
FILES = ("_crop.png", "_depthcrop.png", "_maskcrop.png", "_loc.txt")


def spread(items, count):
    """At most so many of them, evenly."""
    return items if len(items) <= count else [items[i * len(items) // count] for i in range(count)]


def turns(folder):
    """File names without their ending, in order, of each video: one full turn at one height."""
    found = collections.defaultdict(list)
    for file in folder.iterdir():
        if match := VIEW.fullmatch(file.name):
            found[int(match[1])].append((int(match[2]), file.name.removesuffix("_crop.png")))
    return [[stem for _, stem in sorted(views)] for views in found.values()]


def instances(scenes):
    """Names of all that stands in the scenes, by their names.json."""
    return sorted({name for scene in scenes for name in json.loads((scene / "names.json").read_text()).values()})


def link_views(objects, out, name):
    category = name.rpartition("_")[0]
    folder = objects / category / name
    if not folder.is_dir():
        sys.exit(f"uw_views.py: {folder}: not there, but a scene holds {name}")
    place = out / category / name
    place.mkdir(parents=True)
    for stems in turns(folder):
        for stem in spread(stems, VIEWS_A_TURN):
            for ending in FILES:
                (place / (stem + ending)).symlink_to((folder / (stem + ending)).resolve())


def main():
    if len(sys.argv) < 4:
        sys.exit("usage: uw_views.py OBJECTS OUT SCENE...")
    objects, out, *scenes = map(pathlib.Path, sys.argv[1:])
    for name in instances(scenes):
        link_views(objects, out, name)


if __name__ == "__main__":
    main()
