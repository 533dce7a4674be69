"""Virtual camera -> stock OpenNI2 -> hs-capture -> LCM: what a user with a camera starts, unplugs, records and replays."""

import csv
import json
import os
import subprocess
import sys
import time

from folders import read_arguments
from houghstream import images_t, status_t
from houghstream.event_log import read_log
from studies.wire_patch import utime_of
from studies.stream import Process, enter_private_network

LIVE_FRAMES = 90
PERIOD_US = 33333  # of the camera
LEFT, DEPTH_MM_ZIPPED = images_t.LEFT, images_t.DEPTH_MM_ZIPPED
LATE_COLOUR = "can_sync no\ncolour_phase_ms 8\ncolour_late_ms 60\n"


class Camera:
    """The virtual camera's script, which may be changed while it runs."""

    def __init__(self, folder):
        self.file = folder / "camera_script"
        self.write("")
        os.environ["HOUGHSTREAM_VIRTUAL_CAMERA"] = str(self.file)

    def write(self, text):
        fresh = self.file.with_suffix(".new")
        fresh.write_text(text)
        fresh.replace(self.file)


def run(*command, **options):
    return subprocess.run([str(part) for part in command], check=False, text=True, capture_output=True, timeout=60, **options)


def wait_for(file, text, seconds=15):
    end = time.monotonic() + seconds
    while text not in file.read_text():
        assert time.monotonic() < end, f"no '{text}' in {file}: {file.read_text()}"
        time.sleep(0.01)


def check_listing(tools, camera):
    camera.write("serial AA01\nserial AA02\nsize 320x240\nsize 640x480\n")
    listed = run(tools / "hs-capture", "--list-devices")
    assert listed.returncode == 0 and "#2 Houghstream virtual camera" in listed.stdout, listed
    assert "serial AA02, modes 640x480@30, 320x240@30" in listed.stdout, listed
    for source, mode, words in (("openni2:#3", "640x480", "#3"), ("openni2:AA02", "1280x1024@30", "it has 640x480@30, 320x240@30")):
        refused = run(tools / "hs-capture", "--source", source, "--mode", mode, "--log", camera.file.parent / "none.log")
        assert refused.returncode == 1 and words in refused.stderr, refused
    camera.write("plugged no\n")
    absent = run(tools / "hs-capture", "--source", "openni2")
    assert absent.returncode == 1 and "no camera found" in absent.stderr, absent


def check_unplugging(tools, camera, folder):
    """Frames come at the camera's rate; while it is away the status says so; then they come again, soon."""
    camera.write(LATE_COLOUR)
    recorded = folder / "status.log"
    logger = subprocess.Popen(["lcm-logger", "-f", "-q", "-c", "HOUGHSTREAM_STATUS", str(recorded)], stderr=subprocess.DEVNULL)
    observe = Process(folder, tools / "hs-observe", "--out", folder / "observed.json", "--csv", folder / "times.csv")
    processes = [observe]
    try:
        observe.wait_until_ready()
        capture = Process(folder, tools / "hs-capture", "--source", "openni2")
        processes.append(capture)
        wait_for(capture.log, "colour is taken 8.0 ms after depth")
        time.sleep(2.5)
        camera.write("plugged no\n")
        wait_for(capture.log, "the camera is gone; waiting for it")
        time.sleep(1.6)
        replugged = time.time()  # before: a rename may keep its caller waiting for the disk
        camera.write("can_sync no\n")
        wait_for(capture.log, "back, was away for")
        time.sleep(2.5)
        camera.write("plugged no\n")
        wait_for(capture.log, "was away for")
        time.sleep(0.3)
        capture.stop()  # also while there is no camera
        observe.stop()
    finally:
        logger.terminate()
        logger.wait()
        for process in processes:
            process.kill()
    check_gap(folder, replugged)
    statuses = [status_t.decode(data) for _, _, data in read_log(recorded)]
    errors = [status.last_error for status in statuses if status.process == "hs-capture"]
    assert errors[0] == "" and any("the camera is gone" in e for e in errors) and any("was away for" in e for e in errors), errors


