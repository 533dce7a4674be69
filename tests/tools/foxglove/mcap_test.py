"""What hs-log export mcap writes, read by MCAP's own reader: each message beside what the log holds.

Usage: mcap_test.py --tools FOLDER --packages FOLDER --out FOLDER
"""

import argparse
import base64
import collections
import io
import json
import math
import pathlib
import struct
import subprocess

from PIL import Image

from houghstream.event_log import Event, write_event
from houghstream.image_t import image_t
from houghstream.object_pose_t import object_pose_t
from houghstream.placed_frame_t import placed_frame_t
from houghstream.placed_object_t import placed_object_t
from houghstream.placed_objects_t import placed_objects_t
from houghstream.rigid_transform_t import rigid_transform_t
from node_tests import require_packages, run_node
from scripted_stream import CAMERA, HEIGHT, WIDTH, detections_message, frame_message, objects_message, poses_message

CHANNEL = "OPENNI_FRAME"
START = 1_700_000_000_250_000  # microseconds since the epoch
PERIOD = 33_000
FRAMES = 4
BOWL = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n" \
       "element face 2\nproperty list uchar int vertex_indices\nend_header\n" \
       "0 0 0\n100 0 0\n0 100 0\n0 0 50\n3 0 1 2\n3 0 2 3\n"  # fmt: skip
TYPES = {
    f"/{CHANNEL}/colour": "foxglove.CompressedImage",
    f"/{CHANNEL}/depth": "foxglove.RawImage",
    f"/{CHANNEL}/calibration": "foxglove.CameraCalibration",
    f"/{CHANNEL}/annotations": "foxglove.ImageAnnotations",
    f"/{CHANNEL}/objects/bowl": "foxglove.SceneUpdate",
    "/objects/bowl_1": "foxglove.SceneUpdate",
    "/objects/mug <b>_2": "foxglove.SceneUpdate",
    "/transforms": "foxglove.FrameTransforms",
}


def jpeg_of(turn):
    file = io.BytesIO()
    Image.new("RGB", (WIDTH, HEIGHT), (8 * turn, 200, 30)).save(file, "JPEG")
    return file.getvalue()


def frame_of(utime, turn):
    """Raw colour in every second frame, JPEG in the others."""
    message = frame_message(utime, turn)
    if turn % 2:
        image = message.images[0]
        image.pixelformat, image.row_stride, image.data = image_t.PIXEL_FORMAT_MJPEG, 0, jpeg_of(turn)
        image.size = len(image.data)
    return message


def placed_message(utime):
    """The mug's box, a hand's breadth above its origin, and a frame on it."""
    mug = placed_object_t()
    mug.track_id, mug.class_name = 2, "mug <b>"
    mug.box_trans, mug.box_quat, mug.box_size = [0.1, 0.2, 0.05], [1.0, 0.0, 0.0, 0.0], [0.08, 0.08, 0.1]
    handle = placed_frame_t()
    handle.name, handle.trans, handle.quat = "handle", [0.15, 0.2, 0.05], [1.0, 0.0, 0.0, 0.0]
    mug.n_frames, mug.frames = 1, [handle]
    message = placed_objects_t()
    message.utime, message.source_channel, message.world, message.world_number = utime, CHANNEL, "WORLD", 1
    message.n_objects, message.objects = 1, [mug]
    return message


def camera_message(utime):
    message = rigid_transform_t()
    message.utime, message.trans, message.quat = utime, [1.0, 2.0, 3.0], [0.0, 1.0, 0.0, 0.0]
    return message


def found_in(turn):
    """The bowl is not found in the last frame."""
    objects = [("bowl", 0.6 + 0.01 * turn, object_pose_t.VALID), ("mug <b>", 0.3, object_pose_t.REJECTED_BY_DEPTH)]
    return objects[1:] if turn == FRAMES - 1 else objects


