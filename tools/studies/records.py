"""Reading and writing what was measured, and saying where, when and of which commit it was."""

import csv
import datetime
import functools
import json
import os
import pathlib
import subprocess

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]


def read_json(file):
    with open(file) as text:
        return json.load(text)


def read_json_if_any(file):
    return read_json(file) if file.is_file() else None


def read_csv(file):
    with open(file, newline="") as text:
        return list(csv.DictReader(text))


def write_atomically(file, text):
    file.parent.mkdir(parents=True, exist_ok=True)
    part = file.with_name(file.name + ".part")
    part.write_text(text)
    os.replace(part, file)


def write_json(file, value):
    write_atomically(file, json.dumps(value, indent=2) + "\n")


def percentiles(values, of=(50, 95, 99), unit=""):
    """{"p50": ...} of some values; None where there are none."""
    ordered = sorted(values)
    last = len(ordered) - 1
    return {f"p{p}{unit}": round(ordered[min(last, p * len(ordered) // 100)], 2) if ordered else None for p in of}


def threads():
    """Returns the number of threads that this process may use, like nproc."""
    return len(os.sched_getaffinity(0))


def cpu_name():
    with open("/proc/cpuinfo") as text:
        names = [line.split(":", 1)[1].strip() for line in text if line.startswith("model name")]
    return f"{names[0] if names else 'unknown processor'}, {threads()} cores used"


@functools.cache
def commit_name():
    """The commit that was checked out when this was first asked for, twelve digits; with "-dirty" where files differ from it,
    other than the results that are written of it; "unknown" of an installed Houghstream."""
    git = ["git", "-C", str(REPOSITORY)]
    written = [":!tools/studies/RESULTS.md", ":!tools/studies/pictures"]
    try:
        told = subprocess.run([*git, "rev-parse", "--short=12", "HEAD"], capture_output=True, text=True, check=False)
        differs = subprocess.run([*git, "diff", "--quiet", "HEAD", "--", ".", *written], capture_output=True, check=False)
    except FileNotFoundError:  # no git
        return "unknown"
    if told.returncode != 0:
        return "unknown"
    return told.stdout.strip() + ("-dirty" if differs.returncode != 0 else "")


def today():
    return datetime.date.today().isoformat()


def about(command):
    """Returns what stands beside every figure: machine, commit, date, and the command that measures it."""
    return {"cpu": cpu_name(), "commit": commit_name(), "date": today(), "command": command}


def train_seconds(log):
    """Returns the value of the last line "train_seconds X" of a trainer's words, or None."""
    values = [line.split()[1] for line in log.read_text().splitlines() if line.startswith("train_seconds ")]
    return float(values[-1]) if values else None


def relative(value, reference):
    """Change relative to the reference, -0.25 for a quarter less; None where either is unknown."""
    return None if value is None or not reference else value / reference - 1.0


def ratio(value, reference):
    return None if value is None or not reference else value / reference


def mean_of(values):
    """None where any is unknown: a mean of what happens to be there compares with nothing."""
    values = list(values)
    return None if not values or None in values else sum(values) / len(values)


def rounded(value):
    """Rounds for people who read the file: four digits behind the point, at any depth."""
    if isinstance(value, float):
        return round(value, 4)
    if isinstance(value, dict):
        return {key: rounded(item) for key, item in value.items()}
    return [rounded(item) for item in value] if isinstance(value, list) else value
