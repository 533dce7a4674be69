"""The one cache: units of work, what they made and from what, and the loop that runs those that are not current."""

import contextlib
import dataclasses
import fcntl
import functools
import hashlib
import importlib
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import time

from studies.command import die, prepare, step
from studies.records import cpu_name, today, write_atomically
from studies.stream import ProcessFailed
from studies.time_left import SECONDS_APART, in_words, last_words, left_in_words, pace_of, seconds_said

INPUT = re.compile(r"\{([^{}]+)\}")
MODULES = pathlib.Path(__file__).resolve().parent.parent  # where the package lies
LOG_TAIL = 10
INTERRUPTED = "interrupted; the same command goes on from here"


@dataclasses.dataclass(frozen=True)
class Unit:
    """One command and what it makes. In the command "{out}" is what it writes, "{NAME}" what unit NAME has written."""

    name: str  # also the path of what it makes, below the folder of all such files
    command: tuple  # first the program's name, or a module of this package: studies.reproduce.uw_views
    figures: tuple  # of the paper, or parts of the report
    what: str = ""  # detector, in the words of the report
    scene: str = ""
    seed: int = 0  # 0: the same for all
    of: str = ""  # digest of what it reads that no unit has made
    expected_s: float = 0.0  # seconds where it has never run; 0: nobody knows

    @property
    def kind(self):
        return self.name.split("/")[0].split("_every_")[0]

    @property
    def inputs(self):
        names = [name for word in self.command for name in INPUT.findall(word)]
        return tuple(dict.fromkeys(name for name in names if name != "out"))


class Units:
    """Units in the order in which they can run. Two figures may ask for the same one."""

    def __init__(self):
        self.by_name = {}

    def add(self, name, figure, *command, **facts):
        """Returns the name."""
        unit = Unit(name, tuple(str(word) for word in command), (figure,), **facts)
        known = self.by_name.get(name)
        if known:
            if known.command != unit.command:
                raise ValueError(f"two units are called {name}: {known.command}, {unit.command}")
            unit = dataclasses.replace(known, figures=tuple(dict.fromkeys(known.figures + unit.figures)))
        self.by_name[name] = unit
        return name

    def all(self):
        return list(self.by_name.values())


def with_inputs(units, chosen):
    """The chosen ones and all that they need, in order."""
    by_name = {unit.name: unit for unit in units}
    needed = set()
    waiting = [unit.name for unit in chosen]
    while waiting:
        name = waiting.pop()
        if name not in needed:
            needed.add(name)
            waiting.extend(by_name[name].inputs)
    return [unit for unit in units if unit.name in needed]


def sha256_of_file(file):
    digest = hashlib.sha256()
    with open(file, "rb") as data:
        while block := data.read(1 << 20):
            digest.update(block)
    return digest.hexdigest()


def sha256_of_folder(folder):
    """Returns the digest of names and contents."""
    files = sorted(file for file in folder.rglob("*") if file.is_file())
    lines = [f"{file.relative_to(folder)} {sha256_of_file(file)}" for file in files]
    return hashlib.sha256("\n".join(lines).encode()).hexdigest()


def sha256_of(path):
    return sha256_of_folder(path) if path.is_dir() else sha256_of_file(path)


def remove(path):
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path)
    else:
        path.unlink(missing_ok=True)


class Store:
    """OUT/FILES/NAME is what a unit made, OUT/stamps/NAME.json from what, OUT/logs/NAME.txt what it said."""

    def __init__(self, out, programs, units, files="files"):
        self.out, self.programs, self.files = pathlib.Path(out).resolve(), pathlib.Path(programs).resolve(), files
        self.units = {unit.name: unit for unit in units}
        self.digests = {}  # of programs

    def file(self, unit):
        return self.out / self.files / unit.name

    def path(self, name):
        return self.file(self.units[name])

    def part(self, unit):
        """Keeps the file's ending: programs choose an image's format by it."""
        return self.out / "part" / self.file(unit).name

    def log(self, unit):
        return self.out / "logs" / (unit.name + ".txt")

    def _stamp(self, unit):
        return self.out / "stamps" / (unit.name + ".json")

    def program(self, unit):
        """The words that start the unit's command."""
        name = unit.command[0]
        if name.startswith("studies."):
            return [sys.executable, str(MODULES / (name.replace(".", "/") + ".py"))]
        return [str(self.programs / name)]

    def require_programs(self):
        for file in sorted({self.program(unit)[-1] for unit in self.units.values()}):
            if not os.access(file, os.R_OK):
                raise UnitFailed(f"{file}: not there, build it first")

    def command(self, unit):
        def path(match):
            return str(self.part(unit) if match[1] == "out" else self.path(match[1]))

        return self.program(unit) + [INPUT.sub(path, word) for word in unit.command[1:]]

    def _program_digest(self, unit):
        file = self.program(unit)[-1]
        if file not in self.digests:
            self.digests[file] = sha256_of_file(file)
        return self.digests[file]

    def digest(self, unit):
        """Returns the digest of the command, its program and what the inputs contain: a program that was built again but makes
        the same as before does not make all after it run again."""
        inputs = [self.record(self.units[name]).get("made") for name in unit.inputs]
        text = json.dumps([unit.command, self._program_digest(unit), inputs] + [unit.of] * bool(unit.of))
        return hashlib.sha256(text.encode()).hexdigest()

    def record(self, unit):
        """Returns what is known of the last time that the unit ran; empty if it never did."""
        try:
            return json.loads(self._stamp(unit).read_text())
        except FileNotFoundError:
            return {}

    def is_current(self, unit):
        if not all(self.is_current(self.units[name]) for name in unit.inputs):
            return False
        return self.record(unit).get("digest") == self.digest(unit) and self.file(unit).exists()

    def begin(self, unit):
        """The record of an earlier time stays until the new one: it tells how long the unit takes."""
        remove(self.file(unit))
        remove(self.out / "part")
        for path in (self.part(unit), self.file(unit), self.log(unit)):
            path.parent.mkdir(parents=True, exist_ok=True)

    def finish(self, unit, seconds):
        os.replace(self.part(unit), self.file(unit))
        record = {"digest": self.digest(unit), "made": sha256_of(self.file(unit)), "seconds": round(seconds, 2)}
        record |= {"date": today(), "cpu": cpu_name(), "command": " ".join(unit.command)}
        write_atomically(self._stamp(unit), json.dumps(record, indent=2) + "\n")

    def forget(self, unit):
        self._stamp(unit).unlink(missing_ok=True)
        remove(self.file(unit))