def events():
    """Yields time of receipt, channel and message: results come 5 and 9 ms after their frame."""
    for turn in range(FRAMES):
        utime = START + PERIOD * turn
        objects = found_in(turn)
        yield utime, CHANNEL, frame_of(utime, turn)
        if turn == 0:
            yield utime + 1000, f"{CHANNEL}_TO_WORLD", camera_message(utime)
        yield utime + 5000, "HOUGHSTREAM_DETECTIONS", detections_message(utime, CHANNEL, objects)
        yield utime + 9000, "HOUGHSTREAM_POSES", poses_message(utime, CHANNEL, objects, 7.5)
        yield utime + 10_000, "HOUGHSTREAM_PLACED_OBJECTS", placed_message(utime)
        yield utime + 11_000, "HOUGHSTREAM_OBJECTS", objects_message(utime, CHANNEL, turn)


def write_log(file):
    with open(file, "wb") as log:
        for number, (timestamp, channel, message) in enumerate(events()):
            write_event(log, number, Event(timestamp, channel, message.encode()))
            if number == 3:
                log.write(b"damage")
        write_event(log, 1000, Event(START, "HOUGHSTREAM_POSES", b"no message"))


def export(arguments, log, out):
    models = arguments.out / "models"
    models.mkdir(exist_ok=True)
    (models / "bowl.ply").write_text(BOWL)
    command = [arguments.tools / "hs-log", "export", "mcap", log, out, "--replace", "--models", models, "--camera",
               CAMERA]  # fmt: skip
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stderr
    return done


