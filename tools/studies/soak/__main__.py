"""Faults, one after another, and a long run; each with what was lost, how long until it was back, and what was said."""

import json
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import time

from studies.command import Options, die, positive, step
from studies.measured import REPOSITORY
from studies.soak.long_run import long_run
from studies.soak.relay import Relay, bus, rubbish
from studies.stream import Process, ProcessFailed, enter_private_network

SENT, HEARD = 7667, 7668  # ports
ACCOUNT = re.compile(r"ends: (\d+) received, (\d+) processed, (\d+) skipped, (\d+|unknown) lost, (\d+) refused"
                     r"(?:; (\d+) duplicates)?")  # fmt: skip


def account(process):
    """What a process says of its frames in the end."""
    found = ACCOUNT.search(process.log.read_text(errors="replace"))
    if not found:
        process.fail("has given no account")
    names = ("received", "processed", "skipped", "lost", "refused", "duplicates")
    return {name: int(count or 0) if count != "unknown" else 0 for name, count in zip(names, found.groups())}


def adds_up(sent, counts):
    return sent == counts["processed"] + counts["skipped"] + counts["lost"] + counts["refused"]


class Faults:
    """Each function is one fault; it returns what it saw, with "good"."""

    def __init__(self, options, out):
        self.programs = options.programs
        self.data = options.data
        self.frames = options.frames
        self.out = out

    def folder(self, name):
        folder = self.out / name
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        return folder

    def capture(self, folder, name, port, frames, *words):
        return Process(folder, self.programs / "hs-capture", "--source", f"bop:{self.data / 'scene'}", "--loop", "--frames",
                       frames, "--rate", 30, "-l", bus(port), *words, name=name)  # fmt: skip

    def detector(self, folder, *words):
        process = Process(folder, self.programs / "hs-detect", "--forest", self.data / "forest", "-l", bus(HEARD), *words)
        process.wait_until_ready()
        return process

    def counted(self, name, meanwhile=None, restarts=1, **faults):
        """Frames through the relay: those that were sent are those that are accounted for."""
        folder = self.folder(name)
        detector = self.detector(folder)
        passed = {}
        try:
            for run in range(restarts):
                relay = Relay(SENT, HEARD, self.frames, seed=run + 1, **faults)
                try:
                    capture = self.capture(folder, f"capture{run}", SENT, self.frames)
                    if meanwhile:
                        meanwhile()
                    capture.wait(60 + self.frames)
                    time.sleep(0.5)
                finally:
                    relay.stop()
                passed = {key: passed.get(key, 0) + count for key, count in relay.counts.items()}
            detector.stop(5.0)
        finally:
            detector.kill()
        counts = account(detector)
        sent = restarts * self.frames
        return {"sent": sent, "relay": passed, **counts, "good": adds_up(sent, counts)}

    def forged(self):
        """Rubbish and messages that name themselves frames, among them statuses of processes that do not exist."""
        draw = random.Random(5)
        payloads = [draw.randbytes(200) for _ in range(100)]

        def send():
            rubbish(HEARD, "HOUGHSTREAM_STATUS", payloads)
            rubbish(HEARD, "OPENNI_FRAME", payloads)

        seen = self.counted("forged", meanwhile=send)
        seen["good"] = seen["refused"] >= len(payloads) and adds_up(seen["sent"] + len(payloads), seen)
        return seen

    def stream(self, folder, *words):
        return Process(folder, self.programs / "hs-stream", "--source", f"bop:{self.data / 'scene'}",
                       "--capture-options=--loop", "--forest", self.data / "forest", "--models",
                       self.data / "training" / "models", "--no-view", "--every", "0.5", "--hang-patience", "2",
                       "-l", bus(HEARD), *words)  # fmt: skip

    @staticmethod
    def wait_for(process, pattern, seconds, since=0):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            found = list(re.finditer(pattern, process.log.read_text(errors="replace")[since:]))
            if found:
                return found[-1]
            time.sleep(0.02)
        process.fail(f"has not said '{pattern}' within {seconds} s")

    def struck(self, name, number, limit_s):
        """A signal to each process in turn, and how long until it is ready again."""
        folder = self.folder(name)
        stream = self.stream(folder)
        back = {}
        try:
            for child in ("detect", "pose", "capture"):
                self.wait_for(stream, rf"{child} [1-9][\d.]* Hz", 60)
                pid = int(self.wait_for(stream, rf"{child} started, process (\d+)", 10).group(1))
                before = len(stream.log.read_text(errors="replace"))
                start = time.monotonic()
                os.kill(pid, number)
                self.wait_for(stream, rf"{child} started, process \d+", limit_s + 20, since=before)
                if child != "capture":  # which says nothing when it begins
                    self.wait_for(stream, rf"hs-{child}: ready", limit_s + 20, since=before)
                back[child] = round(time.monotonic() - start, 2)
            stream.stop(10.0)
        finally:
            stream.kill()
        return {"back_after_s": back, "limit_s": limit_s, "good": all(time_s <= limit_s for time_s in back.values())}

    def reversed_start(self):
        """The camera first, the detector while frames go by."""
        folder = self.folder("reversed_start")
        capture = self.capture(folder, "capture", HEARD, self.frames)
        time.sleep(1.0)
        detector = self.detector(folder)
        try:
            capture.wait(60 + self.frames)
            time.sleep(0.5)
            detector.stop(5.0)
        finally:
            detector.kill()
        counts = account(detector)
        return {**counts, "good": counts["lost"] == 0 and adds_up(counts["received"], counts)}

    def full_disk(self):
        """A recording on a disk of four megabytes; the older recording of that name is untouched."""
        folder = self.folder("full_disk")
        small = folder / "small"
        small.mkdir()
        script = ('mount -t tmpfs -o size=4m tmpfs "$1" && echo old >"$1/log" && shift 1 && "$@"; status=$?; '
                  'cat "${0}/log"; ls "$0"; exit $status')  # fmt: skip
        command = [self.programs / "hs-capture", "--source", f"bop:{self.data / 'scene'}", "--loop", "--frames", 500,
                   "--raw-colour", "--log", small / "log"]  # fmt: skip
        result = subprocess.run(["unshare", "-rm", "sh", "-c", script, str(small), str(small), *map(str, command)],
                                capture_output=True, text=True, check=False)  # fmt: skip
        words = result.stderr.strip().splitlines()
        return {"status": result.returncode, "said": words[-1] if words else "",
                "left": result.stdout.split(), "good": result.returncode != 0 and result.stdout.split() == ["old", "log"]}

    def unreadable(self):
        """A forest that is cut, models that are cut: refused in one line, soon."""
        folder = self.folder("unreadable")
        cut = folder / "cut.forest"
        cut.write_bytes((self.data / "forest").read_bytes()[:-1000])
        models = folder / "models"
        shutil.copytree(self.data / "training" / "models", models)
        mesh = sorted(models.glob("*.ply"))[0]
        mesh.write_bytes(mesh.read_bytes()[:-3000])
        seen = {}
        for name, words in (("hs-detect", ["--forest", cut]), ("hs-pose", ["--models", models])):
            start = time.monotonic()
            result = subprocess.run([self.programs / name, *words, "-l", bus(HEARD)], capture_output=True, text=True,
                                    timeout=20, check=False)  # fmt: skip
            lines = [line for line in result.stderr.splitlines() if line.startswith(f"{name}: ")]
            seen[name] = {"status": result.returncode, "said": lines, "s": round(time.monotonic() - start, 2)}
        return {**seen, "good": all(one["status"] == 1 and len(one["said"]) == 1 for one in seen.values())}

    def all(self):
        yield "nothing", lambda: self.counted("nothing")
        yield "5 % of the frames lost", lambda: self.counted("lost", lose=0.05)
        yield "10 % overtaken", lambda: self.counted("overtaken", swap=0.1)
        yield "10 % doubled", lambda: self.counted("doubled", double=0.1)
        yield "all of it, and the camera started three times", lambda: self.counted(
            "mixed", restarts=3, lose=0.05, swap=0.1, double=0.1)
        yield "rubbish and forged statuses", self.forged
        yield "each process killed (kill -9)", lambda: self.struck("killed", signal.SIGKILL, 3.0)
        yield "each process stopped (SIGSTOP)", lambda: self.struck("stopped", signal.SIGSTOP, 2.0 + 1.5 + 3.0)
        yield "the camera before the detector", self.reversed_start
        yield "a full disk", self.full_disk
        yield "a cut forest, a cut mesh", self.unreadable


