"""Processes on an LCM bus, frames that are sent to them, and what they cost: the one stream runner of the demo, the
benchmarks and the tests."""

import dataclasses
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import threading
import time

from studies.records import threads

URL = "udpm://239.255.76.67:7667?ttl=0"
LAST_WORDS = 20  # lines


class ProcessFailed(Exception):
    pass


def unshare():
    """The words that start a command in a network namespace of its own, or None where that is not allowed. Root does
    without a user namespace, and so keeps the right to raise a priority."""
    for words in (["unshare", "-n"], ["unshare", "-rn"]):
        if subprocess.run([*words, "true"], capture_output=True, check=False).returncode == 0:
            return words
    return None


def enter_private_network():
    """Starts this program again inside a network namespace that carries multicast; where that is not allowed, goes on
    in the machine's, on a port of its own. Returns which, in words."""
    entered = os.environ.get("HOUGHSTREAM_PRIVATE_NETWORK")
    if entered:
        return entered
    words = unshare()
    if words:
        os.environ.update(HOUGHSTREAM_PRIVATE_NETWORK="private", LCM_DEFAULT_URL=URL)
        set_up = 'ip link set lo up multicast on && ip route add 224.0.0.0/4 dev lo && exec "$@"'
        command = [*words, "sh", "-c", set_up, "sh", sys.executable, *sys.orig_argv[1:]]
        sys.stdout.flush()
        os.execvp(command[0], command)
    print("a private network is refused (user namespaces are off): using the machine's own", flush=True)
    os.environ["LCM_DEFAULT_URL"] = f"udpm://239.255.76.67:{20000 + os.getpid() % 20000}?ttl=0"
    return "the machine's own, port of its own"


def enter_shared_network():
    """The machine's own bus, on which others listen."""
    os.environ.setdefault("LCM_DEFAULT_URL", URL)
    return "shared"


def enter_network(options):
    return enter_shared_network() if options.shared_bus else enter_private_network()


class Process:
    """A process in the background, what it says in FOLDER/NAME.txt."""

    def __init__(self, folder, *command, name=None, **more_environment):
        self.name = name or os.path.basename(command[0])
        self.log = pathlib.Path(folder) / f"{self.name}.txt"
        with open(self.log, "w", encoding="utf-8") as log:
            self.process = subprocess.Popen([str(part) for part in command], stdout=log, stderr=subprocess.STDOUT,
                                            env={**os.environ, **more_environment})  # fmt: skip

    def fail(self, complaint):
        words = self.log.read_text(errors="replace").splitlines()[-LAST_WORDS:]
        raise ProcessFailed("\n  ".join([f"{self.name} {complaint}; its words, {self.log}, end:", *words]))

    def runs(self):
        return self.process.poll() is None

    def wait_until_ready(self, seconds=30):
        end = time.monotonic() + seconds
        while "ready" not in self.log.read_text(errors="replace"):
            if not self.runs():
                self.fail("ended before it was ready")
            if time.monotonic() > end:
                self.fail(f"is not ready after {seconds} s")
            time.sleep(0.02)

    def wait(self, seconds):
        try:
            status = self.process.wait(seconds)
        except subprocess.TimeoutExpired:
            self.kill()
            self.fail(f"did not end within {seconds} s")
        if status != 0:
            self.fail(f"ended with status {status}")

    def ask_to_end(self):
        """Ends it as a user does, with Ctrl-C."""
        self.process.send_signal(signal.SIGINT)

    def stop(self, seconds=3.0):
        """Asks it to end; it has one second, and two more where others share the processor."""
        self.ask_to_end()
        self.wait(seconds)

    def kill(self):
        if self.runs():
            self.process.kill()
            self.process.wait()


