"""The output of tools/bench tracks: OUT/tracks.json and OUT/tracks.html."""

import math
import pathlib
import statistics
import subprocess

from houghstream import objects_t
from houghstream.event_log import read_log
from studies.command import step
from studies.follow_speed import RATES, Replays, measure
from studies.records import about, read_json, write_json
from studies.report.page import render, show
from studies.tracks import hosts
from studies.tracks.plan import CAMERAS, WRONG, Plan

# Stoiber, Sundermeyer and Triebel 2022, "Iterative Corresponding Geometry: Fusing Region and Depth for Highly Efficient 3D
# Tracking of Textureless Objects": as its readme states it, without naming the machine.
ICG = {"ms_per_object": 1.3, "machine": "one CPU core", "source": "readme of ICG, Stoiber et al. 2022"}
OBJECTS = "HOUGHSTREAM_OBJECTS"
MOVED = ("pushed", "carried", "removed", "swapped", "cans")


def hota_of(figures):
    """Combines several sequences as TrackEval does: each threshold's counts are added up."""
    thresholds = zip(*(one["hota_counts"] for one in figures))
    sums = [[sum(count) for count in zip(*counts)] for counts in thresholds]
    # DetA AssA is TP / (TP + FN + FP) times the sum of A(c) / TP.
    return statistics.mean(math.sqrt(association / (tp + fn + fp)) if tp else 0.0 for tp, fn, fp, association in sums)


def pooled(figures):
    """Combines several sequences: counts are added up, shares follow the counts."""
    required = sum(one["required"] for one in figures)
    found = sum(one["recall"] * one["required"] for one in figures)
    right = found + sum(one["kept"] for one in figures)
    wrong = sum(sum(one["wrong"].values()) for one in figures)
    return {
        "sequences": [one["name"] for one in figures],
        "recall": found / required,
        "precision": right / (right + wrong),
        "id_switches": sum(one["id_switches"] for one in figures),
        "hota": hota_of(figures),
        "moving_mm_p95": max((p95 for one in figures if (p95 := one["error"]["moving"]["mm_p95"]) is not None), default=None),
    }


def longest(lists):
    """None where something was never found, or never gone."""
    values = [value for one in lists for value in one]
    return None if not values or None in values else max(values)


def wrong_share(counts):
    """Returns the share over all sequences; None where nothing was published that surely."""
    published = sum(one["published"] for one in counts)
    return sum(one["wrong"] for one in counts) / published if published else None


def check_extrinsics(options, plan, store):
    """Returns what hs-track --check says of right places, and of one that is wrong."""
    out = {}
    for name, log in (("right", "found/cameras.lcmlog"), ("wrong", "wrong_found.lcmlog")):
        words = [options.programs / "hs-track", "--check", "-l", f"file://{store.path(log)}", "-c", "|".join(CAMERAS), "--models",
                 plan.path(store, plan.models)]  # fmt: skip
        done = subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False)
        out[name] = {"status": done.returncode, "said": (done.stdout + done.stderr.splitlines()[-1]).splitlines()}
    out["wrong"]["metres"] = float(WRONG)
    out["reported"] = out["wrong"]["status"] != 0 and out["right"]["status"] == 0
    return out


def cameras(options, plan, store, tracked):
    alone = {camera: read_json(store.path(f"tracked/{camera}.json")) for camera in CAMERAS}
    errors = {camera: one["error"]["standing"]["mm_median"] for camera, one in alone.items()}
    together = tracked["cameras"]
    return {
        "recall": together["recall"],
        "precision": together["precision"],
        "id_switches": together["id_switches"],
        "hota": together["hota"],
        "mm_median": together["error"]["standing"]["mm_median"],
        "mm_median_alone": errors,
        "no_worse_than_best": together["error"]["standing"]["mm_median"] <= min(errors.values()),
        "extrinsics": check_extrinsics(options, plan, store),
    }


def told(log):
    """Returns what a log tells of the world, byte for byte but for the times that stages took."""
    for timestamp, channel, data in read_log(log):
        if channel == OBJECTS:
            world = objects_t.decode(data)
            world.n_stages, world.stages = 0, []
            data = world.encode()
        yield timestamp, channel, data


def tracks_are_equal(store, names):
    """Returns whether each sequence has the same tracks each time that it is replayed."""
    logs = [[store.path(f"tracks/{name}{again}.lcmlog") for again in ("", "_again")] for name in names]
    return all(list(told(first)) == list(told(again)) for first, again in logs)


