"""Adds up one run of tools/demo: writes summary.json and report.html into its folder and prints a table."""

import argparse
import json
import pathlib
import shutil
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "report_kit"))

import page
from measured import cpu_name, read_csv, read_json


def train_seconds(data):
    for line in (data / "forest.words").read_text().splitlines():
        if line.startswith("train_seconds "):
            return float(line.split()[1])
    sys.exit(f"report.py: {data / 'forest.words'}: no line 'train_seconds', expected hs-train's output")


def account(sent, observed):
    """What became of every frame that was sent, by the detector's own count. Exits where it does not add up."""
    detector = observed["processes"].get("hs-detect")
    if detector is None:
        sys.exit("report.py: hs-detect has sent no status, so the frames cannot be accounted for")
    counts = {
        "frames_sent": sent,
        "frames_received": detector["received"],
        "frames_detected": detector["processed"],
        "frames_skipped": detector["skipped"],
        "frames_lost": sent - detector["received"],
    }
    accounted = counts["frames_detected"] + counts["frames_skipped"] + counts["frames_lost"]
    if accounted != sent:
        sys.exit(f"report.py: {sent} frames sent, but detected + skipped + lost = {accounted}: {counts}, {detector}")
    if observed["frames_detected"] != counts["frames_detected"]:
        sys.exit(f"report.py: hs-detect published {counts['frames_detected']} results, the bus carried {observed['frames_detected']}")
    return counts


def commands(data):
    """How each piece of data was made: the first line of its stamp."""
    return {file.stem: file.read_text().splitlines()[0] for file in sorted(data.glob("*.stamp"))}


def clutter(folder):
    evaluation = read_json(folder / "evaluation" / "summary.json")
    return {key: evaluation[key] for key in ("frames_processed", "false_detections", "false_per_frame")}


def summarise(out, arguments):
    stream = out / "stream"
    observed = read_json(stream / "observe.json")
    evaluation = read_json(stream / "evaluation" / "summary.json")
    summary = account(int((stream / "frames_sent").read_text()), observed)
    summary["rate_hz"] = observed["detection_rate_hz"]
    summary["latency_ms"] = observed["latency_ms"]
    summary["auc"] = {name: value for name, value in evaluation["auc"].items() if name != "weighted"}
    summary["pose_recall_add_s_10"] = evaluation["pose_recall_add_s_10"]
    summary["train_seconds"] = train_seconds(out / "data")
    if (out / "clutter_stream").is_dir():
        summary["clutter"] = clutter(out / "clutter_stream")
    summary["cpu"] = cpu_name()
    summary["commit"] = arguments.commit
    summary["settings"] = {
        "source": arguments.source,
        "network": arguments.network,
        "evaluation": evaluation["rules"],
        "commands": commands(out / "data"),
    }
    return summary


def show(value, form="{:.3f}"):
    return "-" if value is None else form.format(value)


def print_table(summary):
    print(f"\n{'object':<16}{'AUC':>8}{'ADD-S recall':>14}")
    for name, auc in summary["auc"].items():
        print(f"{name:<16}{show(auc):>8}{show(summary['pose_recall_add_s_10'].get(name)):>14}")
    print(f"\n{'latency, ms':<16}{'p50':>8}{'p95':>8}{'p99':>8}")
    for stage, latency in summary["latency_ms"].items():
        print(f"{stage:<16}" + "".join(f"{show(latency[p], '{:.1f}'):>8}" for p in ("p50", "p95", "p99")))
    print(
        "\nframes: {frames_sent} sent = {frames_detected} detected + {frames_skipped} skipped + {frames_lost} lost;"
        " {rate_hz:.1f} results a second; trained in {train_seconds:.0f} s".format(**summary)
    )
    if "clutter" in summary:
        print("clutter: {false_detections} detections, all false, on {frames_processed} frames: "
              "{false_per_frame} a frame".format(**summary["clutter"]))
    print(f"{summary['cpu']}; commit {summary['commit']}\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--source", required=True, help="what was replayed, in words")
    parser.add_argument("--commit", required=True)
    parser.add_argument("--network", required=True, help="private or shared, in words")
    arguments = parser.parse_args()
    out = arguments.out
    summary = summarise(out, arguments)
    (out / "summary.json").write_text(json.dumps(summary, indent=2) + "\n")
    for name in ("overlay.png", "overlay.mp4"):
        shutil.copyfile(out / "stream" / name, out / name)
    evaluation = read_json(out / "stream" / "evaluation" / "summary.json")
    curves = read_csv(out / "stream" / "evaluation" / "curves.csv")
    times = read_csv(out / "stream" / "frame_times.csv")
    (out / "report.html").write_text(page.render(out, summary, evaluation, curves, times))
    print_table(summary)
    print(f"{out}/report.html, {out}/summary.json, {out}/overlay.png, {out}/overlay.mp4")


if __name__ == "__main__":
    main()
