"""Options of tools/bench. What they ask for is in parts.py."""

import argparse
import pathlib

from studies.command import Options, positive, recorded_folder
from studies.stream import enter_network
from studies.unit_runner import main

PARTS = ("speed", "stream", "growth", "pose", "attitudes")
TARGETS = ("hs-render", "hs-train", "hs-capture", "hs-detect", "hs-pose", "hs-observe", "hs-evaluate", "hs-fuse", "hs-teach",
           "hs-study")  # fmt: skip


def part(text):
    if text not in PARTS:
        raise argparse.ArgumentTypeError(f"unknown benchmark {text}, expected {', '.join(PARTS)}")
    return text


def parse(words):
    parser = Options("bench", "Measures everything from nothing to a report: installs, builds, renders data, trains, and "
                              "then times detection beside its rivals, streams a minute of frames through the processes, "
                              "lets the number of objects grow, compares poses, and looks for what lies or leans. Sets of "
                              "the BOP challenge: tools/bench bop --help.")  # fmt: skip
    add = parser.add_argument
    add("parts", nargs="*", type=part, metavar="speed | stream | growth | pose | attitudes",
        help="speed: time a frame: profiles, stages, threads, instruction sets, the reference engine, LINEMOD. stream: a "
             "minute of replay at 30 Hz: latency from frame to pose, losses, CPU time, memory. growth: time with 1 to 40 "
             "objects, 5 to 30 trees, 320x240 to 1280x960 pixels. pose: accuracy and time, beside PCL's ICP and two other "
             "methods. attitudes: what lies, leans and is held, and what standing objects lose where that is taught too. "
             "Default: all five")  # fmt: skip
    add(
        "--every",
        type=positive,
        default=2,
        metavar="N",
        help="look at every Nth of the 60 frames of each scene (default 2)",
    )
    add("--rivals-every", type=positive, default=6, metavar="M",
        help="of those, the other methods of poses look at every Mth: they are slow (default 6)")  # fmt: skip
    add("--real", metavar="DIR", help='camera-recorded data (DIR/objects, background, scenes, model) to compare poses on as '
                                      'well; default ../shared/realdata where it is there, "" for none')  # fmt: skip
    add("--shared-bus", action="store_true", help="stream on this machine's own network; default: a private network")
    add("--out", type=pathlib.Path, default="out/bench", metavar="DIR", help="default out/bench")
    add("--fresh", action="store_true", help="render and train again even where nothing has changed")
    options = parser.parse_args(words)
    options.parts = options.parts or list(PARTS)
    options.real = recorded_folder(options.real, "model")
    options.out = options.out.resolve()
    return options


if __name__ == "__main__":
    main(parse, lambda _: TARGETS, enter_network, "studies.bench.parts")
