"""The front page's images: hs-view's window, of a stream that follows objects, as README recommends it, and lcm-spy's viewer of
detections, of one that looks at each frame anew."""

import itertools
import shutil
import time

from PIL import Image
from studies.command import die, step
from studies.records import threads
from studies.stream import Processes
from studies.virtual_display import VirtualDisplay, open_viewer

RATE_HZ = 10
LOOKS = 5  # of the detector, a second
AXES = ((255, 60, 60), (60, 220, 60), (60, 120, 255))  # the colours of x, y, z
VIEW_SIZE = (640, 480)  # where hs-view's window shows colour
CELL, ORIGIN_PIXELS = 32, 3  # where axes of all colours meet stands an object
LOOKS, SETTLING = 48, 12  # the first ones see no rates and few tracks
BETWEEN_S, PATIENCE_S = 0.7, 180.0


def drawn(image):
    """(objects whose axes are drawn, pixels in the rarest colour of the axes)"""
    corners = itertools.product(range(0, image.width - CELL, CELL), range(0, image.height - CELL, CELL))
    cells = (image.cut(x, y, CELL, CELL) for x, y in corners)
    origins = sum(all(cell.count(colour) >= ORIGIN_PIXELS for colour in AXES) for cell in cells)
    return origins, min(image.count(colour) for colour in AXES)


def best_image(display, window, size=None):
    """Returns the image of a window, of some from the first that shows a pose and a while later on, with the most objects and
    axes in its upper left part of this size."""
    best, most, looks, end = None, (0, 0), 0, time.monotonic() + PATIENCE_S
    while looks < LOOKS:
        time.sleep(BETWEEN_S)
        image = display.photograph(window)
        found = drawn(image.cut(0, 0, *(size or (image.width, image.height))))
        looks += looks > 0 or found[1] > 0
        if looks > SETTLING and found > most:
            best, most = image, found
        if looks == 0 and time.monotonic() > end:
            die(f"no pose is drawn within {PATIENCE_S:.0f} s, expected some")
    return best or die("no pose is drawn any more, expected some")


def save_jpeg(image, file):
    Image.frombytes("RGB", (image.width, image.height), b"".join(image.rows)).save(file, quality=88)


def take(options, demo):
    """Writes hs_view.jpg and lcm_spy.jpg into the folder that is asked for."""
    for program in ("Xvfb", "xdotool"):
        if not shutil.which(program):
            die(f"{program}: not there; sudo apt-get install xvfb xdotool")
    step("images of a stream")
    programs, models = options.programs, demo.store.path("training") / "models"
    scene = ("--source", f"bop:{demo.store.path('scene')}", "--loop", "--rate", RATE_HZ, "--jpeg-quality", 90)
    options.pictures.mkdir(parents=True, exist_ok=True)
    with VirtualDisplay(options.out) as display, Processes(options.out / "pictures") as running:

        def find(looks=(), follow=()):
            running.start("detect", programs / "hs-detect", "--forest", demo.store.path("forest"), "--threads", threads(), *looks)
            running.start("pose", programs / "hs-pose", "--models", models, *follow)
            for name in ("detect", "pose"):
                running.by_name[name].wait_until_ready()

        find(("--looks-per-second", LOOKS), ("--follow",))
        running.start("track", programs / "hs-track", "--models", models)
        running.by_name["track"].wait_until_ready()
        running.start("capture", programs / "hs-capture", *scene)
        view = running.start("view", programs / "hs-view", "--models", models, "--rate", RATE_HZ)
        save_jpeg(best_image(display, display.window("Houghstream"), VIEW_SIZE), options.pictures / "hs_view.jpg")
        view.kill()
        running.stop("track", "pose", "detect")
        find()
        spy = running.start("spy", programs / "hs-spy")
        display.window("LCM Spy")
        time.sleep(BETWEEN_S)  # spy counts rates once a second
        save_jpeg(best_image(display, open_viewer(display, spy, "HOUGHSTREAM_DETECTIONS")), options.pictures / "lcm_spy.jpg")
    print(f"{options.pictures}/hs_view.jpg, {options.pictures}/lcm_spy.jpg")
