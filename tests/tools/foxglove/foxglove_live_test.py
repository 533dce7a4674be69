"""hs-view --foxglove as Foxglove's own client sees it: channels, their schemas, decoded messages of a stream that goes on, a
client that comes late, and the end.

Usage: foxglove_live_test.py --tools FOLDER --packages FOLDER --out FOLDER
"""

import argparse
import base64
import contextlib
import io
import json
import pathlib
import socket
import struct
import subprocess
import threading
import time

from PIL import Image

from node_tests import node_command, require_packages
from scripted_stream import CAMERA, HEIGHT, WIDTH, ToldStream
from studies.stream import Processes, enter_private_network

SECONDS = 60  # at most, for what takes a second where nothing else runs
CHANNEL = "OPENNI_FRAME"
COUNT = 5
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


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Viewer:
    """Foxglove's client in node; use with `with`."""

    def __init__(self, packages, port):
        command, environment = node_command(packages, "live_client.js", f"ws://localhost:{port}", COUNT, *TYPES)
        self.process = subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.timer = threading.Timer(SECONDS, self.process.kill)

    def __enter__(self):
        self.timer.start()
        return self

    def __exit__(self, *_):
        self.timer.cancel()
        self.process.kill()
        self.process.communicate()

    def line(self):
        text = self.process.stdout.readline()
        assert text, self.process.stderr.read() or f"nothing within {SECONDS} s"
        return json.loads(text)


def utime_of(message):
    stamp = message["content"]["timestamp"]
    return 1_000_000 * stamp["seconds"] + stamp["nanos"] // 1000


def check_messages(seen):
    assert seen["protocol"] == "foxglove.websocket.v1" and seen["info"]["name"] == "hs-view", seen["info"]
    assert seen["schemas"] == TYPES, seen["schemas"]
    messages = seen["messages"]
    colour = messages[f"/{CHANNEL}/colour"]
    times = [utime_of(message) for message in colour]
    assert times == sorted(set(times)), times
    assert all(0 <= message["received_us"] - utime_of(message) < 1e6 * SECONDS for message in colour), colour[0]["received_us"]
    image = Image.open(io.BytesIO(base64.b64decode(colour[0]["content"]["data"])))
    assert image.size == (WIDTH, HEIGHT), image.size
    depth = messages[f"/{CHANNEL}/depth"][0]["content"]
    assert base64.b64decode(depth["data"]) == struct.pack("<H", 900) * (WIDTH * HEIGHT) and depth["encoding"] == "16UC1"
    assert messages[f"/{CHANNEL}/calibration"][0]["content"]["K"] == [58, 0, 32, 0, 58, 24, 0, 0, 1]
    boxes = messages[f"/{CHANNEL}/annotations"][-1]["content"]
    assert [text["text"].split(" 0.")[0] for text in boxes["texts"]] == ["bowl", "mug <b>"], boxes
    assert boxes["points"][0]["timestamp"] in [message["content"]["timestamp"] for message in colour], "boxes of no image"
    frames = {(t["parent_frame_id"], t["child_frame_id"]) for message in messages["/transforms"] for t in message["content"]["transforms"]}
    assert {(CHANNEL, f"{CHANNEL}/bowl"), ("WORLD", CHANNEL), ("WORLD", "SIDE"), ("WORLD", "bowl_1")} <= frames, frames
    for topic in (f"/{CHANNEL}/objects/bowl", "/objects/bowl_1"):
        assert len(messages[topic]) == 1 and messages[topic][0]["content"]["entities"][0]["texts"][0]["text"] == "bowl", messages[topic]


def check_stream(arguments):
    port = free_port()
    with contextlib.ExitStack() as stack:
        processes = stack.enter_context(Processes(arguments.out))
        view = processes.start("hs-view", arguments.tools / "hs-view", "--foxglove", port, "--camera", CAMERA)
        view.wait_until_ready(SECONDS)
        assert f"open a connection to ws://localhost:{port}" in view.log.read_text(), view.log.read_text()
        early = stack.enter_context(Viewer(arguments.packages, port))
        stack.enter_context(ToldStream())
        check_messages(early.line())
        late = stack.enter_context(Viewer(arguments.packages, port))
        check_messages(late.line())
        start = time.monotonic()
        view.stop(10)
        assert time.monotonic() - start < 3, "it takes long to end with clients"
        for viewer in (early, late):
            assert viewer.line() == {"closed": 1001, "reason": "hs-view ends"}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tools", type=pathlib.Path, required=True, help="folder of hs-view")
    parser.add_argument("--packages", type=pathlib.Path, required=True, help="folder of the npm packages")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="folder for words")
    arguments = parser.parse_args()
    require_packages(arguments.packages)
    enter_private_network()
    arguments.out.mkdir(parents=True, exist_ok=True)
    check_stream(arguments)
    print("Foxglove's client understands the stream")


if __name__ == "__main__":
    main()
