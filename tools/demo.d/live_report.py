"""Adds up one run of tools/demo --live: writes summary.json into its folder and prints a table. A frame's latency is from
the virtual camera's shutter to the arrival of its message at hs-observe, both on this machine's clock."""

import argparse
import bisect
import json
import pathlib
import statistics
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "report_kit"))

from measured import cpu_name, read_csv, read_json

HALF_PERIOD_US = 16667


def shutter_times(file):
    """Microseconds since the epoch, rising: the third word of each line."""
    return sorted(int(line.split()[2]) for line in file.read_text().splitlines())


def nearest(times, wanted):
    """The shutter time of the frame that claims to be taken at `wanted`; None where the claim is off by half a frame."""
    place = bisect.bisect_left(times, wanted)
    best = min(times[max(place - 1, 0) : place + 1], key=lambda time: abs(time - wanted), default=None)
    return best if best is not None and abs(best - wanted) < HALF_PERIOD_US else None


def percentiles(values):
    if not values:
        return {"p50": None, "p95": None, "p99": None}
    ordered = sorted(values)
    return {f"p{p}": round(ordered[min(len(ordered) - 1, p * len(ordered) // 100)], 2) for p in (50, 95, 99)}


def latencies_ms(rows, key, shutters, start_us):
    """From the shutter to the arrival of what `key` names, for the frames for which it came."""
    taken = [(nearest(shutters, int(row["utime"])), row[key]) for row in rows if row[key]]
    unknown = sum(shutter is None for shutter, _ in taken)
    if unknown:
        sys.exit(f"live_report.py: {unknown} frames have a utime that is no shutter's, expected none")
    return [1e-3 * (start_us + 1e6 * float(arrival) - shutter) for shutter, arrival in taken]


def unplugging(rows, start_us, replugged_us):
    """How long no frame came, and how soon after the camera frames and poses were back."""
    frames, poses = (sorted(start_us + 1e6 * float(row[key]) for row in rows if row[key]) for key in ("t_frame", "t_poses"))
    frame, pose = bisect.bisect_left(frames, replugged_us), bisect.bisect_left(poses, replugged_us)
    if frame in (0, len(frames)) or pose == len(poses):
        sys.exit("live_report.py: the camera was unplugged, expected frames before and frames with poses afterwards")
    return {
        "gap_s": round(1e-6 * (frames[frame] - frames[frame - 1]), 2),
        "frames_back_ms": round(1e-3 * (frames[frame] - replugged_us)),
        "poses_back_ms": round(1e-3 * (poses[pose] - replugged_us)),
    }


def summarise(rows, observed, shutters):
    capture, detector = observed["processes"]["hs-capture"], observed["processes"]["hs-detect"]
    start_us = observed["start_utime"]
    taken = [(int(row["utime"]), nearest(shutters, int(row["utime"]))) for row in rows if row["t_frame"]]
    errors = [1e-3 * (utime - shutter) for utime, shutter in taken if shutter is not None]
    return {
        "frames_sent": capture["processed"],
        "frames_lost_from_camera": capture["lost"],
        "frames_lost_on_bus": capture["processed"] - detector["received"],
        "frames_detected": detector["processed"],
        "frames_skipped": detector["skipped"],
        "frames_with_poses": observed["frames_with_poses"],
        "frame_rate_hz": observed["frame_rate_hz"],
        "utime_error_ms": {"median": round(statistics.median(errors), 2), "worst": round(max(errors, key=abs), 2)},
        "glass_to_ms": {
            name: percentiles(latencies_ms(rows, key, shutters, start_us))
            for name, key in (("frame", "t_frame"), ("detections", "t_detections"), ("poses", "t_poses"))
        },
    }


def print_summary(summary):
    print(f"\n{'from the shutter to, ms':<26}{'p50':>8}{'p95':>8}{'p99':>8}")
    for name, latency in summary["glass_to_ms"].items():
        print(f"{name:<26}" + "".join("       -" if value is None else f"{value:8.1f}" for value in latency.values()))
    print(
        "\n{frames_sent} frames sent at {frame_rate_hz:.2f} Hz, {frames_lost_from_camera} lost between camera and hs-capture,"
        " {frames_lost_on_bus} on the bus; {frames_detected} detected, {frames_skipped} passed over for newer ones".format(**summary)
    )
    print("frames are stamped {median} ms after the shutter (median), at worst {worst} ms".format(**summary["utime_error_ms"]))
    if "unplugged" in summary:
        print(
            "unplugged on the way: no frame for {gap_s} s; plugged in again, frames were back after {frames_back_ms} ms, poses"
            " after {poses_back_ms} ms; hs-capture says: {words}".format(**summary["unplugged"])
        )


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--commit", required=True)
    arguments = parser.parse_args()
    out = arguments.out
    observed, rows = read_json(out / "stream" / "observe.json"), read_csv(out / "stream" / "frame_times.csv")
    summary = summarise(rows, observed, shutter_times(out / "shutter.txt"))
    replugged = out / "replugged.txt"
    if replugged.exists():
        summary["unplugged"] = unplugging(rows, observed["start_utime"], int(replugged.read_text()))
        summary["unplugged"]["words"] = observed["processes"]["hs-capture"]["last_error"]
    summary.update(cpu=cpu_name(), commit=arguments.commit)
    (out / "summary.json").write_text(json.dumps(summary, indent=2) + "\n")
    print_summary(summary)
    print(f"{summary['cpu']}; commit {summary['commit']}\n{out}/summary.json, {out}/overlay.png, {out}/overlay.mp4")


if __name__ == "__main__":
    main()
