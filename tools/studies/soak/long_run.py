"""A stream that runs for long: what is lost, and whether memory, descriptors and threads stay what they were."""

import json
import os
import pathlib
import re
import signal
import time

from studies.command import step
from studies.soak.wire import bus
from studies.stream import Processes, resident_mb

PORT = 7668
SETTLED_S = 120  # from then on nothing may grow
MOST_GROWTH = 0.02


def sample(pid):
    folder = pathlib.Path(f"/proc/{pid}")
    threads = int(re.search(r"Threads:\s+(\d+)", (folder / "status").read_text()).group(1))
    return {"mb": resident_mb(pid), "descriptors": len(os.listdir(folder / "fd")), "threads": threads}


def start_all(options, running):
    programs, data, url = options.programs, options.data, bus(PORT)
    running.start("detect", programs / "hs-detect", "--forest", data / "forest", "-l", url)
    running.start("pose", programs / "hs-pose", "--models", data / "training" / "models", "-l", url)
    for name in ("detect", "pose"):
        running.by_name[name].wait_until_ready()
    running.start("capture", programs / "hs-capture", "--source", f"bop:{data / 'scene'}", "--loop", "--rate", options.rate,
                  "-l", url)  # fmt: skip


def watch(running, minutes):
    """Samples every five seconds, by process."""
    samples = {name: [] for name in running.by_name}
    start = time.monotonic()
    while time.monotonic() - start < 60 * minutes:
        for name, process in running.by_name.items():
            if not process.runs():
                process.fail("ended")
            samples[name].append({"s": round(time.monotonic() - start, 1), **sample(process.process.pid)})
        time.sleep(5)
    return samples


def growth(samples):
    """Of the memory's median at the end over that at the second minute."""
    settled = [one["mb"] for one in samples if one["s"] >= min(SETTLED_S, samples[-1]["s"] / 2)]
    part = max(len(settled) // 10, 1)
    first, last = sorted(settled[:part])[part // 2], sorted(settled[-part:])[part // 2]
    return round(last / first - 1, 4)


def draw(samples, file):
    import matplotlib  # noqa: PLC0415, only where a chart is drawn

    matplotlib.use("Agg")
    from matplotlib import pyplot  # noqa: PLC0415

    figure, axes = pyplot.subplots(3, 1, figsize=(9, 9), sharex=True)
    for axis, key, label in zip(axes, ("mb", "descriptors", "threads"), ("resident memory, MB", "descriptors", "threads")):
        for name, of_process in samples.items():
            axis.plot([one["s"] / 60 for one in of_process], [one[key] for one in of_process], label=f"hs-{name}")
        axis.set_ylabel(label)
        axis.set_ylim(bottom=0)
    axes[0].legend()
    axes[-1].set_xlabel("minutes")
    figure.savefig(file, dpi=110)


def long_run(options, out):
    step(f"a run of {options.minutes} minutes at {options.rate} Hz")
    with Processes(out / "long") as running:
        start_all(options, running)
        samples = watch(running, options.minutes)
        for name in ("capture", "pose", "detect"):
            running.by_name[name].process.send_signal(signal.SIGINT)
            running.by_name[name].wait(10)
        words = running.by_name["detect"].log.read_text(errors="replace")
    counts = re.search(r"ends: (\d+) received, (\d+) processed, (\d+) skipped, (\d+) lost, (\d+) refused", words)
    received, processed, skipped, lost, refused = (int(count) for count in counts.groups())
    (out / "long_run.json").write_text(json.dumps(samples) + "\n")
    draw(samples, out / "long_run.png")
    grown = {name: growth(of_process) for name, of_process in samples.items()}
    seen = {"minutes": options.minutes, "rate_hz": options.rate, "received": received, "processed": processed,
            "passed_over": skipped, "lost": lost, "refused": refused, "memory_growth": grown,
            "descriptors": {name: sorted({one["descriptors"] for one in each[2:]}) for name, each in samples.items()},
            "threads": {name: sorted({one["threads"] for one in each[2:]}) for name, each in samples.items()}}  # fmt: skip
    seen["good"] = lost == 0 and refused == 0 and all(share <= MOST_GROWTH for share in grown.values())
    step(f"{'ok   ' if seen['good'] else 'WRONG'} a long run: {json.dumps(seen)}")
    return seen
