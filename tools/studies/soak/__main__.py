"""Faults, one after another, and long runs; each with what was lost, how long until it was back, and what was said."""

import argparse
import json
import os
import pathlib
import subprocess
import sys

from studies.command import Options, die, know_messages, positive, step
from studies.records import REPOSITORY
from studies.soak.long_run import long_runs
from studies.soak.page import Record
from studies.soak.work_budget import WorkBudget
from studies.stream import ProcessFailed, enter_private_network

FAULTS_S = 2400  # that all faults may take


def tell(name, seen):
    step(f"{'ok   ' if seen['good'] else 'WRONG'} {name}: {json.dumps(seen)}")


def all_faults(options, out):
    """Pairs of a name and what it runs."""
    from studies.soak.bus_faults import BusFaults  # needs the messages' package, as the others do
    from studies.soak.clock_faults import ClockFaults
    from studies.soak.frame_faults import FrameFaults
    from studies.soak.page_faults import PageFaults
    from studies.soak.recording_faults import RecordingFaults
    from studies.soak.store_faults import StoreFaults
    from studies.soak.stream_faults import StreamFaults

    kinds = (FrameFaults, ClockFaults, StreamFaults, RecordingFaults, StoreFaults, BusFaults, PageFaults)
    return [(name, fault) for kind in kinds for name, fault in kind(options, out).all() if options.only in name]


def run_fault(fault):
    try:
        return fault()
    except (ProcessFailed, subprocess.SubprocessError, OSError) as error:
        return {"good": False, "failed": str(error)}


def run_faults(faults, earlier):
    """Yields each one's name and what was seen. `earlier`: what was seen the last time."""
    earlier_s = {name: seen["seconds"] for name, seen in earlier.items() if "seconds" in seen}
    clock = WorkBudget([name for name, _ in faults], earlier_s, FAULTS_S)
    step(clock.words())
    for name, fault in faults:
        clock.begin()
        if clock.is_over():
            seen = {"good": False, "failed": f"not run, the faults have taken their {FAULTS_S // 60} minutes"}
            clock.pass_over(name)
        else:
            seen = run_fault(fault)
            seen["seconds"] = clock.done(name)
        seen["load"] = round(os.getloadavg()[0], 1)
        tell(name, seen)
        step(clock.words())
        yield name, seen


def rates(text):
    """Hz, between commas, each once."""
    found = [positive(one) for one in text.split(",")]
    if len(set(found)) < len(found):
        raise argparse.ArgumentTypeError(f"'{text}', expected each rate once")
    return found


def read_options():
    parser = Options("soak", __doc__)
    parser.add_argument("--data", metavar="DIR", default="out/demo/data", help="as tools/demo makes it (default: %(default)s)")
    parser.add_argument("--out", metavar="DIR", default="out/soak",
                        help="what it holds of parts that are not run now, stays (default: %(default)s)")  # fmt: skip
    parser.add_argument("--frames", type=positive, default=300, help="sent in each run that counts (default: %(default)s)")
    parser.add_argument("--minutes", type=positive, default=60,
                        help="of each long run (default: %(default)s); Ctrl-C ends it before, with what there is")  # fmt: skip
    parser.add_argument("--rate", type=rates, default="30", metavar="HZ,HZ",
                        help="frames a second, a long run of its own for each (default: %(default)s)")  # fmt: skip
    parser.add_argument("--together", action="store_true", help="the long runs at the same time, each on a bus of its own")
    parts = parser.add_mutually_exclusive_group()
    parts.add_argument("--faults-only", action="store_true", help="no long run")
    parts.add_argument("--long-only", action="store_true", help="no faults")
    parser.add_argument("--follow", action="store_true", help="the long run's poses by hs-pose --follow, of few detections a second")
    parser.add_argument("--play", action="store_true",
                        help="the long run's frames are those of the data's stream.lcmlog, sent as they are, in place of hs-capture, "
                        "whose decoding and encoding of pictures takes most of a core at 60 Hz")  # fmt: skip
    parser.add_argument("--only", metavar="WORDS", default="", help="faults whose names hold these words")
    parser.add_argument("--objects", metavar="STORE", help="kill the processes of a stream of this store's objects too")
    options = parser.parse_args()
    if options.long_only and options.only:
        parser.error(f"--only '{options.only}' names faults, --long-only asks for none, expected one of the two")
    options.data = pathlib.Path(options.data).resolve()
    options.objects = pathlib.Path(options.objects).resolve() if options.objects else None
    options.programs = pathlib.Path(options.bin).resolve() if options.bin else pathlib.Path(REPOSITORY) / "build" / "bin"
    for needed in (options.data / "forest", options.data / "scene", options.data / "training" / "models",
                   options.data / "stream.lcmlog", options.programs / "hs-stream"):  # fmt: skip
        if not needed.exists():
            die(f"{needed}: missing, expected what tools/demo makes; run it first, or give --data and --bin")
    know_messages(str(options.programs))
    return options


def long_command(options):
    listed = ",".join(map(str, options.rate))
    given = "".join(f" --{word}" for word in ("together", "follow", "play") if getattr(options, word))
    return f"tools/soak --long-only --minutes {options.minutes} --rate {listed}{given}"


def main():
    options = read_options()
    enter_private_network()
    out = pathlib.Path(options.out).resolve()
    out.mkdir(parents=True, exist_ok=True)
    record = Record(out)
    if not options.long_only:
        for name, seen in run_faults(all_faults(options, out), record.summary["faults"]):
            record.note("faults", name, seen, "tools/soak --faults-only")
    if not options.faults_only:
        for rate, seen in long_runs(options, out):
            tell(f"{seen['minutes']} minutes at {rate} Hz", seen)
            record.note("long", str(rate), seen, long_command(options))
    step(f"{out / 'report.md'}: {'all as it should be' if record.good else 'something is WRONG'}")
    sys.exit(0 if record.good else 1)


if __name__ == "__main__":
    main()
