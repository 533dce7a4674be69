"""The figures of tools/bench speed, stream and growth by which runs are compared; None where a part has not been run."""

import math

from measured import read_json

SETS = {"SSE4": "sse4", "AVX2": "avx2", "AVX3": "avx512"}  # Highway's names, and everybody's


def read(file):
    return read_json(file) if file.is_file() else None


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
    summary = read(out / "speed" / name / "summary.json")
    return summary["auc"]["mean"] if summary else None


def linemod_auc(out):
    found = sorted((out / "speed" / "linemod").glob("*/summary.json"))
    return read_json(found[0])["auc"]["mean"] if found else None


def kernels(out):
    """Median CPU milliseconds on one thread, by kernel."""
    measured = read(out / "speed" / "kernels.json")
    runs = measured["benchmarks"] if measured else []
    return {run["run_name"]: round(run["cpu_time"], 3) for run in runs if run.get("aggregate_name") == "median"}


def detection(out):
    times = read(out / "speed" / "times.json")
    detect = {name: median_ms(times, name) for name in ("realtime", "paper", "gall", "serial")}
    threads = numbered(times, "threads")
    auc = {name: mean_auc(out, name) for name in ("realtime", "paper", "realtime_few", "serial_few")}
    auc["linemod"] = linemod_auc(out)
    one, two = dict(map(tuple, threads)).get(1), dict(map(tuple, threads)).get(2)
    return {
        "detect_ms": detect,
        "linemod_ms": median_ms(times, "linemod"),
        "gall_fast_engine_ms": median_ms(times, "gall_engine"),
        "speedup_over_gall": quotient(detect["gall"], one),
        "speedup_over_linemod": quotient(median_ms(times, "linemod"), detect["realtime"]),
        "auc": auc,
        "auc_over_linemod": quotient(auc["realtime"], auc["linemod"]),
        "stage_ms": {name: times[name]["stage_ms"] for name in ("realtime", "paper") if times and name in times},
        "kernel_ms": kernels(out),
        "threads": threads,
        "speedup_of_two_threads": quotient(one, two),
        "simd": {key: median_ms(times, f"set_{name}") for name, key in SETS.items()},
    }


def stream(folder):
    """Of one replay, or None."""
    observed, usage = read(folder / "observe.json"), read(folder / "usage.json")
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
    first = runs["compressed"] or {"latency_ms": None, "frames": None, "cpu_cores": None, "rss_mb": None}
    return {**{key: first[key] for key in ("latency_ms", "frames", "cpu_cores", "rss_mb")}, "streams": runs}


def growth(out):
    times = read(out / "growth" / "times.json")
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
    return {**detection(out), **streams(out), **growth(out)}
