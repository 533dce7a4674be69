"""Streams that run for long: hs-capture, hs-detect, hs-pose and hs-track, what they lose and pass over, how long frames
take, and whether memory, descriptors and threads stay what they were."""

import contextlib
import json
import os
import pathlib
import re
import shutil
import signal
import sys
import time

from studies.command import step
from studies.records import write_atomically
from studies.soak.faults import account, said
from studies.soak.long_account import CHAIN, accounts, captured, cost, latencies, looks_of, wrong
from studies.soak.wire import bus
from studies.stream import Processes, ProcessFailed, cpu_seconds, resident_mb

PORT = 7668  # of the first rate's bus; the others' follow
PERIOD_S = 5.0  # between samples
KEEP_S = 60.0  # between writings of what has been sampled
UNDER_WAY_S = 1.0  # what is sent has gone through all processes by then


class StopSignals:
    """Meanwhile SIGINT, SIGTERM and the end of the terminal do not end this program: it is told that one came."""

    def __init__(self):
        self.came = False

    def __enter__(self):
        numbers = [signal.SIGINT, signal.SIGTERM]
        if signal.getsignal(signal.SIGHUP) != signal.SIG_IGN:  # as nohup asks for
            numbers.append(signal.SIGHUP)
        self.before = {number: signal.signal(number, self._note) for number in numbers}
        return self

    def __exit__(self, *_):
        for number, handler in self.before.items():
            signal.signal(number, handler)

    def _note(self, *_):
        self.came = True

    def nap(self, seconds):
        """Until one comes, but for a fifth of a second."""
        end = time.monotonic() + seconds
        while not self.came and time.monotonic() < end:
            time.sleep(max(0.0, min(0.2, end - time.monotonic())))


def taken(pid):
    """Returns what a process has of the machine now."""
    folder = pathlib.Path(f"/proc/{pid}")
    threads = int(re.search(r"Threads:\s+(\d+)", (folder / "status").read_text()).group(1))
    return {"mb": round(resident_mb(pid), 3), "descriptors": len(os.listdir(folder / "fd")), "threads": threads,
            "cpu_s": cpu_seconds(pid)}  # fmt: skip


