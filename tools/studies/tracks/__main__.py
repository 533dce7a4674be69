"""Options of tools/bench tracks. What they ask for is in plan.py, what comes of it in report.py."""

import pathlib

from studies.command import Options, die, positive, some_of
from studies.stream import enter_private_network
from studies.unit_runner import main

# As hs-render takes orders them.
SEQUENCES = ("walk", "pushed", "carried", "removed", "swapped", "cans", "arm", "jerk", "cameras")
TARGETS = ("hs-render", "hs-train", "hs-capture", "hs-detect", "hs-pose", "hs-track", "hs-observe", "hs-study")


def parse(words):
    parser = Options("bench tracks", "Renders sequences with the truth of every frame (a camera that walks round a table; "
                                     "objects that are pushed, carried, taken away, brought back, swapped and hidden; two "
                                     "equal cans; a camera that is pushed; three cameras), finds and follows the objects in "
                                     "them, and compares the tracks with the truth; measures frame to pose at 30, 60 and "
                                     "90 Hz, and forty objects on two hosts.")  # fmt: skip
    add = parser.add_argument
    add("--sequences", type=some_of(SEQUENCES, "sequence"), default=SEQUENCES, metavar="NAMES",
        help=f"of {', '.join(SEQUENCES)}; default all")  # fmt: skip
    add("--forest", type=pathlib.Path, metavar="FILE", help="of the four objects, with --models; default: taught anew")
    add("--models", type=pathlib.Path, metavar="DIR", help="their models")
    add("--follow", action="store_true", help="poses by hs-pose --follow")
    add("--development", action="store_true", help="rooms to choose settings on, instead of those that are measured with")
    add("--no-stream", dest="stream", action="store_false", help="measure no rates")
    add("--no-hosts", dest="hosts", action="store_false", help="nothing of several hosts")
    add("--seconds", type=positive, default=60, metavar="S", help="of each replay at each rate (default 60)")
    add("--out", type=pathlib.Path, default="out/bench", metavar="DIR", help="default out/bench")
    add("--fresh", action="store_true", help="render and teach again even where nothing has changed")
    options = parser.parse_args(words)
    if (options.forest is None) != (options.models is None):
        parser.error("--forest and --models go together")
    options.out = options.out.resolve()
    return options


def network(options):
    entered = enter_private_network() if options.stream or options.hosts else None
    if options.hosts and entered != "private":
        die("network namespaces are refused here, and hosts are made of them; --no-hosts leaves them out")
    return entered


if __name__ == "__main__":
    main(parse, lambda _: TARGETS, network, "studies.tracks.report")
