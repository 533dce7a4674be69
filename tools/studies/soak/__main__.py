"""Faults, one after another, and a long run; each with what was lost, how long until it was back, and what was said."""

import json
import os
import pathlib
import subprocess
import sys

from studies.command import Options, die, know_messages, positive, step
from studies.measured import REPOSITORY
from studies.soak.long_run import long_run
from studies.stream import ProcessFailed, enter_private_network


def run_faults(options, out):
    from studies.soak.frame_faults import FrameFaults  # needs the messages' package
    from studies.soak.store_faults import StoreFaults
    from studies.soak.stream_faults import StreamFaults

    faults = [fault for kind in (FrameFaults, StreamFaults, StoreFaults) for fault in kind(options, out).all()]
    summary = {}
    for name, fault in faults:
        if options.only not in name:
            continue
        try:
            summary[name] = fault()
        except (ProcessFailed, subprocess.SubprocessError, OSError) as error:
            summary[name] = {"good": False, "failed": str(error)}
        summary[name]["load"] = round(os.getloadavg()[0], 1)
        step(f"{'ok   ' if summary[name]['good'] else 'WRONG'} {name}: {json.dumps(summary[name])}")
    return summary


def words_of(value):
    """A value for people."""
    if isinstance(value, dict):
        return ", ".join(f"{key} {words_of(one)}" for key, one in value.items())
    return ", ".join(map(words_of, value)) if isinstance(value, list) else str(value)


def counts_of(seen):
    """What became of the frames: of those that were sent, where that is known, of those that came elsewhere."""
    if "processed" not in seen:
        return "–"
    whole = f"{seen['sent']} sent" if "sent" in seen else f"{seen['received']} came"
    return f"{whole} = {seen['processed']} + {seen['skipped']} + {seen['lost']} + {seen['refused']}"


def page(summary):
    lines = ["# What the stream does under faults", "",
             "Frames: sent = processed + passed over + lost + refused. Back after: seconds until the first result.", "",
             "| fault | | frames | back after, s | load |", "|---|---|---|---|---|"]  # fmt: skip
    faults = summary.get("faults", {})
    for name, seen in faults.items():
        lines.append(f"| {name} | {'good' if seen['good'] else '**WRONG**'} | {counts_of(seen)} | "
                     f"{words_of(seen.get('back_after_s', '–'))} | {seen['load']} |")  # fmt: skip
    for name, seen in faults.items():
        rest = {key: value for key, value in seen.items() if key not in ("good", "load", "reported", "back_after_s")}
        lines += ["", f"## {name}", "", words_of(rest), *(["", "What was reported:", ""] if seen.get("reported") else [])]
        lines += [f"    {line}" for line in seen.get("reported", [])]
    if "long" in summary:
        lines += ["", "## A long run", "", f"```\n{json.dumps(summary['long'], indent=1)}\n```", "", "![](long_run.png)"]
    return "\n".join(lines) + "\n"


def read_options():
    parser = Options("soak", __doc__)
    parser.add_argument("--data", metavar="DIR", default="out/demo/data", help="as tools/demo makes it (default: %(default)s)")
    parser.add_argument("--out", metavar="DIR", default="out/soak", help="default: %(default)s")
    parser.add_argument("--frames", type=positive, default=300, help="sent in each run that counts (default: %(default)s)")
    parser.add_argument("--minutes", type=positive, default=60, help="of the long run (default: %(default)s)")
    parser.add_argument("--rate", type=positive, default=30, help="frames a second in it (default: %(default)s)")
    parser.add_argument("--faults-only", action="store_true", help="no long run")
    parser.add_argument("--only", metavar="WORDS", default="", help="faults whose names hold these words")
    parser.add_argument("--objects", metavar="STORE", help="kill the processes of a stream of this store's objects too")
    options = parser.parse_args()
    options.data = pathlib.Path(options.data).resolve()
    options.objects = pathlib.Path(options.objects).resolve() if options.objects else None
    options.programs = pathlib.Path(options.bin).resolve() if options.bin else pathlib.Path(REPOSITORY) / "build" / "bin"
    for needed in (options.data / "forest", options.data / "scene", options.data / "training" / "models",
                   options.data / "stream.lcmlog", options.programs / "hs-stream"):  # fmt: skip
        if not needed.exists():
            die(f"{needed}: missing, expected what tools/demo makes; run it first, or give --data and --bin")
    know_messages(str(options.programs))
    return options


def main():
    options = read_options()
    enter_private_network()
    out = pathlib.Path(options.out).resolve()
    out.mkdir(parents=True, exist_ok=True)
    summary = {"faults": run_faults(options, out)}
    if not options.faults_only:
        summary["long"] = long_run(options, out)
    (out / "summary.json").write_text(json.dumps(summary, indent=1) + "\n")
    (out / "report.md").write_text(page(summary))
    good = all(seen["good"] for seen in summary["faults"].values()) and summary.get("long", {"good": True})["good"]
    step(f"{out / 'report.md'}: {'all as it should be' if good else 'something is WRONG'}")
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
