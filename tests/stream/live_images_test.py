"""A running stream on a display: lcm-spy with our viewers, the preview channel, and hs-view's window.

Plays a scene live through hs-detect and hs-pose, opens the windows on a display without a screen, checks by their
pixels that boxes and pose axes are drawn, and keeps the images: spy.png, spy_rgbd.png, spy_detections.png,
spy_preview.png, view.png. Data and forest are those that end_to_end_test.py made.
"""

import argparse
import os
import pathlib
import struct
import subprocess
import sys
import time

from studies.stream import Process, enter_private_network
from studies.virtual_display import AWAY, VirtualDisplay, open_viewer, row_of_table

BOX_COLOURS = {"bowl": (0xE6, 0x9F, 0x00), "soda_can": (0xF0, 0xE4, 0x42)}
AXES = ((255, 60, 60), (60, 220, 60), (60, 120, 255))  # x, y, z
COLOUR_SIZE = (640, 480)  # of the scene's frames


def wait_until(condition, complaint, seconds=60):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, complaint
        time.sleep(0.2)


def overlay_pixels(image):
    """Pixels in the colours of boxes, and in the rarest colour of the axes."""
    boxes = sum(image.count(colour) for colour in BOX_COLOURS.values())
    return boxes, min(image.count(colour) for colour in AXES)


def await_overlay(display, window, size=None, seconds=120):
    """The first image of a window on which a box and all three axes are drawn over a photograph, whose place is the
    upper left corner of this size."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        image = display.photograph(window)
        width, height = size or (image.width, image.height)
        boxes, axis = overlay_pixels(image.cut(0, 0, width, height))
        if boxes > 300 and axis > 25 and image.colours() > 5000:
            return image
        time.sleep(0.3)
    raise AssertionError(f"no overlay after {seconds} s: {boxes} box pixels, {axis} axis pixels")


def written(image, row):
    """Returns whether there is text in the first column of a row."""
    return image.cut(2, row_of_table(row) - 6, 120, 12).count((51, 51, 51)) > 20  # the colour of its text


def rows_of(image):
    """Returns how many rows of spy's table are written."""
    return sum(written(image, row) for row in range(1, 20))


def check_spy(tools, logs, display, out):
    spy = Process(logs, tools / "hs-spy")
    try:
        table = display.window("LCM Spy")
        wait_until(lambda: rows_of(display.photograph(table)) >= 6, "fewer than 6 channels in spy's table")
        time.sleep(2)  # spy counts rates once a second
        display.photograph(table).save(out / "spy.png")
        frames = open_viewer(display, spy, "OPENNI_FRAME")
        check_frames(display, frames, out)
        detections = open_viewer(display, spy, "HOUGHSTREAM_DETECTIONS")
        await_overlay(display, detections).save(out / "spy_detections.png")
        display.do("windowsize", detections, 300, 200)  # smaller than anything fits
        display.do("windowsize", detections, 620, 700)
        await_overlay(display, detections)
        display.do("windowmove", detections, AWAY, AWAY)
        preview = open_viewer(display, spy, "HOUGHSTREAM_PREVIEW")
        wait_until(lambda: display.photograph(preview).colours() >= 5000, "the preview shows nothing")
        display.photograph(preview).save(out / "spy_preview.png")
        assert spy.process.poll() is None and "Exception" not in spy.log.read_text(), spy.log.read_text()
    finally:
        spy.kill()


def check_no_route(tools):
    """Without a multicast route hs-spy says so, instead of showing an empty table."""
    command = ["unshare", "-rn", str(tools / "hs-spy")]
    result = subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)
    assert result.returncode == 1 and "is there a multicast route?" in result.stderr, result


