"""Options of tools/reproduce. What they ask for is in run.py."""

import os
import pathlib
import signal
import sys

from studies.command import Options, die, positive, prepare, recorded_folder
from studies.records import threads
from studies.unit_runner import UnitFailed, locked

TARGETS = ("hs-render", "hs-train", "hs-import", "hs-log", "hs-evaluate", "hs-study")


def parse(words):
    parser = Options("reproduce", "Repeats the paper's comparison: installs, builds, makes or reads data, trains, measures, "
                                  "writes a report. What is there and unchanged is not made again, so that an interrupted "
                                  "run goes on where it was.")  # fmt: skip
    add = parser.add_argument
    add("--quick", action="store_true", help="within 20 minutes on two cores: one training run instead of five, every third "
                                             "frame, or sixth by slow forests; without what the report names")  # fmt: skip
    add("--dataset", default="rendered", metavar="uw:DIR | real:DIR",
        help="uw: the UW RGB-D Object and Scenes datasets as they unpack, instead of rendered data; real: only what applies "
             "to camera-recorded data (as for tools/demo --real)")  # fmt: skip
    add("--real", metavar="DIR", help='camera-recorded data to measure on as well; default ../shared/realdata where it is '
                                      'there, "" for none')  # fmt: skip
    add(
        "--out", type=pathlib.Path, metavar="DIR", help="default out/reproduce, or out/reproduce_uw, out/reproduce_real"
    )
    add("--only", default="", metavar="PREFIX", help="only the units of work whose name begins so, and what they need")
    add("--list", action="store_true", help="show the units of work and end")
    add("--report", action="store_true", help="run nothing, write the report of what is there")
    add("--fresh", action="store_true", help="make everything again")
    add("--pictures", type=pathlib.Path, metavar="DIR", help="write some of the figures as SVG files too")
    add("--threads", type=positive, default=threads(), metavar="N", help="default: as many as there are cores")
    add("--results", action="store_true", help="run nothing, write tools/studies/RESULTS.md of what tools/demo, tools/bench "
                                               "and tools/reproduce have measured of this commit")  # fmt: skip
    options = parser.parse_args(words)
    kind, _, folder = options.dataset.partition(":")
    if kind not in ("rendered", "uw", "real") or (kind == "rendered") == bool(folder):
        die(f"--dataset {options.dataset}, expected uw:DIR or real:DIR")
    if folder and not os.path.isdir(folder):
        die(f"--dataset {options.dataset}: no such folder")
    options.dataset, options.folder = kind, os.path.realpath(folder) if folder else ""
    options.real = recorded_folder(options.folder if kind == "real" else options.real, "objects")
    options.out = options.out or pathlib.Path("out", "reproduce" if kind == "rendered" else f"reproduce_{kind}")
    return options


def interrupted(*_):
    raise KeyboardInterrupt


def main():
    options = parse(sys.argv[1:])
    if options.results:
        from studies import results

        return results.write()
    programs = prepare(options, TARGETS)
    from studies.reproduce import run  # needs what has been installed

    signal.signal(signal.SIGTERM, interrupted)
    try:
        reproduction = run.Reproduction(options, programs)
        if options.list:
            signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # a reader that has seen enough, as head, ends it quietly
            return reproduction.print_list()
        with locked(options.out):
            reproduction.work()
    except UnitFailed as error:
        die(error)
    except KeyboardInterrupt:
        print("\nreproduce: interrupted; the same command goes on from here", file=sys.stderr)
        sys.exit(130)


if __name__ == "__main__":
    main()
