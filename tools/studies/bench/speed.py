"""The figures of tools/bench speed, stream and growth, None where a part has not been run: summary.json and report.html.

Beside the run's own figures stand those of earlier releases, history.json: a list of
{"date", "commit", "cpu", "realtime_ms", "paper_ms", "linemod_ms", "latency_p50_ms"}."""

import math
import pathlib

from studies.records import about, read_json, read_json_if_any, write_json
from studies.report.charts import Chart
from studies.report.page import render, show

HISTORY = pathlib.Path(__file__).resolve().parent / "history.json"
SETS = {"SSE4": "sse4", "AVX2": "avx2", "AVX3": "avx512"}  # Highway's names, and everybody's
PART_FOLDERS = {"speed": "speed", "stream": "stream_compressed", "growth": "growth"}
RANKED = "ranked: vote mass from 0.05, threshold 0"
WORDS = {  # what is timed beside its AUC: (words, settings of both)
    "realtime": ("realtime, fast engine, all threads", RANKED),
    "realtime_one_thread": ("realtime, fast engine, one thread", RANKED),
    "serial": ("realtime, reference engine, one thread", RANKED),
    "paper": ("paper, fast engine, all threads", RANKED),
    "gall_engine": ("gall (the original), fast engine, one thread", "its own: vote mass from 0.1, stride 1"),
    "gall": ("gall (the original), reference engine, one thread", "its own: vote mass from 0.1, stride 1"),
    "linemod": ("OpenCV's LINEMOD, all threads", "its own: similarity from 80 %, no check of depth"),
}
# Whose AUC was measured for it: threads and engine make no difference to what is found, and tests hold that.
AUC_OF = {"realtime_one_thread": "realtime", "serial": "realtime", "gall_engine": "gall"}


def median_ms(times, name):
    return times[name]["ms"]["p50"] if times and name in times else None


def quotient(a, b):
    return None if a is None or not b else round(a / b, 3)


def numbered(times, prefix, number=int):
    """[[n, median ms], ...] of the contenders called PREFIX_N, by n."""
    names = [name for name in times or {} if name.startswith(prefix + "_")]
    return sorted([number(name[len(prefix) + 1 :]), median_ms(times, name)] for name in names)


def exponent(points):
    """The power by which y grows with x: slope of the logarithms by least squares. None of fewer than two points."""
    if len(points) < 2:
        return None
    xs, ys = [math.log(x) for x, _ in points], [math.log(y) for _, y in points]
    x_mean, y_mean = sum(xs) / len(xs), sum(ys) / len(ys)
    spread = sum((x - x_mean) ** 2 for x in xs)
    return round(sum((x - x_mean) * (y - y_mean) for x, y in zip(xs, ys)) / spread, 3) if spread else None


def mean_auc(out, name):
    summary = read_json_if_any(out / "speed" / name / "summary.json")
    return None if summary is None else summary["auc"]["mean"]


def all_auc(out):
    auc = {name: mean_auc(out, name) for name in ("realtime", "paper", "gall", "realtime_few", "serial_few")}
    found = sorted((out / "speed" / "linemod").glob("*/summary.json"))
    return {**auc, "linemod": read_json(found[0])["auc"]["mean"] if found else None}


def default_point(out):
    """Precision and recall over all objects from the default score on."""
    summary = read_json_if_any(out / "speed" / "default" / "summary.json")
    if not summary:
        return {"precision": None, "recall": None}
    true = sum(round(count * (summary["recall"][name] or 0.0)) for name, count in summary["required"].items())
    found, there = true + summary["false_detections"], sum(summary["required"].values())
    return {"precision": quotient(true, found), "recall": quotient(true, there)}


def kernels(out):
    """Median CPU milliseconds on one thread, by kernel."""
    measured = read_json_if_any(out / "speed" / "kernels.json")
    runs = measured["benchmarks"] if measured else []
    return {run["run_name"]: round(run["cpu_time"], 3) for run in runs if run.get("aggregate_name") == "median"}


def detection(out):
    times = read_json_if_any(out / "speed" / "times.json")
    ms = {name: median_ms(times, name) for name in WORDS}
    auc = all_auc(out)
    threads = numbered(times, "threads")
    by_count = dict(map(tuple, threads))
    return {
        "detect_ms": {name: value for name, value in ms.items() if name != "linemod"},
        "linemod_ms": ms["linemod"],
        "auc": auc,
        "settings": {name: settings for name, (_, settings) in WORDS.items()},
        "speedup_over_gall_same_engine": quotient(ms["gall_engine"], ms["realtime_one_thread"]),
        "speedup_over_gall_whole_system": quotient(ms["gall"], ms["realtime"]),
        "speedup_over_linemod": quotient(ms["linemod"], ms["realtime"]),
        "auc_over_linemod": quotient(auc["realtime"], auc["linemod"]),
        "at_default": {"ms": by_count[max(by_count)] if by_count else None, **default_point(out)},
        "stage_ms": {name: times[name]["stage_ms"] for name in ("realtime", "paper") if times and name in times},
        "kernel_ms": kernels(out),
        "threads": threads,
        "speedup_of_two_threads": quotient(by_count.get(1), by_count.get(2)),
        "simd": {key: median_ms(times, f"set_{name}") for name, key in SETS.items()},
    }