def check_frames(display, window, out):
    """Colour beside depth: the right half holds the warm and cold colours of the map, the left hardly any."""
    end = time.monotonic() + 60
    while True:
        image = display.photograph(window)
        left = image.cut(0, 0, image.width // 2, image.height)
        right = image.cut(image.width // 2, 0, image.width // 2, image.height)
        vivid = [sum(max(row[x : x + 3]) - min(row[x : x + 3]) > 180 for row in half.rows for x in range(0, len(row), 3))
                 for half in (left, right)]
        if left.colours() > 5000 and vivid[1] > 50000 > 5 * vivid[0]:
            break
        assert time.monotonic() < end, f"{left.colours()} colours, {vivid} vivid pixels"
        time.sleep(0.3)
    image.save(out / "spy_rgbd.png")
    display.do("windowmove", window, AWAY, AWAY)


def check_view(tools, data, logs, display, out):
    view = Process(logs, tools / "hs-view", "--models", data / "views" / "models", "--rate", 30)
    try:
        window = display.window("Houghstream")
        await_overlay(display, window, COLOUR_SIZE)
        time.sleep(5)  # for a chart with something in it
        await_overlay(display, window, COLOUR_SIZE).save(out / "view.png")
        width = display.geometry(window)[2]
        display.do("windowfocus", window)
        press(display, "d", lambda: display.geometry(window)[2] < width, "d does not hide the depth")
        press(display, "3", lambda: display.geometry(window)[2] == width, "3 does not show 3-D")
        check_saving(display, window)
        press(display, "space", lambda: is_still(display, window), "space does not pause")
        press(display, "q", lambda: view.process.poll() == 0, "q does not end hs-view")
    finally:
        view.kill()


def check_saving(display, window):
    """s saves the image that is shown, in the folder where hs-view was started."""
    saved = lambda: list(pathlib.Path().glob("view_*.png"))
    for file in saved():
        file.unlink()
    press(display, "s", lambda: saved() and saved()[0].read_bytes().endswith(b"IEND\xaeB`\x82"), "s saves no picture")
    size = struct.unpack(">II", saved()[0].read_bytes()[16:24])
    saved()[0].unlink()
    assert size == display.geometry(window)[2:], (size, display.geometry(window))


def press(display, key, condition, complaint):
    """Presses a key once and waits for what it does."""
    display.do("key", key)
    wait_until(condition, complaint)


def is_still(display, window):
    before = display.photograph(window).rows
    time.sleep(1.5)
    return display.photograph(window).rows == before


def check_no_display(tools):
    """Without a display, one clear line that names the ways to go on."""
    for display in ("", ":9999"):
        result = subprocess.run([str(tools / "hs-view")], env=dict(os.environ, DISPLAY=display), capture_output=True,
                                text=True, check=False, timeout=30)
        assert result.returncode == 1 and result.stderr.count("\n") == 1, result
        assert "no display" in result.stderr and "--snapshot" in result.stderr, result


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tools", type=pathlib.Path, required=True, help="folder of the executables")
    parser.add_argument("--data", type=pathlib.Path, required=True, help="what end_to_end_test.py made")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="folder for the pictures")
    arguments = parser.parse_args()
    enter_private_network()
    tools, data, out = arguments.tools.resolve(), arguments.data.resolve(), arguments.out.resolve()
    logs = out / "log"
    logs.mkdir(parents=True, exist_ok=True)
    check_no_display(tools)
    processes = []
    with VirtualDisplay(logs) as display:
        try:
            processes.append(Process(logs, tools / "hs-detect", "--forest", data / "small.forest", "--threads", 1))
            processes.append(Process(logs, tools / "hs-pose", "--models", data / "views" / "models"))
            processes.append(Process(logs, tools / "hs-view", "--models", data / "views" / "models", "--preview",
                                     name="preview"))
            for process in processes:
                process.wait_until_ready()
            processes.append(Process(logs, tools / "hs-capture", "--source", f"bop:{data / 'scene'}", "--loop", "--rate",
                                     10, "--jpeg-quality", 80))
            if subprocess.run(["unshare", "-rn", "true"], capture_output=True, check=False).returncode == 0:
                check_no_route(tools)
            check_spy(tools, logs, display, out)
            check_view(tools, data, logs, display, out)
        finally:
            for process in processes:
                process.kill()
    print(f"pictures in {out}")


if __name__ == "__main__":
    sys.exit(main())