def at(utime):
    return {"seconds": utime // 1_000_000, "nanos": utime % 1_000_000 * 1000}


def check_times_and_types(messages):
    assert {message["topic"]: message["schema"] for message in messages} == TYPES
    counts = collections.Counter(message["topic"] for message in messages)
    for part in ("colour", "depth", "calibration", "annotations"):
        assert counts[f"/{CHANNEL}/{part}"] == FRAMES, counts
    log_times = {message["log_us"] for message in messages if message["topic"] == f"/{CHANNEL}/annotations"}
    assert log_times == {START + PERIOD * turn + 9000 for turn in range(FRAMES)}, log_times
    for message in messages:
        assert (message["publish_us"] - START) % PERIOD == 0, message


def check_images(by_topic):
    for turn, message in enumerate(by_topic[f"/{CHANNEL}/colour"]):
        content, utime = message["content"], START + PERIOD * turn
        assert message["log_us"] == message["publish_us"] == utime, message
        assert content["timestamp"] == at(utime) and content["frame_id"] == CHANNEL and content["format"] == "jpeg", content
        data = base64.b64decode(content["data"])
        if turn % 2:
            assert data == jpeg_of(turn), "a JPEG is not as it was"
        red, green, blue = Image.open(io.BytesIO(data)).convert("RGB").getpixel((20, 20))
        wanted = (8 * turn, 200, 30) if turn % 2 else [8 * turn + 4] * 3
        assert max(abs(a - b) for a, b in zip((red, green, blue), wanted)) <= 4, (turn, red, green, blue)
    for turn, message in enumerate(by_topic[f"/{CHANNEL}/depth"]):
        content = message["content"]
        assert (content["width"], content["height"], content["encoding"], content["step"]) == (WIDTH, HEIGHT, "16UC1", 2 * WIDTH)
        assert base64.b64decode(content["data"]) == struct.pack("<H", 900) * (WIDTH * HEIGHT)
        assert content["timestamp"] == at(START + PERIOD * turn)
    calibration = by_topic[f"/{CHANNEL}/calibration"][0]["content"]
    assert calibration["K"] == [58, 0, 32, 0, 58, 24, 0, 0, 1], calibration
    assert calibration["P"] == [58, 0, 32, 0, 0, 58, 24, 0, 0, 0, 1, 0] and calibration["width"] == WIDTH, calibration


def check_annotations(by_topic):
    bowl_and_mug = by_topic[f"/{CHANNEL}/annotations"][1]["content"]
    assert [text["text"] for text in bowl_and_mug["texts"]] == ["bowl 0.61, quality 0.90", "mug <b> 0.30"], bowl_and_mug
    box = bowl_and_mug["points"][0]
    assert box["type"] == "LINE_LOOP" and box["timestamp"] == at(START + PERIOD), box
    assert [(p["x"], p["y"]) for p in box["points"]] == [(10, 8), (24, 8), (24, 28), (10, 28)], box
    assert bowl_and_mug["circles"] == [], "readers walk through all lists"
    assert len(by_topic[f"/{CHANNEL}/annotations"][-1]["content"]["points"]) == 1


def check_transforms(by_topic):
    children = collections.defaultdict(list)
    for message in by_topic["/transforms"]:
        for transform in message["content"]["transforms"]:
            children[transform["parent_frame_id"], transform["child_frame_id"]].append(transform)
    assert set(children) == {("WORLD", CHANNEL), (CHANNEL, f"{CHANNEL}/bowl"), ("WORLD", "bowl_1"), ("WORLD", "mug <b>_2"),
                             ("WORLD", "mug <b>_2/handle")}, set(children)  # fmt: skip
    bowl = children[CHANNEL, f"{CHANNEL}/bowl"]
    assert len(bowl) == FRAMES - 1 and bowl[0]["translation"] == {"x": 0.1, "y": 0, "z": 0.9}, bowl
    assert bowl[0]["rotation"] == {"x": 0, "y": 0, "z": 0, "w": 1}, bowl
    sent, tracked = children["WORLD", CHANNEL][:2]
    assert sent["translation"] == {"x": 1, "y": 2, "z": 3} and sent["rotation"]["x"] == 1, sent
    assert tracked["translation"] == {"x": 0, "y": -0.8, "z": 0.6}, tracked
    last = children["WORLD", "bowl_1"][-1]["translation"]
    assert math.isclose(last["x"], 0.3 * math.cos(0.2 * (FRAMES - 1)), abs_tol=1e-12), last
    assert children["WORLD", "mug <b>_2/handle"][0]["translation"] == {"x": 0.15, "y": 0.2, "z": 0.05}


def check_scene(by_topic):
    appeared, gone = (message["content"] for message in by_topic[f"/{CHANNEL}/objects/bowl"])
    (entity,) = appeared["entities"]
    assert entity["frame_id"] == f"{CHANNEL}/bowl" and entity["frame_locked"] and entity["texts"][0]["text"] == "bowl", entity
    (model,) = entity["models"]
    glb = base64.b64decode(model["data"])
    assert model["media_type"] == "model/gltf-binary" and glb[:4] == b"glTF" and struct.unpack_from("<I", glb, 8)[0] == len(glb)
    assert gone["entities"] == [] and gone["deletions"][0]["type"] == "ALL", gone
    assert len(by_topic["/objects/bowl_1"]) == 1, "a model is sent once"
    (entity,) = by_topic["/objects/mug <b>_2"][0]["content"]["entities"]
    (cube,) = entity["cubes"]
    assert entity["models"] == [] and cube["size"] == {"x": 0.08, "y": 0.08, "z": 0.1}, entity
    assert math.isclose(cube["pose"]["position"]["z"], 0.05) and math.isclose(cube["pose"]["position"]["x"], 0.0, abs_tol=1e-9), cube


def check_file(arguments):
    arguments.out.mkdir(parents=True, exist_ok=True)
    log, out = arguments.out / "stream.lcmlog", arguments.out / "stream.mcap"
    write_log(log)
    done = export(arguments, log, out)
    assert done.stdout == f"{FRAMES} frames in {out}\n", done.stdout
    assert "6 bytes lost at 1 damaged place" in done.stderr and "1 left out" in done.stderr, done.stderr
    content = json.loads(run_node(arguments.packages, "read_mcap.js", out))
    assert content["library"] == "houghstream" and content["chunks"] >= 1, content
    messages = content["messages"]
    by_topic = collections.defaultdict(list)
    for message in messages:
        by_topic[message["topic"]].append(message)
    check_times_and_types(messages)
    check_images(by_topic)
    check_annotations(by_topic)
    check_transforms(by_topic)
    check_scene(by_topic)
    return len(messages)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tools", type=pathlib.Path, required=True, help="folder of hs-log")
    parser.add_argument("--packages", type=pathlib.Path, required=True, help="folder of the npm packages")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="folder for the files")
    arguments = parser.parse_args()
    require_packages(arguments.packages)
    print(check_file(arguments), "messages are read as they were written")


if __name__ == "__main__":
    main()
