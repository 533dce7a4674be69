"""Options of tools/bench bop. What they ask for is in plan.py, what comes of it in figures.py and report.py."""

import argparse
import pathlib

from studies import unit_runner
from studies.bop.dataset import BadSet, open_dataset, read_store
from studies.command import Options, positive

TARGETS = ("hs-teach", "hs-evaluate", "hs-study")


def seconds(text):
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0.0 < value < 1e6:
        raise argparse.ArgumentTypeError(f"'{text}', expected seconds above 0")
    return value


def parse(words):
    parser = Options("bench bop", "Teaches the objects of sets that lie as the BOP challenge publishes them (ROOT/models, "
                                  "ROOT/test, ROOT/test_targets_bop19.json where there is one), finds them in the sets' "
                                  "frames, and measures detection, poses, how far score and quality are to be believed, "
                                  "and time, beside OpenCV's LINEMOD and PPF and PCL's prerejective.")  # fmt: skip
    add = parser.add_argument
    add("--dataset", action="append", default=[], metavar="[NAME=]ROOT", help="a set; may be given several times")
    add("--objects", type=pathlib.Path, metavar="STORE", help="test a store that was taught before (hs-teach) instead of "
        "teaching the sets' models; objects that it does not know are left out")  # fmt: skip
    add("--split", default="test", metavar="NAME", help="scenes are ROOT/NAME/00000N (default test), or ROOT/00000N")
    add(
        "--every",
        type=positive,
        default=1,
        metavar="N",
        help="every Nth of the images that are targets, or of all (default 1)",
    )
    add("--seeds", type=positive, default=1, metavar="N", help="teach so many times with different seeds: means, and their "
        "spread (default 1)")  # fmt: skip
    add("--no-rivals", dest="rivals", action="store_false", help="leave the rivals out")
    add("--rivals-seconds", type=seconds, default=300.0, metavar="S", help="each of LINEMOD and the two methods of poses "
        "looks at as many frames of a set as it can in this time, training not counted (default 300)")  # fmt: skip
    add("--out", type=pathlib.Path, default="out/bop", metavar="DIR", help="default out/bop")
    add("--fresh", action="store_true", help="teach and measure again even where nothing has changed")
    options = parser.parse_args(words)
    if not options.dataset:
        parser.error("no --dataset, expected at least one")
    if options.objects and options.seeds > 1:
        parser.error("--seeds with --objects: a store is of one teaching")
    options.out = options.out.resolve()
    options.objects = options.objects and options.objects.resolve()
    options.datasets = open_all(options)  # what is wrong with them is told before anything is built
    return options


def open_all(options):
    if options.objects:
        read_store(options.objects)
    datasets = [open_dataset(text, options.split, options.every, not options.objects) for text in options.dataset]
    for number, dataset in enumerate(datasets):
        if dataset.name in (other.name for other in datasets[:number]):
            raise BadSet(
                f"--dataset {dataset.root}: a second set called {dataset.name}, expected NAME=ROOT with another name"
            )
    return datasets


def main():
    unit_runner.main(parse, lambda _: TARGETS, lambda _: None, "studies.bop.report")


if __name__ == "__main__":
    main()