class UnitFailed(Exception):
    pass


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
    """Runs units in order, one at a time since times are measured, and leaves out what is current. While one runs, a line
    every ten seconds says how far it is and how long all of them still take, with `after_s` expected seconds of what follows."""

    def __init__(self, store, tell=functools.partial(print, flush=True), after_s=0.0):
        self.store, self.tell, self.after_s = store, tell, after_s
        self.begin = time.monotonic()
        self.seconds = {}  # of the units that ran, by kind
        self.pairs = []  # (seconds, expected ones) of those of which both are known

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
                self._run_one(waiting)
            waiting.pop(0)
            done += 1

    def _rest(self, waiting, running_s=0.0, said_s=0.0):
        """Says how long the rest takes, by what units took earlier, else by what others of their kind took, else by what they
        are expected to take. The first one has run for `running_s` seconds, and says itself that it takes `said_s` more."""
        known = [self._expected(unit) for unit in waiting]
        measured = [seconds for seconds in known if seconds is not None]
        if not measured:
            return "rest unknown"
        mean = sum(measured) / len(measured)
        first, *others = (mean if seconds is None else seconds for seconds in known)
        return left_in_words(max(first - running_s, said_s, 0.0) + sum(others) + self.after_s * pace_of(self.pairs))

    def _expected(self, unit):
        earlier = self.store.record(unit).get("seconds")
        of_kind = self.seconds.get(unit.kind)
        if earlier is not None or of_kind:
            return earlier if earlier is not None else sum(of_kind) / len(of_kind)
        return unit.expected_s * pace_of(self.pairs) if unit.expected_s else None

    def _wait(self, process, waiting, begin):
        """Returns the exit status; says meanwhile how far it is."""
        while True:
            try:
                return process.wait(SECONDS_APART)
            except subprocess.TimeoutExpired:
                words = last_words(self.store.log(waiting[0])) or "begun"
                rest = self._rest(waiting, time.monotonic() - begin, seconds_said(words))
                self.tell(f"    {words}; all: {rest}")

    def _run_one(self, waiting):
        unit = waiting[0]
        self.store.begin(unit)
        begin = time.monotonic()
        with open(self.store.log(unit), "w") as log:
            try:
                process = subprocess.Popen(self.store.command(unit), stdin=subprocess.DEVNULL, stdout=log,
                                           stderr=subprocess.STDOUT, start_new_session=True)  # fmt: skip
            except OSError as error:
                raise UnitFailed(f"{unit.name}: {error}") from error
            try:
                status = self._wait(process, waiting, begin)
            except BaseException:
                end(process)
                raise
        self._check(unit, status)
        seconds = time.monotonic() - begin
        self.seconds.setdefault(unit.kind, []).append(seconds)
        if unit.expected_s:
            self.pairs.append((seconds, unit.expected_s))
        self.store.finish(unit, seconds)

    def _check(self, unit, status):
        log = self.store.log(unit)
        if status == 0 and self.store.part(unit).exists():
            return
        for line in log.read_text(errors="replace").splitlines()[-LOG_TAIL:]:
            print(f"  {line}", file=sys.stderr)
        reason = "wrote nothing" if status == 0 else f"exit status {status}"
        raise UnitFailed(f"{unit.name}: {reason}; its words are in {log}")


@contextlib.contextmanager
def locked(out):
    """Two runs in one folder would remove each other's files."""
    out.mkdir(parents=True, exist_ok=True)
    with open(out / ".lock", "w") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise UnitFailed(f"{out}: another run is writing there") from None
        yield


@contextlib.contextmanager
def command_in(out):
    """Runs what a command does in its folder, alone there: a failure is one line, and the last line says that it is done."""
    try:
        with locked(out):
            yield
    except (UnitFailed, ProcessFailed) as error:
        die(error)
    except KeyboardInterrupt:
        die(INTERRUPTED)
    step("done")


def main(parse, targets, network, study):
    """The command of a study: `parse` reads its words, `targets(options)` are built, `network(options)` enters the network that
    is measured on, and run(options) of the module `study`, which needs what has been installed by then, does the work."""
    try:
        options = parse(sys.argv[1:])
        options.programs = pathlib.Path(prepare(options, targets(options)))
        options.network = network(options)
        with command_in(options.out):
            importlib.import_module(study).run(options)
    except UnitFailed as error:  # of what the words name
        die(error)
    except ModuleNotFoundError as error:
        if error.name != "houghstream":
            raise
        die(f"{options.programs}: no Python package houghstream belongs to these programs, expected python/ beside their folder")
    except KeyboardInterrupt:  # while that is read, or programs are built
        die(INTERRUPTED)


def make(store, fresh=False, after_s=0.0):
    """Everything of the store that is not current; `after_s` are the expected seconds of what follows."""
    units = list(store.units.values())
    store.require_programs()
    for unit in units if fresh else ():
        store.forget(unit)
    Runner(store, after_s=after_s).run(units)