def summarise(options, plan, store):
    names = options.sequences
    tracked = {name: read_json(store.path(f"tracked/{name}.json")) for name in names}
    single = {name: read_json(store.path(f"single/{name}.json")) for name in names}
    summary = {"sequences": tracked, "single_frames": {name: pooled([one]) for name, one in single.items()}}
    if "walk" in names:
        walk = tracked["walk"]
        summary["walk"] = {key: walk[key] for key in ("recall", "precision", "id_switches", "hota", "frames")}
        summary["walk"]["single_frames"] = {key: single["walk"][key] for key in ("recall", "precision")}
    moved = [tracked[name] for name in MOVED if name in names]
    if moved:
        summary["moved"] = pooled(moved)
    still = [tracked[name]["jitter"] for name in names if name not in ("walk", "jerk")] or [one["jitter"] for one in tracked.values()]
    known = [one for one in still if one["mm"] is not None]
    if known:
        summary["jitter"] = {"mm": max(one["mm"] for one in known), "deg": max(one["deg"] for one in known),
                             "mm_worst": max(one["mm_worst"] for one in known),
                             "deg_worst": max(one["deg_worst"] for one in known)}  # fmt: skip
    summary["add"] = {name: one["add"] for name, one in single.items()}
    summary["median_error"] = {name: one["median_error"] for name, one in single.items()}
    summary["outline_px"] = {name: one["outline_px"] for name, one in single.items()}
    summary["wrong_above_0_9"] = wrong_share([one["wrong_above_0_9"] for one in single.values()])
    if options.follow:
        slow = {name: read_json(store.path(f"single_10hz/{name}.json")) for name in names}
        summary["add_10hz"] = {name: one["add"] for name, one in slow.items()}
    summary["seconds_to_find"] = longest(one["seconds_to_find"] for one in tracked.values())
    summary["seconds_to_gone"] = longest(one["seconds_to_gone"] for one in tracked.values())
    summary["hidden_kept"] = {name: one["hidden_kept"] for name, one in tracked.items() if one["hidden_frames"]}
    summary["replayed_equal"] = tracks_are_equal(store, names)
    if "cameras" in names:
        summary["cameras"] = cameras(options, plan, store, tracked)
    return summary


def rates(options, plan, store):
    scene = store.path("rendered/walk") / "walk" / "000001"
    data = {"scene": scene, "forest": plan.path(store, plan.forest), "models": plan.path(store, plan.models)}
    return measure(options.programs, data, options.out / "tracks_rates", Replays(RATES, options.seconds, 1))


def write_page(options, summary):
    header = ("sequence", "recall", "precision", "switches", "HOTA", "single frames: recall", "precision", "error, mm",
              "within 2 deviations", "moving, mm (95 %)", "jitter, mm", "deg", "found after, s", "gone after, s", "hidden, kept")  # fmt: skip
    rows = []
    for name, one in summary["sequences"].items():
        alone = summary["single_frames"][name]
        rows.append((name, show(one["recall"]), show(one["precision"]), one["id_switches"], show(one["hota"]),
                     show(alone["recall"]), show(alone["precision"]), show(one["error"]["standing"]["mm_median"], "{:.2f}"),
                     show(one["error"]["standing"]["within_two_deviations"]),
                     show(one["error"]["moving"]["mm_p95"], "{:.1f}"), show(one["jitter"]["mm"], "{:.2f}"),
                     show(one["jitter"]["deg"], "{:.2f}"), show(longest([one["seconds_to_find"]]), "{:.2f}"),
                     show(longest([one["seconds_to_gone"]]), "{:.2f}"), show(one["hidden_kept"], "{:.2f}")))  # fmt: skip
    keys = ("p50_ms", "p99_ms", "objects_p50_ms", "objects_p99_ms", "lost", "skipped", "cores")
    speeds = [(f"{rate} Hz", *(show(summary[f"hz{rate}"][key], "{:.2f}") for key in keys)) for rate in RATES if f"hz{rate}" in summary]
    host_rows = [(f"{words}, host {host}", *(show(one[host][key], "{:.1f}") for key in ("hz", "p50_ms", "p99_ms")), one[host]["objects"])
                 for words, one in hosts.by_number(summary.get("hosts")) for host in hosts.HOSTS if host in one]  # fmt: skip
    template = pathlib.Path(__file__).parent.name + "/page.html"
    (options.out / "tracks.html").write_text(render(template, summary=summary, header=header, rows=rows, speeds=speeds, icg=ICG,
                                                    host_rows=host_rows))


def run(options):
    plan = Plan(options)
    store = plan.make()
    step("comparing")
    summary = {**about("tools/bench tracks"), **summarise(options, plan, store), "icg": ICG}
    if options.stream and "walk" in options.sequences:
        summary.update(rates(options, plan, store))
    if options.hosts:
        summary["hosts"] = hosts.measure(options.programs, options.out / "tracks_hosts")
    write_json(options.out / "tracks.json", summary)
    write_page(options, summary)
    step(f"{options.out / 'tracks.json'}, {options.out / 'tracks.html'}")
