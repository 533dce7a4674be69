"""Capture -> detect -> pose through LCM with separate processes, compared with the rendered truth.

Renders a few training views and a short scene, trains a small forest, replays the scene with the stock
lcm-logplayer to hs-detect and hs-pose, records the bus with the stock lcm-logger, and adds up.
"""

import json
import subprocess
import sys

from folders import read_arguments
from result_values import detections_by_utime, poses_of
from houghstream import object_pose_t
from houghstream.event_log import read_log
from studies.wire_patch import utime_of
from studies.stream import Process, enter_private_network
from live_stream import check_live_stream

FRAMES = 24
REPLAYED = 120  # the scene again and again
VALID = object_pose_t.VALID
CLASSES = {1: "bowl", 4: "soda_can"}
THRESHOLD = 0.5  # one room and six trees cannot teach scores what they are worth


def run(*command, **options):
    return subprocess.run([str(part) for part in command], check=True, text=True, **options)


def make_data(tools, folder):
    """Training views, background, scene, forest and two logs of the scene; returns the scene's truth."""
    run(tools / "hs-render", "training", "--out", folder / "views", "--objects", ",".join(CLASSES.values()),
        "--azimuths", 12, "--pitches", 2)
    run(tools / "hs-render", "background", "--out", folder / "background", "--count", 8)
    run(tools / "hs-render", "scene", "desk_2", "--out", folder / "scene", "--frames", 12 * FRAMES, "--every", 12)
    run(tools / "hs-train", "--views", f"bop:{folder / 'views'}", "--background", f"bop:{folder / 'background'}",
        "--out", folder / "small.forest", "--trees", 6, "--composites", 2)
    source = f"bop:{folder / 'scene'}"
    run(tools / "hs-capture", "--source", source, "--log", folder / "scene.log")
    run(tools / "hs-capture", "--source", source, "--log", folder / "replay.log", "--loop", "--frames", REPLAYED)
    truth = json.loads((folder / "scene" / "scene_gt.json").read_text())
    boxes = json.loads((folder / "scene" / "scene_gt_info.json").read_text())
    return [list(zip(truth[key], boxes[key])) for key in sorted(truth, key=int)]


def start_stream(tools, folder):
    detect = Process(folder, tools / "hs-detect", "--forest", folder / "small.forest", "--no-camera-colours", "--threads", 2,
                     "--threshold", THRESHOLD)
    pose = Process(folder, tools / "hs-pose", "--models", folder / "views" / "models")
    detect.wait_until_ready()
    pose.wait_until_ready()
    return detect, pose


def check_account(summary, sent):
    """Every frame is accounted for, and none was lost on the way."""
    account = summary["account"]
    assert summary["frames_received"] == sent, summary
    assert account["balanced"] and account["lost"] == 0 and account["refused"] == 0, account
    assert account["detected"] + account["skipped"] == sent, account
    assert summary["frames_detected"] == account["detected"], summary
    pose = summary["processes"]["hs-pose"]
    assert pose["received"] == account["detected"] and pose["refused"] == 0, pose
    assert pose["processed"] + pose["skipped"] == pose["received"], pose
    assert summary["frames_with_poses"] == pose["processed"], summary
    assert summary["latency_ms"]["total"]["p50"] > 0.0, summary


def replay(tools, folder):
    """Replays the log through the processes with LCM's own tools; returns all events that were heard."""
    recorded = folder / "recorded.log"
    logger = subprocess.Popen(["lcm-logger", "-f", "-q", str(recorded)], stderr=subprocess.DEVNULL)
    observe = Process(folder, tools / "hs-observe", "--expect", REPLAYED, "--out", folder / "observed.json")
    processes = [observe]
    try:
        observe.wait_until_ready()
        processes += start_stream(tools, folder)
        run("lcm-logplayer", folder / "replay.log", stdout=subprocess.DEVNULL)
        observe.wait(30)
        for process in processes[1:]:
            process.stop()
    finally:
        logger.terminate()
        logger.wait()
        for process in processes:
            process.kill()
    check_account(json.loads((folder / "observed.json").read_text()), REPLAYED)
    return list(read_log(recorded))