def run_faults(faults):
    summary = {}
    for name, fault in faults.all():
        try:
            summary[name] = fault()
        except (ProcessFailed, subprocess.SubprocessError, OSError) as error:
            summary[name] = {"good": False, "failed": str(error)}
        step(f"{'ok   ' if summary[name]['good'] else 'WRONG'} {name}: {json.dumps(summary[name])}")
    return summary


def page(summary):
    lines = ["# What the stream does under faults", ""]
    for name, seen in summary.get("faults", {}).items():
        lines.append(f"- **{name}**: {'as it should' if seen['good'] else 'WRONG'}; "
                     + ", ".join(f"{key} {value}" for key, value in seen.items() if key != "good"))
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
    options = parser.parse_args()
    options.data = pathlib.Path(options.data).resolve()
    options.programs = pathlib.Path(options.bin).resolve() if options.bin else pathlib.Path(REPOSITORY) / "build" / "bin"
    for needed in (options.data / "forest", options.data / "scene", options.data / "training" / "models",
                   options.programs / "hs-stream"):  # fmt: skip
        if not needed.exists():
            die(f"{needed}: missing, expected what tools/demo makes; run it first, or give --data and --bin")
    return options


def main():
    options = read_options()
    enter_private_network()
    out = pathlib.Path(options.out).resolve()
    out.mkdir(parents=True, exist_ok=True)
    summary = {"faults": run_faults(Faults(options, out))}
    if not options.faults_only:
        summary["long"] = long_run(options, out)
    (out / "summary.json").write_text(json.dumps(summary, indent=1) + "\n")
    (out / "report.md").write_text(page(summary))
    good = all(seen["good"] for seen in summary["faults"].values()) and summary.get("long", {"good": True})["good"]
    step(f"{out / 'report.md'}: {'all as it should be' if good else 'something is WRONG'}")
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
