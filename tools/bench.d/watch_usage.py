"""Watches processes until asked to stop: CPU time and resident memory, from /proc, into a JSON file.

Usage: watch_usage.py OUT.json NAME=PID..."""

import json
import os
import pathlib
import signal
import sys
import time

PERIOD_S = 0.5


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
    """One process from the first sample to the last."""

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


def summary(usages):
    return {
        "cpu_cores": round(sum(usage.cores() for usage in usages.values()), 3),
        "cores": {name: round(usage.cores(), 3) for name, usage in usages.items()},
        "rss_mb": {name: usage.memory() for name, usage in usages.items()},
    }


def main():
    out = pathlib.Path(sys.argv[1])
    pids = {name: int(pid) for name, _, pid in (argument.partition("=") for argument in sys.argv[2:])}
    usages = {name: Usage() for name in pids}
    stopped = []
    for name in (signal.SIGINT, signal.SIGTERM):
        signal.signal(name, lambda *_: stopped.append(True))
    while not stopped:
        for name, pid in pids.items():
            usages[name].add(time.monotonic(), cpu_seconds(pid), resident_mb(pid))
        time.sleep(PERIOD_S)
    out.write_text(json.dumps(summary(usages), indent=2) + "\n")


if __name__ == "__main__":
    main()
