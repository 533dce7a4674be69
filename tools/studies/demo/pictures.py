"""The front page's pictures, of a stream that goes on: hs-view's window, and lcm-spy's viewer of detections."""

import shutil
import time

from PIL import Image
from studies.command import die, step
from studies.measured import threads
from studies.stream import Processes
from studies.virtual_display import VirtualDisplay, open_viewer

RATE_HZ = 10
AXES = ((255, 60, 60), (60, 220, 60), (60, 120, 255))  # the colours of x, y, z
VIEW_SIZE = (640, 480)  # where hs-view's window shows colour
LOOKS, BETWEEN_S = 12, 1.0


def best_picture(display, window, size=None):
    """Of some looks at a window the one with the most pose axes in its upper left part of this size."""
    best, most = None, -1
    for _ in range(LOOKS):
        time.sleep(BETWEEN_S)
        picture = display.photograph(window)
        part = picture.cut(0, 0, *(size or (picture.width, picture.height)))
        axes = min(part.count(colour) for colour in AXES)
        if axes > most:
            best, most = picture, axes
    if most == 0:
        die("no pose is drawn, expected some")
    return best


def save_jpeg(picture, file):
    Image.frombytes("RGB", (picture.width, picture.height), b"".join(picture.rows)).save(file, quality=88)


def take(options, demo):
    """Writes hs_view.jpg and lcm_spy.jpg into the folder that is asked for."""
    for program in ("Xvfb", "xdotool"):
        if not shutil.which(program):
            die(f"{program}: not there; sudo apt-get install xvfb xdotool")
    step("pictures of a stream")
    programs, models = options.programs, demo.store.path("training") / "models"
    scene = ("--source", f"bop:{demo.store.path('scene')}", "--loop", "--rate", RATE_HZ, "--jpeg-quality", 90)
    options.pictures.mkdir(parents=True, exist_ok=True)
    with VirtualDisplay(options.out) as display, Processes(options.out / "pictures") as running:
        running.start("detect", programs / "hs-detect", "--forest", demo.store.path("forest"), "--threads", threads())
        running.start("pose", programs / "hs-pose", "--models", models)
        for name in ("detect", "pose"):
            running.by_name[name].wait_until_ready()
        running.start("capture", programs / "hs-capture", *scene)
        running.start("view", programs / "hs-view", "--models", models, "--rate", RATE_HZ)
        save_jpeg(best_picture(display, display.window("Houghstream"), VIEW_SIZE), options.pictures / "hs_view.jpg")
        running.stop("view")
        spy = running.start("spy", programs / "hs-spy")
        display.window("LCM Spy")
        time.sleep(BETWEEN_S)  # spy counts rates once a second
        save_jpeg(best_picture(display, open_viewer(display, spy, "HOUGHSTREAM_DETECTIONS")), options.pictures / "lcm_spy.jpg")
    print(f"{options.pictures}/hs_view.jpg, {options.pictures}/lcm_spy.jpg")
