"""The whole line behind a camera: virtual camera -> OpenNI2 -> hs-capture -> hs-detect -> hs-pose, unplugged on the way."""

import csv
import json
import os
import subprocess
import time

from result_values import detections_by_utime
from houghstream.event_log import read_log
from studies.stream import Process


def camera_option(scene):
    """The scene's camera as --camera takes it: the field of view that a device states is a little rounded."""
    first = next(iter(json.loads((scene / "scene_camera.json").read_text()).values()))
    fx, _, cx, _, fy, cy, *_ = first["cam_K"]
    return f"{first['width']}x{first['height']},{fx!r},{fy!r},{cx!r},{cy!r}"


def write_script(file, text):
    file.with_suffix(".new").write_text(text)
    file.with_suffix(".new").replace(file)


def wait_for_results(observed, count, seconds=120):
    """Until so many further detections have been recorded."""
    wanted = (observed.stat().st_size if observed.exists() else 0) + 1
    end = time.monotonic() + seconds
    while count > 0:
        assert time.monotonic() < end, "no results"
        time.sleep(0.05)
        size = observed.stat().st_size if observed.exists() else 0
        if size >= wanted:
            count, wanted = count - 1, size + 1


def wait_for_words(process, text, seconds=20):
    end = time.monotonic() + seconds
    while text not in process.log.read_text():
        assert time.monotonic() < end, f"{process.name} does not say '{text}': {process.log.read_text()}"
        time.sleep(0.01)


def run_unplugged(tools, folder, start_stream, script):
    """Runs the line, takes the camera away for a second, and returns when it was plugged in again."""
    results = folder / "live_results.log"
    logger = subprocess.Popen(["lcm-logger", "-f", "-q", "--flush-interval=1", "-c", "HOUGHSTREAM_(DETECTIONS|POSES)", str(results)],
                              stderr=subprocess.DEVNULL)
    observe = Process(folder, tools / "hs-observe", "--out", folder / "live_camera.json", "--csv", folder / "live_camera.csv")
    processes = [observe]
    try:
        observe.wait_until_ready()
        processes += start_stream(tools, folder)
        capture = Process(folder, tools / "hs-capture", "--source", "openni2", "--camera", camera_option(folder / "scene"))
        processes.append(capture)
        wait_for_results(results, 3)
        write_script(script, "plugged no\n")
        wait_for_words(capture, "the camera is gone; waiting for it")
        time.sleep(1.0)
        replugged = time.time()
        write_script(script, f"scene {folder / 'scene'}\n")
        wait_for_words(capture, "back, was away for")
        wait_for_results(results, 5)
        for process in processes[::-1]:
            process.stop()
    finally:
        logger.terminate()
        logger.wait()
        for process in processes:
            process.kill()
    return replugged


def check_live_stream(tools, folder, start_stream, offline):
    """Poses come back after the camera; detections are those of the same images read from the folder."""
    script = folder / "camera_script"
    write_script(script, f"scene {folder / 'scene'}\n")
    os.environ["HOUGHSTREAM_VIRTUAL_CAMERA"] = str(script)
    os.environ["LD_LIBRARY_PATH"] = str(tools.parent / "virtual_camera")
    replugged = run_unplugged(tools, folder, start_stream, script)
    start_us = json.loads((folder / "live_camera.json").read_text())["start_utime"]
    rows = list(csv.DictReader((folder / "live_camera.csv").open()))
    after = {key: [float(row[key]) + 1e-6 * start_us - replugged for row in rows if row[key]] for key in ("t_frame", "t_poses")}
    back = {key: min(time for time in times if time > 0) for key, times in after.items()}
    print(f"camera plugged in again: frames after {1e3 * back['t_frame']:.0f} ms, poses after {1e3 * back['t_poses']:.0f} ms")
    assert back["t_frame"] < 2.0, back
    known = list(offline.values())
    heard = detections_by_utime(read_log(folder / "live_results.log"))
    for utime, found in heard.items():
        assert found in known, f"frame {utime}: other detections than of any of the scene's pictures"
    print(f"{len(heard)} frames detected live, each with the detections of its picture")
