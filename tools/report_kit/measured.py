"""Reading what was measured, and on which machine."""

import csv
import json
import os


def read_json(file):
    with open(file) as text:
        return json.load(text)


def read_csv(file):
    with open(file, newline="") as text:
        return list(csv.DictReader(text))


def cpu_name():
    with open("/proc/cpuinfo") as text:
        names = [line.split(":", 1)[1].strip() for line in text if line.startswith("model name")]
    return f"{names[0] if names else 'unknown processor'}, {len(os.sched_getaffinity(0))} cores used"
