"""Adds up what tools/bench has measured of time: writes summary.json and report.html into its folder.

Beside the run's own figures stand those of earlier releases, tools/bench.d/history.json: a list of
{"date", "commit", "cpu", "realtime_ms", "paper_ms", "linemod_ms", "latency_p50_ms"}."""

import argparse
import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "report_kit"))

import speed_page
from measured import cpu_name, read_json
from speed_summary import summarise

HISTORY = pathlib.Path(__file__).resolve().parent / "history.json"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--commit", required=True)
    arguments = parser.parse_args()
    out = arguments.out
    summary = {**summarise(out), "cpu": cpu_name(), "commit": arguments.commit}
    (out / "summary.json").write_text(json.dumps(summary, indent=2) + "\n")
    (out / "report.html").write_text(speed_page.render(summary, read_json(HISTORY)))
    print(speed_page.glance(summary))
    print(f"{out}/report.html, {out}/summary.json")


if __name__ == "__main__":
    main()
