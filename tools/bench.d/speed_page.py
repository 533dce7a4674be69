"""The report on time as one HTML page that needs no network, and a few lines of it for the terminal."""

import html

from charts import Chart
from html_parts import STYLE, show, table

WORDS = {
    "realtime": "realtime profile, all threads",
    "paper": "paper profile, all threads",
    "serial": "realtime profile, reference engine, one thread",
    "gall": "gall profile, reference engine, one thread",
}
STAGES = (
    *("detect.resize", "detect.features", "detect.leaves", "detect.votes", "detect.evidence", "detect.suppression"),
)


def milliseconds(value):
    return show(value, "{:.2f}")


def detection_rows(summary):
    rows = [(words, milliseconds(summary["detect_ms"][name]), show(summary["auc"].get(name))) for name, words in WORDS.items()]
    rows.append(("OpenCV's LINEMOD, all threads", milliseconds(summary["linemod_ms"]), show(summary["auc"]["linemod"])))
    rows.append(("gall profile, fast engine, one thread", milliseconds(summary["gall_fast_engine_ms"]), "–"))
    return rows


def stage_rows(summary):
    stages = summary["stage_ms"]
    return [(name, *(milliseconds(stages[name].get(stage)) for stage in STAGES)) for name in stages]


def stream_rows(summary):
    rows = []
    for name, run in summary["streams"].items():
        if run is None:
            continue
        latency, frames = run["latency_ms"], run["frames"]
        memory = ", ".join(f"{process} {mb['most']:.0f}" for process, mb in run["rss_mb"].items())
        rows.append(
            (
                name, *(milliseconds(latency[key]) for key in ("p50", "p95", "p99")), frames["sent"], frames["lost"],
                frames["skipped"], show(run["cpu_cores"], "{:.2f}"), memory,
            )  # fmt: skip
        )
    return rows


def growth_chart(name, points, x_label):
    if len(points) < 2:
        return ""
    chart = Chart(x_label, "ms a frame", max(x for x, _ in points) * 1.05, max(y for _, y in points) * 1.1, name)
    chart.line(name, points)
    chart.dots("measured", points, radius=4)
    return chart.svg()


def growth_section(summary):
    series = (("objects", "objects taught"), ("trees", "trees"), ("pixels", "pixels of the frame"))
    charts = [growth_chart(name, summary[name], label) for name, label in series]
    charts.append(growth_chart("threads", summary["threads"], "threads"))
    if not any(charts):
        return []
    powers = ", ".join(f"{name} to the power of {show(power, '{:.2f}')}" for name, power in summary["exponents"].items())
    return [
        "<h2>How time grows</h2>",
        f"<p>Fitted to the points: time goes with {powers}. Twenty objects take"
        f" {show(summary['objects_20_over_4'], '{:.2f}')} times as long as four.</p>",
        '<div class="charts">' + "".join(charts) + "</div>",
    ]


def history_rows(summary, history):
    now = {
        "date": "this run", "commit": summary["commit"], "cpu": summary["cpu"], "realtime_ms": summary["detect_ms"]["realtime"],
        "paper_ms": summary["detect_ms"]["paper"], "linemod_ms": summary["linemod_ms"],
        "latency_p50_ms": (summary["latency_ms"] or {}).get("p50"),
    }  # fmt: skip
    keys = ("realtime_ms", "paper_ms", "linemod_ms", "latency_p50_ms")
    return [(run["date"], run["commit"], *(milliseconds(run[key]) for key in keys), run["cpu"]) for run in [*history, now]]


def simd_rows(summary):
    return [(name, milliseconds(ms)) for name, ms in summary["simd"].items()]


def render(summary, history):
    parts = [
        f"<!doctype html><html lang=en><meta charset=utf-8><title>Houghstream: speed</title><style>{STYLE}</style>",
        f"<h1>Speed</h1><p>{html.escape(summary['cpu'])}; commit {html.escape(summary['commit'])}</p>",
        "<h2>One frame, side by side</h2>",
        "<p>Medians of wall time over frames of 640x480; all look at a frame before any looks at the next. AUC: mean over"
        " the objects, on all frames of the scene.</p>",
        table(("", "ms a frame", "AUC"), detection_rows(summary)),
        f"<p>Against gall on one thread: {show(summary['speedup_over_gall'], '{:.0f}')} times as fast. Two threads against one:"
        f" {show(summary['speedup_of_two_threads'], '{:.2f}')}. On every twelfth frame the reference engine has AUC"
        f" {show(summary['auc']['serial_few'])}, the fast one {show(summary['auc']['realtime_few'])}.</p>",
        "<h2>Stages</h2>",
        table(("ms, median", *(stage.removeprefix("detect.") for stage in STAGES)), stage_rows(summary)),
        "<h2>Kernels, one thread</h2>",
        table(("", "ms"), [(name, milliseconds(ms)) for name, ms in summary["kernel_ms"].items()]),
        "<h2>Instruction sets, one thread</h2>",
        table(("", "ms a frame"), simd_rows(summary)),
        "<h2>Stream: frame message to pose message</h2>",
        "<p>One observer stamps both arrivals. CPU: cores in use by hs-detect and hs-pose together; memory: the most that"
        " was resident, MB.</p>",
        table(("frames", "p50 ms", "p95 ms", "p99 ms", "sent", "lost", "skipped", "CPU", "memory"), stream_rows(summary)),
        *growth_section(summary),
        "<h2>Releases</h2>",
        table(("", "commit", "realtime", "paper", "LINEMOD", "latency p50", "processor"), history_rows(summary, history)),
        "</html>",
    ]
    return "\n".join(parts)


def glance(summary):
    """What one wants to know first."""
    lines = [f"{words:<50}{ms:>10} ms   AUC {auc}" for words, ms, auc in detection_rows(summary)]
    for row in stream_rows(summary):
        lines.append(f"stream, {row[0]}: p50 {row[1]}, p99 {row[3]} ms; lost {row[5]}, skipped {row[6]} of {row[4]}; {row[7]} cores")
    for name in ("objects", "threads"):
        if summary[name]:
            lines.append(f"{name}: " + ", ".join(f"{n}: {ms:.1f} ms" for n, ms in summary[name]))
    return "\n".join(lines)
