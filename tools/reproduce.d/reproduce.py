"""Runs the comparison of the paper and writes its report. tools/reproduce builds what this needs and starts it."""

import argparse
import dataclasses
import fcntl
import json
import os
import pathlib
import signal
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "report_kit"))

import figures
import page
from measured import cpu_name
from plan import make_plan
from planner import Protocol, quick
from results import Results
from runner import Runner, UnitFailed
from standalone import standalone
from store import Store, write_atomically
from summary import rounded, summarise
from units import with_inputs


def parse(words):
    parser = argparse.ArgumentParser(prog="reproduce", description=__doc__)
    parser.add_argument("--bin", default="build/bin")
    parser.add_argument("--out", required=True, type=pathlib.Path)
    parser.add_argument("--dataset", default="rendered", help="rendered, uw:DIR or real:DIR")
    parser.add_argument("--real", default="")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", default="", metavar="PREFIX")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--report", action="store_true")
    parser.add_argument("--fresh", action="store_true")
    parser.add_argument("--pictures", type=pathlib.Path, help="folder to write figures to, as files of their own")
    parser.add_argument("--commit", default="unknown")
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    return parser.parse_args(words)


def chosen_protocol(arguments):
    protocol = dataclasses.replace(Protocol(), threads=arguments.threads)
    return quick(protocol) if arguments.quick else protocol


def planned(arguments):
    dataset, _, folder = arguments.dataset.partition(":")
    real = folder if dataset == "real" else arguments.real
    return make_plan(dataset, folder, real, chosen_protocol(arguments))


def require_executables(store, units):
    for file in sorted({store.executable(unit)[-1] for unit in units}):
        if not os.access(file, os.R_OK):
            sys.exit(f"reproduce: {file}: not there, build it first")


def print_list(store, units):
    for unit in units:
        state = "done" if store.is_current(unit) else "to do"
        print(f"{state:<6} {unit.name}  (figure {'; '.join(unit.figures)})\n         {' '.join(unit.command)}")


def lock(out):
    """Two runs in one folder would remove each other's files. The file stays open, and so locked, until the end."""
    out.mkdir(parents=True, exist_ok=True)
    file = open(out / ".lock", "w")
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        sys.exit(f"reproduce: {out}: another run is writing there")
    return file


def command_in_words(arguments):
    dataset = [] if arguments.dataset == "rendered" else ["--dataset", arguments.dataset.partition(":")[0] + ":DIR"]
    return " ".join(["tools/reproduce", *(["--quick"] if arguments.quick else []), *dataset])


def settings(arguments, units, store):
    seconds = sum(store.record(unit).get("seconds", 0.0) for unit in units if store.is_current(unit))
    return {
        "command": command_in_words(arguments),
        "dataset": arguments.dataset.partition(":")[0],
        "quick": arguments.quick,
        "left_out": list(chosen_protocol(arguments).left_out),
        "threads": arguments.threads,
        "commit": arguments.commit,
        "cpu": cpu_name(),
        "units": len(units),
        "units_done": sum(store.is_current(unit) for unit in units),
        "hours": seconds / 3600.0,
    }


def write_pictures(folder, summary, results):
    """For pages that cannot show the report itself."""
    drawings = {
        "features": figures.feature_bars(results),
        "final": figures.final_bars(results),
        "stride": figures.stride_chart(summary["stride"]),
        "reliability": figures.reliability_chart(summary["reliability"]["bins"]),
    }
    folder.mkdir(parents=True, exist_ok=True)
    for name, drawing in drawings.items():
        write_atomically(folder / f"{name}.svg", standalone(drawing))


def write_report(arguments, store, units):
    results = Results(store, units, chosen_protocol(arguments).left_out)
    summary = {**summarise(results), "settings": settings(arguments, units, store)}
    write_atomically(arguments.out / "results.csv", results.csv())
    write_atomically(arguments.out / "results.json", results.json())
    write_atomically(arguments.out / "summary.json", json.dumps(rounded(summary), indent=2) + "\n")
    write_atomically(arguments.out / "report.html", page.render(summary, results))
    if arguments.pictures:
        write_pictures(arguments.pictures, summary, results)
    print(f"{arguments.out}/report.html, summary.json, results.csv, results.json")
    if summary["missing"]:
        print(f"{len(summary['missing'])} figures are missing, named in summary.json")


def work(arguments, store, units):
    chosen = with_inputs(units, [unit for unit in units if unit.name.startswith(arguments.only)])
    if not chosen:
        sys.exit(f"reproduce: --only {arguments.only}: no unit's name begins so, see --list")
    if arguments.fresh:
        for unit in chosen:
            store.forget(unit)
    if not arguments.report:
        Runner(store).run(chosen)
    write_report(arguments, store, units)


def interrupted(*_):
    raise KeyboardInterrupt


def main(words=None):
    arguments = parse(words)
    units = planned(arguments)
    store = Store(arguments.out, arguments.bin, units)
    require_executables(store, units)
    if arguments.list:
        signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # a reader that has seen enough, as head, ends it quietly
        print_list(store, units)
        return
    signal.signal(signal.SIGTERM, interrupted)
    try:
        with lock(arguments.out):
            work(arguments, store, units)
    except UnitFailed as error:
        sys.exit(f"reproduce: {error}")
    except KeyboardInterrupt:
        print("\nreproduce: interrupted; the same command goes on from here", file=sys.stderr)
        sys.exit(130)


if __name__ == "__main__":
    main()
