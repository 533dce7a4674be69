"""Runs units in order, one at a time since times are measured, and leaves out what is current."""

import functools
import os
import signal
import subprocess
import sys
import time

LOG_TAIL = 10


class UnitFailed(Exception):
    pass


def in_words(seconds):
    minutes, seconds = divmod(int(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    if hours:
        return f"{hours} h {minutes:02} min"
    return f"{minutes} min {seconds:02} s" if minutes else f"{seconds} s"


def last_lines(file, count):
    return file.read_text(errors="replace").splitlines()[-count:]


def end(process):
    """Asks nicely, waits, insists; the unit's own children too."""
    for sign in (signal.SIGTERM, signal.SIGKILL):
        try:
            os.killpg(process.pid, sign)
            process.wait(timeout=10)
            return
        except subprocess.TimeoutExpired:
            continue
        except ProcessLookupError:
            return


class Runner:
    def __init__(self, store, tell=functools.partial(print, flush=True)):
        self.store, self.tell = store, tell
        self.begin = time.monotonic()
        self.seconds = {}  # of the units that ran, by kind

    def run(self, units):
        """Raises UnitFailed at the first that fails."""
        waiting = [unit for unit in units if not self.store.is_current(unit)]
        done = len(units) - len(waiting)
        if done:
            self.tell(f"{done} of {len(units)} units are current")
        while waiting:
            if not self.store.is_current(waiting[0]):  # as it may be by now: its inputs turned out as they were
                elapsed = in_words(time.monotonic() - self.begin)
                self.tell(f"[{done + 1}/{len(units)}, {elapsed}, {self._rest(waiting)}] {waiting[0].name}")
                self._run_one(waiting[0])
            waiting.pop(0)
            done += 1

    def _rest(self, waiting):
        """By what units took earlier, else by what others of their kind took."""
        known = [self._expected(unit) for unit in waiting]
        measured = [seconds for seconds in known if seconds is not None]
        if not measured:
            return "rest unknown"
        mean = sum(measured) / len(measured)
        return "about " + in_words(sum(mean if seconds is None else seconds for seconds in known)) + " left"

    def _expected(self, unit):
        earlier = self.store.record(unit).get("seconds")
        of_kind = self.seconds.get(unit.kind)
        return earlier if earlier is not None else sum(of_kind) / len(of_kind) if of_kind else None

    def _run_one(self, unit):
        self.store.begin(unit)
        begin = time.monotonic()
        with open(self.store.log(unit), "w") as log:
            try:
                process = subprocess.Popen(
                    self.store.command(unit),
                    stdin=subprocess.DEVNULL,
                    stdout=log,
                    stderr=subprocess.STDOUT,
                    start_new_session=True,
                )
            except OSError as error:
                raise UnitFailed(f"{unit.name}: {error}") from error
            try:
                status = process.wait()
            except BaseException:
                end(process)
                raise
        self._check(unit, status)
        seconds = time.monotonic() - begin
        self.seconds.setdefault(unit.kind, []).append(seconds)
        self.store.finish(unit, seconds)

    def _check(self, unit, status):
        log = self.store.log(unit)
        if status == 0 and self.store.part(unit).exists():
            return
        for line in last_lines(log, LOG_TAIL):
            print(f"  {line}", file=sys.stderr)
        reason = "wrote nothing" if status == 0 else f"exit status {status}"
        raise UnitFailed(f"{unit.name}: {reason}; its words are in {log}")
