"""Options of tools/bench teach. What they ask for is in plan.py, what comes of it in report.py."""

import pathlib

from studies.command import Options, positive, some_of
from studies.stream import enter_private_network
from studies.unit_runner import main

# As hs-render takes orders them; those of the scenes objects_20_b, _d and _f.
OBJECTS = ("bowl", "cereal_box", "coffee_mug", "soda_can", "teapot", "tumbler", "shampoo_bottle", "food_tin", "tea_box",
           "office_stapler", "toy_truck", "flashlight")  # fmt: skip
QUICK = ("cereal_box", "coffee_mug")
TARGETS = ("hs-render", "hs-teach", "hs-evaluate", "hs-study", "hs-capture", "hs-detect", "hs-pose",
           "hs-observe")  # fmt: skip


def parse(words):
    parser = Options("bench teach", "Renders recordings of twelve objects that are shown to a camera (carried by hand round "
                                    "a table, before a turntable, turned by a hand; each twice, upright and laid down), "
                                    "shows them to hs-teach, compares models, masks and camera poses with the truth, and "
                                    "finds the objects in rendered scenes beside those taught from their true "
                                    "meshes.")  # fmt: skip
    add = parser.add_argument
    add("--quick", action="store_true", help="two objects, one take of each, fewer frames to look for them in")
    add("--objects", type=some_of(OBJECTS, "object"), metavar="NAMES", help="of the twelve, separated by commas; default all")
    add("--takes", type=int, choices=(1, 2), help="1: upright only, 2: the object laid down as well (default 2)")
    add("--frames", type=positive, metavar="N", help="of a take, a closed turn at 15 Hz (default 240)")
    add("--every", type=positive, metavar="N", help="look for the objects in every Nth of a scene's 120 frames (default 2)")
    add("--world", type=int, default=0, metavar="N", help="another set of rooms and movements (default 0)")
    add("--development", action="store_true", help="rooms and scenes to choose settings on, instead of those that are "
        "measured with")  # fmt: skip
    add("--no-stream", dest="stream", action="store_false", help="teach nothing in a running stream")
    add("--out", type=pathlib.Path, default="out/teach", metavar="DIR", help="default out/teach")
    add("--fresh", action="store_true", help="render and teach again even where nothing has changed")
    options = parser.parse_args(words)
    options.objects = options.objects or (QUICK if options.quick else OBJECTS)
    options.takes = options.takes or (1 if options.quick else 2)
    options.frames = options.frames or 240
    options.every = options.every or (6 if options.quick else 2)
    options.out = options.out.resolve()
    return options


def network(options):
    return enter_private_network() if options.stream else None


if __name__ == "__main__":
    main(parse, lambda _: TARGETS, network, "studies.teach.report")