def check_gap(folder, replugged):
    start_us = json.loads((folder / "observed.json").read_text())["start_utime"]
    rows = [row for row in csv.DictReader((folder / "times.csv").open()) if row["t_frame"]]
    arrivals = [start_us * 1e-6 + float(row["t_frame"]) for row in rows]
    gaps = [b - a for a, b in zip(arrivals, arrivals[1:])]
    longest = max(range(len(gaps)), key=gaps.__getitem__)
    back_after = arrivals[longest + 1] - replugged
    print(f"{len(rows)} frames; a gap of {gaps[longest]:.2f} s while unplugged; frames are back {1e3 * back_after:.0f} ms after the camera")
    assert gaps[longest] > 1.5 and 0 <= back_after < 2.0, (gaps[longest], back_after)
    assert len(rows) > 100, "two and a half seconds twice"
    late = [arrival - int(row["utime"]) * 1e-6 for arrival, row in zip(arrivals, rows)]
    assert min(late) > -0.01 and sorted(late)[len(late) // 2] < 0.3, "utimes are capture times on this machine's clock"


def images_of(data):
    """{image type: bytes} of an encoded images_t."""
    message = images_t.decode(data)
    return {kind: image.data for kind, image in zip(message.image_types, message.images)}


def places_of(sent, replayed):
    """Returns where each live frame is in the replay, in rising order, and its utime; the first few were sent before recording
    began."""
    places = []
    for utime, images in sent:
        start = places[-1][0] + 1 if places else 0
        if images in replayed[start:]:
            places.append((replayed.index(images, start), utime))
    return places


def check_import(tools, folder, events):
    """hs-log makes the same of a .oni file, with colour as it is there."""
    imported = run(tools / "hs-log", "import", folder / "live.oni", folder / "imported.log", "--replace")
    assert imported.returncode == 0, imported
    frames = [(utime_of(data), images_of(data)) for _, _, data in read_log(folder / "imported.log")]
    assert [utime for utime, _ in frames] == [utime for _, utime, _ in events], "every frame, at the same time"
    for (_, images), (_, _, replayed) in zip(frames, events):
        assert images[DEPTH_MM_ZIPPED] == replayed[DEPTH_MM_ZIPPED]
    assert all(len(images[LEFT]) == 640 * 480 * 3 for _, images in frames)
    info = run(tools / "hs-log", "info", folder / "imported.log")
    assert info.returncode == 0 and "OPENNI_FRAME" in info.stdout and "images_t" in info.stdout, info


def check_recording(tools, camera, folder, script):
    """The replay of a .oni file is, message by message, what went out live."""
    camera.write(script)
    live = run(tools / "hs-capture", "--source", "openni2", "--frames", LIVE_FRAMES, "--log", folder / "live.log", "--record",
               folder / "live.oni", "--replace")  # fmt: skip
    assert live.returncode == 0, live
    replay = run(tools / "hs-capture", "--source", f"oni:{folder / 'live.oni'}", "--log", folder / "replay.log", "--replace")
    assert replay.returncode == 0, replay
    sent = [(utime_of(data), images_of(data)) for _, _, data in read_log(folder / "live.log")]
    events = [(timestamp, utime_of(data), images_of(data)) for timestamp, _, data in read_log(folder / "replay.log")]
    replayed = [images for _, _, images in events]
    places = places_of(sent, replayed)
    print(f"{len(sent)} frames sent live, {len(replayed)} replayed, {len(places)} of the live ones byte by byte among them")
    assert len(sent) == LIVE_FRAMES and set(sent[0][1]) == {LEFT, DEPTH_MM_ZIPPED}
    alone = {kind: sum(images[kind] in {other[kind] for other in replayed} for _, images in sent) for kind in sent[0][1]}
    assert len(places) >= LIVE_FRAMES - 10, f"recording starts a moment after the camera; alone are replayed: {alone}"
    for (place, utime), (next_place, next_utime) in zip(places, places[1:]):
        passed = round((next_utime - utime) / PERIOD_US)  # more than one where this machine is too busy for the camera
        assert next_place - place == passed, "each in its place among those that were not sent"
    for (_, before, _), (_, after, _) in zip(events, events[1:]):
        assert abs(after - before - PERIOD_US) < 200, "no frame is missing, times are those of the recording"
    check_import(tools, folder, events)
    slow = run(tools / "hs-capture", "--source", f"oni:{folder / 'live.oni'}", "--frames", 10, "--rate", 10, "--log", folder / "slow.log", "--replace")
    times = [timestamp for timestamp, _, _ in read_log(folder / "slow.log")]
    assert slow.returncode == 0 and times[-1] - times[0] == 900000, (slow, times)


def check_lost_take(tools, camera, folder):
    """A take of so many seconds ends by its time, whether the camera is still there or not."""
    camera.write("")
    teach = Process(folder, tools / "hs-teach", "show", "--source", "openni2", "--seconds", 3, "--name", "disc", "--no-teach")
    try:
        teach.wait_until_ready()
        time.sleep(1.0)
        camera.write("plugged no\n")
        wait_for(teach.log, "the camera is gone; waiting for it")
        start = time.monotonic()
        teach.process.wait(30)
    finally:
        teach.kill()
    print(f"the take of 3 s ended {time.monotonic() - start:.1f} s after its camera was lost")
    assert "the take ends by its time" in teach.log.read_text(), teach.log.read_text()


def main():
    enter_private_network()
    arguments = read_arguments(__doc__)
    tools, folder = arguments.tools, arguments.out
    camera = Camera(folder)
    check_listing(tools, camera)
    check_unplugging(tools, camera, folder)
    check_lost_take(tools, camera, folder)
    for script in ("", LATE_COLOUR):
        check_recording(tools, camera, folder, script)
    print("live capture: frames, gap and recording are as they should be")


if __name__ == "__main__":
    sys.exit(main())
