"""Options of tools/demo. What they ask for is in run.py."""

import os
import pathlib

from studies.command import Options, die, positive
from studies.stream import enter_network
from studies.unit_runner import main

TARGETS = ("hs-render", "hs-train", "hs-capture", "hs-detect", "hs-pose", "hs-track", "hs-view", "hs-observe",
           "hs-evaluate")  # fmt: skip
FURTHER_TARGETS = {"live": ("virtual_camera",), "teach": ("hs-teach", "hs-log", "virtual_camera"),
                   "real": ("hs-import", "hs-log"), "pictures": ("hs-spy",)}  # fmt: skip


def parse(words):
    parser = Options("demo", "Installs, builds, makes or reads data, trains, replays the recorded scene through the "
                             "stream, and measures what comes out.")  # fmt: skip
    add = parser.add_argument
    add("--no-follow", dest="follow", action="store_false", help="the rendered scene: detects in each frame and looks for its "
                                                                 "poses anew, instead of following objects from frame to "
                                                                 "frame; a slow machine passes over frames")  # fmt: skip
    add("--live", action="store_true", help="a virtual camera plays the rendered scene through OpenNI2; measures from "
                                            "its shutter to the poses")  # fmt: skip
    add("--seconds", type=positive, default=60, metavar="N", help="how long it does so (default 60)")
    add("--teach", action="store_true", help="a virtual camera is carried around an object that nobody has seen: it is "
                                             "taught, found and posed while the stream goes on")  # fmt: skip
    add("--unplug", action="store_true", help="takes the camera away for three seconds halfway through, and plugs it in "
                                              "again")  # fmt: skip
    add("--real", metavar="DIR", help="camera-recorded data (DIR/objects, background, scenes, clutter) instead of "
                                      "rendered data")  # fmt: skip
    add("--pictures", type=pathlib.Path, metavar="DIR", help="instead of a report writes the front page's pictures of the "
                                                             "rendered scene, hs_view.jpg and lcm_spy.jpg")  # fmt: skip
    add("--shared-bus", action="store_true", help="use this machine's own network, so that lcm-spy sees the stream; "
                                                  "default: a private network")  # fmt: skip
    add("--scene", default="table_small_1", metavar="NAME", help="rendered test scene (default table_small_1)")
    add("--frames", type=positive, default=300, metavar="N", help="its length (default 300)")
    add(
        "--out",
        type=pathlib.Path,
        metavar="DIR",
        help="default out/demo, out/real with --real, out/live with --live, or out/teach_demo with --teach",
    )
    add("--fresh", action="store_true", help="render and train again even where nothing has changed")
    options = parser.parse_args(words)
    if options.real and not os.path.isdir(f"{options.real}/objects"):
        die(f"{options.real}: no folder objects/ in it, expected camera-recorded data")
    if options.live and options.real:
        die("--live plays a rendered scene; it does not go with --real")
    if options.teach and (options.live or options.real):
        die("--teach is a demo of its own; it goes neither with --live nor with --real")
    if options.pictures and (options.live or options.real or options.teach):
        die("--pictures are of the rendered scene; it goes with none of --live, --real and --teach")
    if not options.follow and (options.live or options.real or options.teach or options.pictures):
        die("--no-follow is of the rendered scene; it goes with none of --live, --real, --teach and --pictures")
    options.follow = options.follow and not (options.live or options.real)
    if options.unplug and not options.live:
        die("--unplug goes with --live")
    options.pictures = options.pictures and options.pictures.resolve()
    paths = {options.real, options.bin, str(options.out)}
    options.command = " ".join([parser.prog, *("DIR" if word in paths else word for word in words)])
    kind = "teach_demo" if options.teach else "live" if options.live else "real" if options.real else "demo"
    options.out = (options.out or pathlib.Path("out", kind)).resolve()
    # Annotations of the UW scenes are read by SciPy, lcm-spy is Java's.
    options.setup = () if options.real or options.pictures else ("--demo",)
    return options


def targets(options):
    return sum((more for kind, more in FURTHER_TARGETS.items() if getattr(options, kind)), TARGETS)


if __name__ == "__main__":
    main(parse, targets, enter_network, "studies.demo.run")