class LongRun:
    """The processes of one rate, on a bus of their own. hs-observe, which stamps what goes by, is not judged: it keeps a row
    of each frame. Use with `with`."""

    def __init__(self, options, out, rate, port):
        self.options, self.rate, self.port, self.url = options, rate, port, bus(port)
        self.folder, self.file = out / f"long_{rate}", out / f"long_run_{rate}.json"
        self.partial = self.file.with_name(self.file.name + ".partial")
        self.samples = {name: [] for name in CHAIN}
        self.failed = None

    def __enter__(self):
        shutil.rmtree(self.folder, ignore_errors=True)
        self.running = Processes(self.folder)
        return self

    def __exit__(self, *_):
        self.running.__exit__()

    def attempt(self, work):
        """What fails ends this run; one beside it goes on."""
        try:
            if not self.failed:
                work()
        except (ProcessFailed, OSError) as error:
            self.failed = str(error)

    def start_listeners(self):
        models = ("--models", self.options.data / "training" / "models")
        from studies.follow_speed import LOOKS  # needs the messages' package

        follows = self.options.follow
        self._start("detect", "hs-detect", "--forest", self.options.data / "forest",
                    *(("--looks-per-second", LOOKS, "--threads", 1) if follows else ()))  # fmt: skip
        self._start("pose", "hs-pose", *models, *(("--follow",) if follows else ()))
        self._start("track", "hs-track", *models)
        self._start("observe", "hs-observe", "--out", self.folder / "observe.json", "--csv", self.folder / "frame_times.csv",
                    "--replace")  # fmt: skip
        for process in self.running.by_name.values():
            process.wait_until_ready(60)

    def start_camera(self):
        if self.options.play:
            camera = (sys.executable, "-m", "studies.soak.player", self.options.data / "stream.lcmlog", self.port, self.rate)
            self.running.start("capture", "setsid", *camera)
        else:
            self._start("capture", "hs-capture", "--source", f"bop:{self.options.data / 'scene'}", "--loop", "--rate", self.rate)
        self.began = time.monotonic()

    def _start(self, name, program, *words):
        # In a session of its own, where Ctrl-C does not reach it: it is ended after those that send to it.
        self.running.start(name, "setsid", self.options.programs / program, *words, "-l", self.url)

    def sample(self):
        now = round(time.monotonic() - self.began, 1)
        for name, process in self.running.by_name.items():
            if not process.runs():
                process.fail("ended")
            if name in CHAIN:
                self.samples[name].append({"s": now, **taken(process.process.pid)})

    def keep(self):
        """What has been sampled outlives this program."""
        write_atomically(self.partial, json.dumps({"rate_hz": self.rate, "samples": self.samples}) + "\n")

    def stop(self):
        """In the order in which frames go, so that none is on its way to who is there no more."""
        by_name = self.running.by_name
        for names, rest_s in ((("capture",), UNDER_WAY_S), (("observe", *CHAIN[1:]), 0.0)):
            try:
                self.running.stop(*(name for name in names if name in by_name and by_name[name].runs()))
            except ProcessFailed as error:
                self.failed = self.failed or str(error)
            time.sleep(rest_s)

    def end(self, beside):
        """Ends the run and writes it. `beside`: the rates that ran at the same time. Returns what was seen."""
        self.stop()
        samples = {name: of_process for name, of_process in self.samples.items() if of_process}
        minutes = max((of_process[-1]["s"] / 60 for of_process in samples.values()), default=0.0)
        seen = {"rate_hz": self.rate, "minutes": round(minutes, 1), "of_minutes": self.options.minutes, "beside_hz": beside,
                "follows": self.options.follow, "plays": self.options.play, "processes": {name: cost(of_process) for name, of_process in samples.items()}}  # fmt: skip
        seen["cores"] = round(sum(one["cores"] for one in seen["processes"].values()), 3)
        self.attempt(lambda: self.add_counts(seen))
        latency = {}
        with contextlib.suppress(FileNotFoundError):  # who could not observe has been told of
            latency = latencies(self.folder / "frame_times.csv")
        seen["latency_ms"] = {result: {key: value for key, value in whole.items() if key != "minutes"}
                              for result, whole in latency.items()}  # fmt: skip
        self.write(samples, latency)
        if self.failed:
            seen["failed"] = self.failed
        seen["wrong"] = wrong(seen)
        return seen | {"good": not seen["wrong"]}

    def add_counts(self, seen):
        processes = self.running.by_name
        told = captured(processes["capture"].log.read_text(errors="replace"))
        if told is None:
            processes["capture"].fail("has not said what it sent")
        seen["sent"], seen["sent_hz"] = told
        told_by = {name: account(processes[name]) for name in CHAIN[1:]}
        looks = looks_of(processes["pose"].log.read_text(errors="replace"))
        if self.options.follow and looks is None:
            processes["pose"].fail("has not said what it answered")
        for name, counts in accounts(told[0], told_by, looks).items():
            seen["processes"][name].update(counts)
        seen["reported"] = [line for name in CHAIN[1:] for line in said(processes[name], "ends:|looks:")]

    def write(self, samples, latency):
        """The samples and the latency of each minute, and both drawn."""
        from studies.soak.long_chart import draw  # matplotlib, only where a chart is drawn

        minutes = {result: whole["minutes"] for result, whole in latency.items()}
        write_atomically(self.file, json.dumps({"rate_hz": self.rate, "samples": samples, "latency_ms": minutes}) + "\n")
        draw(samples, latency, self.file.with_suffix(".png"))
        self.partial.unlink(missing_ok=True)


def watch(runs, minutes, signals):
    """Until the time is over, a stop signal comes, or all have failed."""
    for run in runs:
        run.attempt(run.start_listeners)
    for run in runs:
        run.attempt(run.start_camera)
    seconds = 60 * minutes
    period = min(PERIOD_S, max(1.0, seconds / 120))
    start = kept = time.monotonic()
    while True:
        for run in runs:
            run.attempt(run.sample)
        now = time.monotonic()
        if now - kept >= KEEP_S:
            kept = now
            for run in runs:
                run.attempt(run.keep)
        if signals.came or now - start >= seconds or all(run.failed for run in runs):
            return
        signals.nap(min(period, start + seconds - now))


def long_runs(options, out):
    """One of each rate, at the same time or one after another: yields rate and what was seen. A stop signal ends them, with
    what there is."""
    runs = [LongRun(options, out, rate, PORT + number) for number, rate in enumerate(options.rate)]
    with StopSignals() as signals:
        for group in [runs] if options.together else [[run] for run in runs]:
            if signals.came:
                return
            rates = [run.rate for run in group]
            step(f"{options.minutes} minutes at {' and '.join(map(str, rates))} Hz")
            with contextlib.ExitStack() as stack:
                for run in group:
                    stack.enter_context(run)
                watch(group, options.minutes, signals)
                seen = [run.end([rate for rate in rates if rate != run.rate]) for run in group]
            yield from zip(rates, seen)