def stream(folder):
    """Returns the figures of one replay, or None."""
    observed, usage = read_json_if_any(folder / "observe.json"), read_json_if_any(folder / "usage.json")
    if not observed or not usage:
        return None
    account = observed["account"]
    return {
        "latency_ms": observed["latency_ms"]["total"],
        "frames": {key: account[key] for key in ("sent", "lost", "skipped")},
        "with_poses": observed["frames_with_poses"],
        "cpu_cores": usage["cpu_cores"],
        "rss_mb": usage["rss_mb"],
    }


def streams(out):
    """The compressed frames' figures at the top, where they are looked for."""
    runs = {name: stream(out / f"stream_{name}") for name in ("compressed", "raw")}
    keys = ("latency_ms", "frames", "cpu_cores", "rss_mb")
    first = runs["compressed"] or dict.fromkeys(keys)
    return {**{key: first[key] for key in keys}, "streams": runs}


def growth(out):
    times = read_json_if_any(out / "growth" / "times.json")
    # pixels of a VGA frame, scaled
    sizes = [[round(640 * scale) * round(480 * scale), ms] for scale, ms in numbered(times, "scale", float)]
    series = {"objects": numbered(times, "objects"), "trees": numbered(times, "trees"), "pixels": sizes}
    at = dict(map(tuple, series["objects"]))
    return {
        **series,
        "objects_20_over_4": quotient(at.get(20), at.get(4)),
        "exponents": {name: exponent(points) for name, points in series.items()},
    }


def summarise(out):
    parts = {part: read_json_if_any(out / folder / "about.json") for part, folder in PART_FOLDERS.items()}
    return {**detection(out), **streams(out), **growth(out), "parts": parts}


def milliseconds(value):
    return show(value, "{:.2f}")


def detection_rows(summary):
    rows = []
    for name, (words, settings) in WORDS.items():
        ms = summary["linemod_ms"] if name == "linemod" else summary["detect_ms"][name]
        auc = summary["auc"][AUC_OF.get(name, name)]
        rows.append((words, milliseconds(ms), show(auc), settings))
    return rows


def stage_rows(summary):
    """The header first: the stages as the detectors name them."""
    stages = list(dict.fromkeys(stage for measured in summary["stage_ms"].values() for stage in measured))
    header = ("ms, median", *(stage.removeprefix("detect.") for stage in stages))
    return [header] + [
        (name, *(milliseconds(measured.get(stage)) for stage in stages))
        for name, measured in summary["stage_ms"].items()
    ]


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
                frames["skipped"], run["with_poses"], show(run["cpu_cores"], "{:.2f}"), memory,
            )  # fmt: skip
        )
    return rows


def growth_charts(summary):
    labels = {"objects": "objects taught", "trees": "trees", "pixels": "megapixels of the frame", "threads": "threads"}
    charts = []
    for name, label in labels.items():
        points = [(count * (1e-6 if name == "pixels" else 1), ms) for count, ms in summary[name]]
        if len(points) < 2:
            continue
        last, most = max(x for x, _ in points) * 1.05, max(y for _, y in points) * 1.1
        chart = Chart((label, last), ("ms a frame", most), name)
        chart.line("median", points)
        chart.axes.lines[-1].set_marker("o")
        charts.append(chart.svg())
    return charts


def history_rows(summary, history):
    now = {
        "date": "this run", "commit": summary["commit"], "cpu": summary["cpu"], "realtime_ms": summary["at_default"]["ms"],
        "paper_ms": summary["detect_ms"]["paper"], "linemod_ms": summary["linemod_ms"],
        "latency_p50_ms": (summary["latency_ms"] or {}).get("p50"),
    }  # fmt: skip
    keys = ("realtime_ms", "paper_ms", "linemod_ms", "latency_p50_ms")
    return [
        (run["date"], run["commit"], *(milliseconds(run[key]) for key in keys), run["cpu"]) for run in [*history, now]
    ]


def page(summary, history):
    return render(
        "bench/speed.html",
        summary=summary,
        detection=detection_rows(summary),
        stages=stage_rows(summary),
        kernels=[(name, milliseconds(ms)) for name, ms in summary["kernel_ms"].items()],
        simd=[(name, milliseconds(ms)) for name, ms in summary["simd"].items()],
        streams=stream_rows(summary),
        charts=growth_charts(summary),
        history=history_rows(summary, history),
    )


def glance(summary):
    """Returns the figures that a reader wants first."""
    rows = detection_rows(summary) if summary["parts"]["speed"] else []
    lines = [f"{words:<52}{ms:>10} ms   AUC {auc}" for words, ms, auc, _ in rows]
    for row in stream_rows(summary):
        lines.append(
            f"stream, {row[0]}: p50 {row[1]}, p99 {row[3]} ms; lost {row[5]}, skipped {row[6]} of {row[4]}; {row[8]} cores"
        )
    for name in ("objects", "threads"):
        if summary[name]:
            lines.append(f"{name}: " + ", ".join(f"{n}: {ms:.1f} ms" for n, ms in summary[name]))
    return "\n".join(lines)


def write(out):
    summary = {**summarise(out), **about("tools/bench")}
    write_json(out / "summary.json", summary)
    (out / "report.html").write_text(page(summary, read_json(HISTORY)))
    print(glance(summary))
    print(f"{out}/report.html, {out}/summary.json")
