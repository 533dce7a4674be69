"""Teaches an object into a copy of a store, as a person does who teaches one after the other. OUT/store is the store
afterwards, the one before where the object was refused; OUT/taught.json says how it went.

Usage: add_object.py --program HS_TEACH --out DIR [--before STORE] -- WORDS OF HS-TEACH
The words name OUT/store as hs-teach's --out; --add is given where there is a store before."""

import argparse
import json
import pathlib
import shutil
import subprocess
import sys
import time

POOR, BAD_INPUT = 3, 1  # exit statuses of hs-teach that are an answer
SAID = 10  # lines of stderr


def teach(program, out, before, words):
    """Returns what hs-teach answered; raises where it ended otherwise."""
    if before and before.is_dir():
        shutil.copytree(before, out / "store")
        words = [*words, "--add"]
    begin = time.monotonic()
    done = subprocess.run([program, *words], capture_output=True, text=True, check=False)
    seconds = time.monotonic() - begin
    print(done.stderr, done.stdout, sep="\n", flush=True)
    if done.returncode not in (0, POOR, BAD_INPUT):
        sys.exit(f"{program}: exit status {done.returncode}")
    last = [line.rpartition("\r")[2] for line in done.stderr.splitlines() if line.strip()]
    return {"status": done.returncode, "seconds": round(seconds, 2), "said": last[-SAID:]}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", required=True)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--before", type=pathlib.Path)
    parser.add_argument("words", nargs="+")
    options = parser.parse_args()
    options.out.mkdir(parents=True)
    answer = teach(options.program, options.out, options.before, options.words)
    (options.out / "taught.json").write_text(json.dumps(answer, indent=2) + "\n")


if __name__ == "__main__":
    main()
