"""Teaches an object in a running stream: hs-detect and hs-pose follow a store, frames of a take go by at 30 Hz and then those
of a scene in which the object stands among others, and hs-teach show --from-stream teaches it meanwhile. Writes OUT/live.json.
On the bus of $LCM_DEFAULT_URL.

Usage: live_teaching.py --programs DIR --store STORE --name NAME --take LOG --after LOG --out DIR"""

import argparse
import json
import pathlib
import shutil
import sys
import time

from houghstream import detections_t, teaching_t
from houghstream.event_log import DamagedLog, read_log
from studies.records import read_csv, read_json, threads
from studies.stream import ProcessFailed, Processes, Stream
from studies.teach.joined_log import FIRST_UTIME, Camera, frames_of, write_joined

CHANNEL, RATE_HZ = "OPENNI_FRAME", 30.0
LONGEST_S = 180.0  # after the take
AFTERWARDS_S = 20.0  # after hs-teach has ended: all frames of the scene have gone by


def events(log):
    """Returns what is whole of a log that may still be written."""
    found = []
    try:
        for event in read_log(log):
            found.append(event)
    except DamagedLog:
        pass
    return found


def first_time(found, wanted):
    """Seconds of the first event that is wanted, or None."""
    return next((1e-6 * stamp for stamp, channel, data in found if wanted(channel, data)), None)


def times_of(found, name):
    def in_state(state):
        def wanted(channel, data):
            if channel != "HOUGHSTREAM_TEACHING":
                return False
            said = teaching_t.decode(data)
            return said.name == name and said.state == state
        return wanted

    def is_found(channel, data):
        return channel == "HOUGHSTREAM_DETECTIONS" and any(
            it.class_name == name and it.reported for it in detections_t.decode(data).detections
        )

    return {"take_over": first_time(found, in_state(teaching_t.FUSING)), "done": first_time(found, in_state(teaching_t.DONE)),
            "failed": first_time(found, in_state(teaching_t.FAILED)), "found": first_time(found, is_found)}  # fmt: skip


def teach(options, log):
    """Plays the frames and teaches; leaves OUT/results.lcmlog and OUT/observe.json."""
    out, programs = options.out, options.programs
    with Processes(out / "log") as running:
        for name in ("detect", "pose"):
            running.start(name, programs / f"hs-{name}", "--objects", out / "store")
        running.start("observe", programs / "hs-observe", "--out", out / "observe.json", "--csv", out / "frame_times.csv",
                      "--replace")  # fmt: skip
        running.start("logger", "lcm-logger", "-f", f"--lcm-url={Stream._logger_url()}", "-c", "HOUGHSTREAM_.*",
                      out / "results.lcmlog")  # fmt: skip
        running.start("teach", programs / "hs-teach", "show", "--from-stream", "--name", options.name, "--out",
                      out / "store", "--add", "--keep", out / "kept", "--seconds", options.take_seconds, "--threads",
                      threads())  # fmt: skip
        for name in ("detect", "pose", "observe", "teach"):
            running.by_name[name].wait_until_ready()
        player = running.start("player", "lcm-logplayer", log)
        wait_for_end(running.by_name["teach"], player, out / "results.lcmlog", options.name)
        player.kill()
        time.sleep(1.0)
        running.by_name["teach"].kill()
        running.stop("observe", "logger", "pose", "detect")


def wait_for_end(teacher, player, results, name):
    """Until the object was found, or long enough after hs-teach has ended."""
    ended = None
    while player.runs():
        time.sleep(1.0)
        if ended is None and not teacher.runs():
            ended = time.monotonic()
        if ended is not None:
            times = times_of(events(results), name)
            if times["failed"] or times["found"] or time.monotonic() - ended > AFTERWARDS_S:
                return


def after(start, moment):
    return None if start is None or moment is None else round(moment - start, 2)


def summarise(out, name):
    times = times_of(events(out / "results.lcmlog"), name)
    observed = read_json(out / "observe.json")
    detector = observed["processes"]["hs-detect"]
    last = max(int(row["utime"]) for row in read_csv(out / "frame_times.csv"))
    sent = 1 + round(1e-6 * (last - FIRST_UTIME) * RATE_HZ)
    report = out / "kept" / "report.json"
    return {
        "name": name,
        "seconds_to_taught": after(times["take_over"], times["done"]),
        "seconds_to_found": after(times["take_over"], times["found"]),
        "failed": times["failed"] is not None,
        "frames": sent,
        "lost": sent - detector["received"],
        "skipped": detector["skipped"],
        "frame_rate_hz": observed["frame_rate_hz"],
        "report": read_json(report) if report.is_file() else None,
        "said": (out / "log" / "teach.txt").read_text(errors="replace").splitlines()[-10:],
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    add = parser.add_argument
    for name in ("--programs", "--store", "--take", "--after", "--out"):
        add(name, type=pathlib.Path, required=True)
    add("--name", required=True)
    options = parser.parse_args()
    options.out.mkdir(parents=True)
    shutil.copytree(options.store, options.out / "store")
    joined = options.out / "joined.lcmlog"
    take = frames_of(options.take, CHANNEL)
    options.take_seconds = len(take) / RATE_HZ
    write_joined(joined, take, frames_of(options.after, CHANNEL), round(LONGEST_S * RATE_HZ), Camera(CHANNEL, RATE_HZ))
    try:
        teach(options, joined)
    except ProcessFailed as error:
        sys.exit(str(error))
    joined.unlink()
    (options.out / "live.json").write_text(json.dumps(summarise(options.out, options.name), indent=2) + "\n")


if __name__ == "__main__":
    main()