def capture_live(tools, folder):
    """hs-capture itself on the bus, raw images: 1.5 MB a frame must not be lost either."""
    observe = Process(folder, tools / "hs-observe", "--expect", FRAMES, "--out", folder / "live.json")
    processes = [observe]
    try:
        observe.wait_until_ready()
        processes += start_stream(tools, folder)
        run(tools / "hs-capture", "--source", f"bop:{folder / 'scene'}", "--raw-colour", "--raw-depth", "--rate", 10)
        observe.wait(30)
        for process in processes[1:]:
            process.stop()
    finally:
        for process in processes:
            process.kill()
    check_account(json.loads((folder / "live.json").read_text()), FRAMES)


def detect_offline(tools, folder):
    """Detections of every frame of the scene, by utime, straight from the log and with one thread."""
    results = folder / "results.log"
    run(tools / "hs-detect", "--forest", folder / "small.forest", "--threads", 1, "--threshold", THRESHOLD,
        "-l", f"file://{folder / 'scene.log'}", "--output-log", results)
    return detections_by_utime(read_log(results))


def iou(a, b):
    width = min(a[0] + a[2], b[0] + b[2]) - max(a[0], b[0])
    height = min(a[1] + a[3], b[1] + b[3]) - max(a[1], b[1])
    shared = max(width, 0) * max(height, 0)
    return shared / (a[2] * a[3] + b[2] * b[3] - shared)


def is_found(detection, item, info):
    return detection.class_id == item["obj_id"] and iou(detection.box, info["bbox_visib"]) >= 0.5


def check_detections(truth, offline):
    """Most of the well visible taught objects are found where they are."""
    wanted = found = 0
    for objects, detections in zip(truth, (offline[utime] for utime in sorted(offline))):
        for item, info in objects:
            if item["obj_id"] not in CLASSES or info["visib_fract"] < 0.6:
                continue
            wanted += 1
            found += any(is_found(detection, item, info) for detection in detections)
    print(f"{found} of {wanted} well visible objects found by a forest of 6 trees")
    assert wanted >= FRAMES and found >= 0.7 * wanted, (found, wanted)


def check_same_on_the_bus(heard, offline):
    """The results over the network are those of the log: other threads, other timing, same detections."""
    compared = {utime: found for utime, found in detections_by_utime(heard).items() if utime in offline}
    for utime, found in compared.items():
        assert found == offline[utime], utime
    assert compared, "no detections of the scene's first round were heard"


def check_poses(truth, folder, heard):
    """A pose that claims to be valid is near the truth where an object was found."""
    utimes = [utime_of(data) for _, _, data in read_log(folder / "replay.log")]
    objects_of = {utime: truth[i % FRAMES] for i, utime in enumerate(utimes)}
    detections = detections_by_utime(heard)
    errors = []
    for data in (data for _, channel, data in heard if channel == "HOUGHSTREAM_POSES"):
        for _, index, status, translation in poses_of(data):
            detection = detections[utime_of(data)][index]
            places = [item["cam_t_m2c"] for item, info in objects_of[utime_of(data)] if is_found(detection, item, info)]
            if status == VALID and places:
                errors.append(sum((t - p * 1e-3) ** 2 for t, p in zip(translation, places[0])) ** 0.5)
    near = sum(error < 0.03 for error in errors)
    print(f"{near} of {len(errors)} valid poses of found objects within 3 cm of the truth")
    assert near >= 5 and near >= 0.7 * len(errors), sorted(errors)


