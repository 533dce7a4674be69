"""Times of stores that are compared: hs-evaluate looks at the same frames with one store after the other, in several rounds,
so that whatever else the machine does meanwhile meets all of them. OUT is {STORE: {"detect_ms": [...], "pose_ms": [...]}}.

Usage: rounds.py --program HS_EVALUATE --out FILE --rounds N --store NAME=FOLDER ... -- WORDS OF HS-EVALUATE"""

import argparse
import csv
import json
import pathlib
import subprocess
import sys
import tempfile

COLUMNS = ("detect_ms", "pose_ms")


def frame_times(file):
    """The columns of frames.csv, without frames that have none."""
    with open(file, newline="") as text:
        rows = list(csv.DictReader(text))
    return {column: [float(row[column]) for row in rows if row[column]] for column in COLUMNS}


def look(program, store, words):
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run([program, "--objects", store, "--out", folder, *words], check=False)
        if done.returncode != 0:
            sys.exit(f"{program}: exit status {done.returncode} with {store}")
        return frame_times(pathlib.Path(folder) / "frames.csv")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", required=True)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--rounds", type=int, required=True)
    parser.add_argument("--store", action="append", default=[], required=True)
    parser.add_argument("words", nargs="+")
    options = parser.parse_args()
    stores = dict(store.split("=", 1) for store in options.store)
    times = {name: {column: [] for column in COLUMNS} for name in stores}
    for number in range(options.rounds):
        for name, store in stores.items():
            print(f"round {number + 1} of {options.rounds}, store of {name}", flush=True)
            for column, values in look(options.program, store, options.words).items():
                times[name][column] += values
    options.out.write_text(json.dumps(times) + "\n")


if __name__ == "__main__":
    main()
