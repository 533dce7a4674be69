"""The report as one HTML page that needs no network: pictures inside it, the video beside it."""

import html
import json

from charts import Chart
from html_parts import STYLE, embedded, show, table

MOST_PICTURES = 24


def precision_recall_chart(curves):
    chart = Chart("recall", "precision", 1.0, 1.0)
    names = list(dict.fromkeys(row["object"] for row in curves))
    for name in names:
        points = [(float(row["recall"]), float(row["precision"])) for row in curves if row["object"] == name]
        chart.line(name, points)
    return chart.svg()


def latency_chart(times):
    """From the arrival of each frame to that of its detections and of its poses."""
    series = {"detections": "t_detections", "poses": "t_poses"}
    points = {
        name: [(float(row["t_frame"]), 1e3 * (float(row[key]) - float(row["t_frame"]))) for row in times if row["t_frame"] and row[key]]
        for name, key in series.items()
    }
    everything = [point for line in points.values() for point in line] or [(1.0, 1.0)]
    chart = Chart("stream time, s", "after the frame's arrival, ms", max(x for x, _ in everything), 1.1 * max(y for _, y in everything))
    for name, line in points.items():
        chart.dots(name, line)
    return chart.svg()


def objects_table(summary, evaluation):
    rows = []
    for name, auc in summary["auc"].items():
        rows.append(
            (
                name,
                evaluation["required"].get(name, ""),
                show(auc),
                show(evaluation["precision"].get(name)) if name in evaluation["precision"] else "",
                show(evaluation["recall"].get(name)) if name in evaluation["recall"] else "",
                show(summary["pose_recall_add_s_10"].get(name)),
            )
        )
    rows.append(("weighted by objects", "", show(evaluation["auc"]["weighted"]), "", "", ""))
    return table(("object", "there", "AUC", "precision", "recall", "ADD-S recall"), rows)


def frames_table(summary):
    keys = ("frames_sent", "frames_received", "frames_detected", "frames_skipped", "frames_lost")
    rows = [(key.replace("_", " "), summary[key]) for key in keys]
    rows += [("results a second", show(summary["rate_hz"], "{:.1f}")), ("training, s", show(summary["train_seconds"], "{:.0f}"))]
    if "clutter" in summary:
        clutter = summary["clutter"]
        rows += [("clutter: frames", clutter["frames_processed"]), ("clutter: detections, all false", clutter["false_detections"])]
        rows += [("clutter: false detections a frame", show(clutter["false_per_frame"]))]
    return table(("frames", ""), rows)


def latency_table(summary):
    rows = [(stage, *(show(latency[p], "{:.1f}") for p in ("p50", "p95", "p99"))) for stage, latency in summary["latency_ms"].items()]
    return table(("latency, ms", "p50", "p95", "p99"), rows)


def stages_table(evaluation):
    return table(("stage, median", "ms"), [(s, show(t, "{:.2f}")) for s, t in evaluation["stage_ms_median"].items()])


def contact_sheet(folder):
    """Pictures spread evenly over the stream."""
    pictures = sorted(folder.glob("*.jpg"))
    count = min(MOST_PICTURES if len(pictures) <= MOST_PICTURES else 8, len(pictures))
    chosen = [pictures[round(i * (len(pictures) - 1) / max(count - 1, 1))] for i in range(count)]
    return '<div class="sheet">' + "".join(embedded(file, "jpeg") for file in chosen) + "</div>"


def render(out, summary, evaluation, curves, times):
    source = html.escape(summary["settings"]["source"])
    clutter_pictures = out / "clutter_stream" / "pictures"
    parts = [
        f"<!doctype html><html lang=en><meta charset=utf-8><title>Houghstream: {source}</title><style>{STYLE}</style>",
        f"<h1>Houghstream</h1><p>{source}; {html.escape(summary['cpu'])}; commit {html.escape(summary['commit'])}</p>",
        embedded(out / "overlay.png", "png"),
        "<h2>What was found</h2>",
        "<p>AUC: area under the precision/recall curve, un-interpolated; a detection is true at IoU 0.5 or more, repeated ones are"
        " false. Frames that the detector passed over for a newer one are left out here and counted below. ADD-S recall: poses of"
        " true detections, at least half visible, within 10 % of the object's diameter.</p>",
        objects_table(summary, evaluation),
        f'<div class="charts">{precision_recall_chart(curves)}{latency_chart(times)}</div>',
        "<h2>How fast, and what became of every frame</h2>",
        "<p>Stamped by one observer on the bus: detect from the frame's arrival to that of its detections, pose from there to its"
        " poses, total from the frame to its poses.</p>",
        f'<div class="charts">{latency_table(summary)}{frames_table(summary)}{stages_table(evaluation)}</div>',
        '<h2>The stream</h2><video controls src="overlay.mp4"></video>',
        contact_sheet(out / "stream" / "pictures"),
        f"<h2>Clutter: no taught object is there</h2>{contact_sheet(clutter_pictures)}" if clutter_pictures.is_dir() else "",
        f"<h2>Settings</h2><pre>{html.escape(json.dumps(summary['settings'], indent=2))}</pre></html>",
    ]
    return "\n".join(parts)