def check_min_quality(tools, folder):
    """hs-pose withholds what is less sure than it was asked for: nothing is as sure as this."""
    strict = folder / "strict.log"
    run(tools / "hs-pose", "--models", folder / "views" / "models", "--min-quality", 1, "-l",
        f"file://{folder / 'recorded.log'}", "--output-log", strict)
    statuses = [status for _, channel, data in read_log(strict) if channel == "HOUGHSTREAM_POSES"
                for _, _, status, _ in poses_of(data)]  # fmt: skip
    assert statuses and VALID not in statuses, statuses
    result = subprocess.run([str(tools / "hs-pose"), "--min-quality", "1.5"], capture_output=True, text=True, check=False,
                            timeout=20)
    assert result.returncode != 0 and "--min-quality" in result.stderr, result


def check_bad_input(tools, folder):
    """A cut log: one clear line, and a failure."""
    cut = folder / "cut.log"
    cut.write_bytes((folder / "scene.log").read_bytes()[:-1000])
    result = subprocess.run([str(tools / "hs-detect"), "--forest", str(folder / "small.forest"), "-l", f"file://{cut}",
                             "--output-log", str(folder / "none.log")], capture_output=True, text=True, check=False)
    assert result.returncode != 0 and f"{cut}: cut in event {FRAMES - 1}" in result.stderr, result
    truncated = folder / "cut.forest"
    truncated.write_bytes((folder / "small.forest").read_bytes()[:1000])
    result = subprocess.run([str(tools / "hs-detect"), "--forest", str(truncated)], capture_output=True, text=True,
                            check=False, timeout=20)
    assert result.returncode != 0 and str(truncated) in result.stderr, result


def check_strange_names(tools, folder):
    """Sides that share no name cannot be compared: one line that names both sides, and a failure, instead of figures of
    nothing."""
    scene, forest, models = folder / "scene", folder / "small.forest", folder / "views" / "models"
    strange = folder / "strange_models"
    strange.mkdir(exist_ok=True)
    for name, copy in (("obj_000001.ply", "teapot.ply"), ("obj_000001.png", "obj_000001.png")):  # the mesh names its texture
        (strange / copy).write_bytes((models / name).read_bytes())
    log = ("--log", folder / "results.log")
    for words, (a, b) in (
        ((*log, "--forest", forest, "--models", strange), ("the forest", "has teapot")),
        ((*log, "--classes", "teapot,kettle"), ("--classes has kettle, teapot", "the scene")),
        ((*log, "--forest", forest), (None, None)),
    ):
        command = [str(word) for word in (tools / "hs-evaluate", "--scene", scene, *words)]
        result = subprocess.run(command, capture_output=True, text=True, check=False, timeout=60)
        if b is None:
            assert result.returncode == 0, result
            continue
        assert result.returncode == 1 and result.stdout == "" and result.stderr.count("\n") == 1, result
        assert all(part in result.stderr for part in ("no name in common: ", a, b)), result


def state_of(folder):
    """Changes with every file that is written, made or removed."""
    return {file: (file.stat().st_size, file.stat().st_mtime_ns) for file in folder.rglob("*") if file.is_file()}


