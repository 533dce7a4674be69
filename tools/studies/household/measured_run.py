"""Runs a program to its end and says how long it took and how much memory, in OUT/run.json; what it makes lies in OUT.

Usage: measured_run.py --program PROGRAM --out DIR [--before STORE] [--drop] -- WORDS
--before: DIR/store begins as a copy of that store. --drop: what was made is removed again, only the measures stay."""

import argparse
import json
import os
import pathlib
import shutil
import subprocess
import sys
import time


def measured(command):
    """Returns exit status, seconds and the largest resident memory in megabytes."""
    begin = time.monotonic()
    process = subprocess.Popen(command)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    return process.returncode, time.monotonic() - begin, usage.ru_maxrss * 1024 / 1e6  # Linux counts in KiB


def remove_made(out):
    for path in out.iterdir():
        if path.is_dir():
            shutil.rmtree(path)
        else:
            path.unlink()


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", required=True)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--before", type=pathlib.Path)
    parser.add_argument("--drop", action="store_true")
    parser.add_argument("words", nargs="+")
    options = parser.parse_args()
    options.out.mkdir(parents=True)
    if options.before:
        shutil.copytree(options.before, options.out / "store")
    status, seconds, memory_mb = measured([options.program, *options.words])
    if status != 0:
        sys.exit(f"{options.program}: exit status {status}")
    if options.drop:
        remove_made(options.out)
    measures = {"seconds": round(seconds, 2), "memory_mb": round(memory_mb, 1)}
    (options.out / "run.json").write_text(json.dumps(measures, indent=2) + "\n")


if __name__ == "__main__":
    main()
