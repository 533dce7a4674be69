"""Adds up one run of tools/demo --live. A frame's latency is from the virtual camera's shutter to the arrival of its
message at hs-observe, both on this machine's clock."""

import bisect
import statistics

from studies.command import die
from studies.records import percentiles, read_csv, read_json

HALF_PERIOD_US = 16667


def shutter_times(file):
    """Microseconds since the epoch, rising: the third word of each line."""
    return sorted(int(line.split()[2]) for line in file.read_text().splitlines())


def nearest(times, wanted):
    """The shutter time of the frame that claims to be taken at `wanted`; None where the claim is off by half a frame."""
    place = bisect.bisect_left(times, wanted)
    best = min(times[max(place - 1, 0) : place + 1], key=lambda time: abs(time - wanted), default=None)
    return best if best is not None and abs(best - wanted) < HALF_PERIOD_US else None


def latencies_ms(rows, key, shutters, start_us):
    """Returns the times from the shutter to the arrival of what `key` names, for the frames for which it came."""
    taken = [(nearest(shutters, int(row["utime"])), row[key]) for row in rows if row[key]]
    unknown = sum(shutter is None for shutter, _ in taken)
    if unknown:
        die(f"{unknown} frames have a utime that is no shutter's, expected none")
    return [1e-3 * (start_us + 1e6 * float(arrival) - shutter) for shutter, arrival in taken]


def unplugging(rows, start_us, replugged_us):
    """Returns how long no frame came, and how soon after the camera frames and poses were back."""
    frames, poses = (sorted(start_us + 1e6 * float(row[key]) for row in rows if row[key]) for key in ("t_frame", "t_poses"))
    frame, pose = bisect.bisect_left(frames, replugged_us), bisect.bisect_left(poses, replugged_us)
    if frame in (0, len(frames)) or pose == len(poses):
        die("the camera was unplugged, expected frames before and frames with poses afterwards")
    return {
        "gap_s": round(1e-6 * (frames[frame] - frames[frame - 1]), 2),
        "frames_back_ms": round(1e-3 * (frames[frame] - replugged_us)),
        "poses_back_ms": round(1e-3 * (poses[pose] - replugged_us)),
    }


def frame_counts(observed):
    capture, detector = observed["processes"]["hs-capture"], observed["processes"]["hs-detect"]
    return {
        "frames_sent": capture["processed"],
        "frames_lost_from_camera": capture["lost"],
        "frames_lost_on_bus": capture["processed"] - detector["received"],
        "frames_detected": detector["processed"],
        "frames_skipped": detector["skipped"],
        "frames_with_poses": observed["frames_with_poses"],
        "frame_rate_hz": observed["frame_rate_hz"],
    }


def summarise(out, shutter, replugged_us):
    """`replugged_us`: from when on the camera was there again, or None where it was never taken away."""
    observed, rows = read_json(out / "stream" / "observe.json"), read_csv(out / "stream" / "frame_times.csv")
    shutters, start_us = shutter_times(shutter), observed["start_utime"]
    taken = [(int(row["utime"]), nearest(shutters, int(row["utime"]))) for row in rows if row["t_frame"]]
    errors = [1e-3 * (utime - opened) for utime, opened in taken if opened is not None]
    summary = frame_counts(observed)
    summary["utime_error_ms"] = {
        "median": round(statistics.median(errors), 2), "worst": round(max(errors, key=abs), 2),
    }  # fmt: skip
    summary["glass_to_ms"] = {
        name: percentiles(latencies_ms(rows, key, shutters, start_us))
        for name, key in (("frame", "t_frame"), ("detections", "t_detections"), ("poses", "t_poses"))
    }
    if replugged_us:
        summary["unplugged"] = unplugging(rows, start_us, replugged_us)
        summary["unplugged"]["words"] = observed["processes"]["hs-capture"]["last_error"]
    return summary


def print_summary(summary):
    print(f"\n{'from the shutter to, ms':<26}{'p50':>8}{'p95':>8}{'p99':>8}")
    for name, latency in summary["glass_to_ms"].items():
        print(f"{name:<26}" + "".join("       -" if value is None else f"{value:8.1f}" for value in latency.values()))
    print(
        "\n{frames_sent} frames sent at {frame_rate_hz:.2f} Hz, {frames_lost_from_camera} lost between camera and hs-capture,"
        " {frames_lost_on_bus} on the bus; {frames_detected} detected, {frames_skipped} passed over for newer ones".format(
            **summary
        )
    )
    print("frames are stamped {median} ms after the shutter (median), at worst {worst} ms".format(**summary["utime_error_ms"]))
    if "unplugged" in summary:
        print(
            "unplugged on the way: no frame for {gap_s} s; plugged in again, frames were back after {frames_back_ms} ms, poses"
            " after {poses_back_ms} ms; hs-capture says: {words}".format(**summary["unplugged"])
        )