def check_refusals(tools, folder):
    """A command that would overwrite existing data is refused, in one line that says why; nothing has changed."""
    scene, log, forest, models = (folder / name for name in ("scene", "scene.log", "small.forest", "views/models"))
    of_scene, played = ("--scene", scene), ("-l", f"file://{folder / 'recorded.log'}")
    no_results = ("-l", f"file://{log}", "--output-log", folder / "results.log")
    taught = ("--views", f"bop:{folder / 'views'}", "--background", f"bop:{folder / 'background'}", "--trees", 1)
    before = state_of(folder)
    for words, part in (
        (("hs-capture", "--source", f"oni:{log}", "--log", log), f"{log}: is the source itself"),
        (("hs-capture", "--source", f"bop:{scene}", "--log", scene / "scene_gt.json"), f"lies in {scene}"),
        (("hs-log", "import", f"bop:{scene}", scene / "scene_camera.json", "--replace"), f"lies in {scene}"),
        (("hs-render", "background", "--count", 1, "--out", folder / "background"), "holds pictures already"),
        (("hs-fuse", "--views", f"bop:{folder / 'views'}", "--out", models), f"lies in {folder / 'views'}"),
        (("hs-train", *taught, "--out", folder / "none" / "forest"), "there is no folder"),
        (("hs-train", *taught, "--out", scene), f"{scene}: is a folder"),
        (("hs-fuse", "--views", f"bop:{folder / 'views'}", "--out", log), f"{log}: cannot be a folder"),
        (("hs-detect", "--forest", forest, *played, "--output-log", forest), f"{forest}: is the source itself"),
        (("hs-pose", "--models", models, *played, "--output-log", models / "names.json"), f"lies in {models}"),
        (("hs-track", "--models", models, *played, "--output-log", models / "names.json"), f"lies in {models}"),
        (("hs-detect", "--forest", forest, *played), "give --output-log"),
        (("hs-pose", "--models", models, *played), "give --output-log"),
        (("hs-track", "--models", models, *played), "give --output-log"),
        (("hs-detect", "--forest", forest, *no_results, "-c", "NOPE"), f"its messages are on OPENNI_FRAME ({FRAMES})"),
        (("hs-pose", "--models", models, *no_results), f"its messages are on OPENNI_FRAME ({FRAMES})"),
        (("hs-track", "--models", models, *no_results), "no poses of frames on OPENNI_FRAME"),
        (("hs-track", "--check", *played, "--output-log", folder / "results.log"), "--check publishes nothing"),
        (("hs-observe", *played), "lcm-logplayer, expected a network URL"),
        (("hs-observe", "--out", folder / "none" / "summary.json"), "there is no folder"),
        (("hs-observe", "--csv", scene), f"{scene}: is a folder"),
        (("hs-view", "--snapshot", folder / "none.nosuch"), f"{folder / 'none.nosuch'}: not a picture format"),
        (("hs-view", "--video", folder / "none"), f"{folder / 'none'}: no name of a video"),
        (("hs-study", "hough", "--forest", forest, *of_scene, "--frame", 0, "--out", scene / "rgb/000000.png"), f"lies in {scene}"),
        (("hs-evaluate", "--log", folder / "results.log", *of_scene, "--out", scene), f"{scene}: is the source itself"),
        (("hs-evaluate", "--log", folder / "results.log", *of_scene, "--out", log), f"{log}: cannot be a folder"),
        (("hs-evaluate", "--forest", forest, *of_scene, "--latency", folder / "none.csv"), f"{folder / 'none.csv'}: missing"),
        (("hs-study", "quality", "--forest", forest, "--models", models, *of_scene), "1 scene, expected at least 4"),
    ):
        command = [str(word) for word in (tools / words[0], *words[1:])]
        result = subprocess.run(command, capture_output=True, text=True, check=False, timeout=60)
        assert result.returncode == 1 and result.stderr and part in result.stderr.splitlines()[-1], result
        assert state_of(folder) == before, result


def main():
    enter_private_network()
    arguments = read_arguments(__doc__)
    tools, folder = arguments.tools, arguments.out
    truth = make_data(tools, folder)
    offline = detect_offline(tools, folder)
    assert len(offline) == FRAMES, "a log is worked on without skipping"
    check_detections(truth, offline)
    heard = replay(tools, folder)
    check_same_on_the_bus(heard, offline)
    check_poses(truth, folder, heard)
    capture_live(tools, folder)
    check_live_stream(tools, folder, start_stream, offline)
    check_min_quality(tools, folder)
    check_bad_input(tools, folder)
    check_strange_names(tools, folder)
    check_refusals(tools, folder)
    print("end to end: everything accounted for")


if __name__ == "__main__":
    sys.exit(main())
