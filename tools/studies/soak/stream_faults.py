"""Faults of the processes of a stream, of its disk and of its files."""

import os
import shutil
import signal
import subprocess
import time

from studies.soak.faults import HEARD, RESULTS, Faults, said
from studies.soak.wire import Listener, bus


class StreamFaults(Faults):
    """Each function is one fault; it returns what it saw, with "good"."""

    def strike(self, stream, listener, child, number, limit_s):
        """A signal to one process, and how long until the first result of the one that takes its place."""
        channel = RESULTS[child]
        self.wait_for(stream, rf"{child} [1-9][\d.]* Hz", 60)
        pid = int(self.wait_for(stream, rf"{child} started, process (\d+)", 10).group(1))
        earlier = listener.senders(channel)
        start = time.monotonic()
        os.kill(pid, number)
        first = listener.wait_for(channel, lambda one: one.sender not in earlier, limit_s + 20)
        if first is None:
            stream.fail(f"has brought no result of hs-{child} within {limit_s + 20} s")
        return {"back_after_s": round(first.time - start, 2),
                "reported": said(stream, rf"{child} (was killed|hung|has said nothing)")[-2:],
                "load": round(os.getloadavg()[0], 1)}  # fmt: skip

    def struck(self, name, number, limit_s, *known):
        """A signal to each process in turn."""
        stream = self.stream(self.folder(name), *known)
        listener = Listener(HEARD, RESULTS.values())
        seen = {}
        try:
            for child in ("detect", "pose", "capture"):
                seen[child] = self.strike(stream, listener, child, number, limit_s)
            stream.stop(10.0)
        finally:
            stream.kill()
            listener.stop()
        back = {child: one["back_after_s"] for child, one in seen.items()}
        return {"back_after_s": back, "limit_s": limit_s, "load": max(one["load"] for one in seen.values()),
                "reported": sum((one["reported"] for one in seen.values()), []),
                "good": all(time_s <= limit_s for time_s in back.values())}  # fmt: skip

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
        return {"status": result.returncode, "reported": words[-1:], "left": result.stdout.split(),
                "good": result.returncode != 0 and result.stdout.split() == ["old", "log"]}  # fmt: skip

    def unreadable(self):
        """A forest that is cut, models that are cut: refused in one line, soon."""
        folder = self.folder("unreadable")
        cut = folder / "cut.forest"
        cut.write_bytes((self.data / "forest").read_bytes()[:-1000])
        models = folder / "models"
        shutil.copytree(self.models, models)
        mesh = sorted(models.glob("*.ply"))[0]
        mesh.write_bytes(mesh.read_bytes()[:-3000])
        seen = {}
        for name, words in (("hs-detect", ["--forest", cut]), ("hs-pose", ["--models", models])):
            start = time.monotonic()
            result = subprocess.run([self.programs / name, *words, "-l", bus(HEARD)], capture_output=True, text=True,
                                    timeout=60, check=False)  # fmt: skip
            lines = [line for line in result.stderr.splitlines() if line.startswith(f"{name}: ")]
            seen[name] = {"status": result.returncode, "said": lines, "s": round(time.monotonic() - start, 2)}
        return {"ended_after_s": {name: one["s"] for name, one in seen.items()},
                "reported": sum((one["said"] for one in seen.values()), []),
                "good": all(one["status"] == 1 and len(one["said"]) == 1 for one in seen.values())}  # fmt: skip

    def all(self):
        yield "each process killed (kill -9)", lambda: self.struck("killed", signal.SIGKILL, 3.0)
        if self.objects:
            yield f"each process killed (kill -9), {self.objects.name}", lambda: self.struck(
                "killed_objects", signal.SIGKILL, 3.0, "--objects", self.objects)
        yield "each process stopped (SIGSTOP)", lambda: self.struck("stopped", signal.SIGSTOP, 2.0 + 1.5 + 3.0)
        yield "a full disk", self.full_disk
        yield "a cut forest, a cut mesh", self.unreadable