class Processes:
    """The processes of one run, by name. Use with `with`: what still runs at its end is killed."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)
        self.by_name = {}

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for process in self.by_name.values():
            process.kill()

    def start(self, name, *command, **more_environment):
        self.by_name[name] = Process(self.folder, *command, name=name, **more_environment)
        return self.by_name[name]

    def stop(self, *names, seconds=10.0):
        """All are asked at once."""
        for name in names:
            self.by_name[name].ask_to_end()
        for name in names:
            self.by_name[name].wait(seconds)


def virtual_camera_of(programs):
    """LD_LIBRARY_PATH of a process that is to see the virtual camera: built beside the programs, or installed with them."""
    built = programs.parent / "virtual_camera"
    installed = programs.parent.glob("lib/**/houghstream/virtual_camera")
    return str(built if built.is_dir() else next(installed, built))


def cpu_seconds(pid, proc=pathlib.Path("/proc")):
    """CPU time of all threads so far. The name of a process may hold spaces and brackets: count from the last one."""
    fields = (proc / str(pid) / "stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def resident_mb(pid, proc=pathlib.Path("/proc")):
    for line in (proc / str(pid) / "status").read_text().splitlines():
        if line.startswith("VmRSS:"):
            return int(line.split()[1]) / 1024
    raise ProcessLookupError(f"process {pid} has no memory any more")


class Usage:
    """The cost of one process, from the first sample to the last."""

    def __init__(self):
        self.samples = []  # (time, CPU seconds, MB)

    def add(self, now, cpu_s, mb):
        self.samples.append((now, cpu_s, mb))

    def cores(self):
        (t0, cpu0, _), (t1, cpu1, _) = self.samples[0], self.samples[-1]
        return (cpu1 - cpu0) / (t1 - t0) if t1 > t0 else 0.0

    def memory(self):
        """Megabytes: a quarter of the way through, when everything has been used once, at the end, and the most."""
        mb = [sample[2] for sample in self.samples]
        return {"early": round(mb[len(mb) // 4], 1), "end": round(mb[-1], 1), "most": round(max(mb), 1)}


class UsageWatch:
    """Samples processes, by name, in a thread of its own until asked for the summary."""

    PERIOD_S = 0.5

    def __init__(self, processes):
        self.pids = {name: process.process.pid for name, process in processes.items()}
        self.usages = {name: Usage() for name in processes}
        self.stopped = threading.Event()
        self.thread = threading.Thread(target=self._watch, daemon=True)
        self.thread.start()

    def _watch(self):
        while not self.stopped.is_set():
            try:
                for name, pid in self.pids.items():
                    self.usages[name].add(time.monotonic(), cpu_seconds(pid), resident_mb(pid))
            except (FileNotFoundError, ProcessLookupError):
                return  # one has ended; what that means is told by who waits for it
            self.stopped.wait(self.PERIOD_S)

    def summary(self):
        self.stopped.set()
        self.thread.join()
        return {
            "cpu_cores": round(sum(usage.cores() for usage in self.usages.values()), 3),
            "cores": {name: round(usage.cores(), 3) for name, usage in self.usages.items()},
            "rss_mb": {name: usage.memory() for name, usage in self.usages.items()},
        }


@dataclasses.dataclass(frozen=True)
class Stream:
    """hs-detect, hs-pose and, where asked for, hs-track, each a process, and hs-observe, which stamps what goes by: OUT/observe.json,
    OUT/frame_times.csv, and what the processes say in OUT/log."""

    programs: pathlib.Path
    forest: pathlib.Path
    models: pathlib.Path  # a BOP models folder, or None
    frames: int  # that will be sent
    out: pathlib.Path
    detect: tuple = ()  # further options
    pose: tuple = ()
    show: bool = False  # hs-view's images and video, and the results as an LCM log
    watch: bool = False  # what finding the objects costs: OUT/usage.json
    detect_threads: int = 0  # 0: as many as this process may use
    track: bool = False  # hs-track too

    @property
    def finders(self):
        """The processes that are measured."""
        return ("detect", "pose", *(["track"] if self.track else []))

    @property
    def with_models(self):
        return ("--models", self.models) if self.models else ()

    def play(self, *sender, **more_environment):
        """Sends the frames by a command, and waits until all is quiet. Raises ProcessFailed."""
        shutil.rmtree(self.out, ignore_errors=True)
        with Processes(self.out / "log") as running:
            self._start(running)
            usage = UsageWatch({name: running.by_name[name] for name in self.finders}) if self.watch else None
            player = running.start("player", *sender, **more_environment)
            player.wait(None)
            self._await_observer(running.by_name["observe"])
            if usage:
                (self.out / "usage.json").write_text(json.dumps(usage.summary(), indent=2) + "\n")
            running.stop("observe", *(["logger"] if self.show else []), *reversed(self.finders))
            if self.show:
                running.stop("view", seconds=120)  # draws what still waits; on a busy machine that takes a while

    def _start(self, running):
        programs = pathlib.Path(self.programs)
        running.start("detect", programs / "hs-detect", "--forest", self.forest, "--threads",
                      self.detect_threads or threads(), *self.detect)  # fmt: skip
        running.start("pose", programs / "hs-pose", *self.with_models, *self.pose)
        if self.track:
            running.start("track", programs / "hs-track", *self.with_models)
        running.start("observe", programs / "hs-observe", "--expect", self.frames, "--out", self.out / "observe.json",
                      "--csv", self.out / "frame_times.csv", "--replace")  # fmt: skip
        if self.show:
            running.start("view", programs / "hs-view", *self.with_models, "--snapshot", self.out / "overlay.png",
                          "--after", self.frames // 9 + 1, "--video", self.out / "overlay.mp4", "--pictures",
                          self.out / "pictures", "--replace")  # fmt: skip
            running.start("logger", "lcm-logger", "-f", f"--lcm-url={self._logger_url()}", "-c", "HOUGHSTREAM_.*",
                          self.out / "results.lcmlog")  # fmt: skip
        for name in running.by_name.keys() - {"logger"}:
            running.by_name[name].wait_until_ready()
        if self.show:
            time.sleep(0.5)  # lcm-logger does not say when it listens

    @staticmethod
    def _logger_url():
        """Our processes ask for a large enough receive buffer by themselves; the logger has to be told. Frames fill it
        though only results are recorded: what arrives is sorted out later."""
        url = os.environ["LCM_DEFAULT_URL"]
        return url + "&recv_buf_size=4194304" if url.startswith("udpm:") and "?" in url else url

    @staticmethod
    def _await_observer(observer):
        """He ends by himself when all frames have come and the bus is quiet; where one was lost he is asked to."""
        end = time.monotonic() + 8.0
        while observer.runs() and time.monotonic() < end:
            time.sleep(0.1)
