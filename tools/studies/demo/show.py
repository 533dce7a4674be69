"""What houghstream-demo does without the word `measure`: plays the log of the samples through a stream, says what is found, and
shows it on a page for browsers or in one image. Nothing is taught.

The stream has a network of its own, where that is allowed: it disturbs no other stream, and needs no route. The page's address
is the machine's all the same: its socket was made before."""

import argparse
import itertools
import os
import pathlib
import shutil
import signal
import socket
import sys
import tempfile
import threading
import time

from studies.command import Options, die, know_messages, positive, step
from studies.records import read_json
from studies.stream import Process, ProcessFailed, Processes, enter_private_network

SAMPLES = "share/houghstream/samples"  # of an installation, beside bin
SOCKET = "HOUGHSTREAM_DEMO_SOCKET"  # number of the page's socket, for this program when it starts itself again
FILES = ("forest", "models/names.json", "frames.lcmlog", "samples.json")
FINDERS = ("hs-detect", "hs-pose", "hs-track", "hs-view")
READY_TIMEOUT_S, FIND_TIMEOUT_S, IMAGE_TIMEOUT_S = 60, 45, 15  # the last one: longer than the recording
IMAGE_SETTLES_S = 4.0  # objects are found one after the other, and hs-track knows them a moment later
IMAGE_HZ = 5
CHUNK = 1 << 16
JOBS = """
Subcommands:
  measure                     teaches the objects from nothing and measures: what tools/demo does in a clone
"""


def parse(words):
    parser = Options("houghstream-demo", "Shows, within a minute, four objects that are found in ten seconds of a recording and "
                                         "followed there, with nothing to teach.")  # fmt: skip
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.epilog = JOBS
    add = parser.add_argument
    add("--picture", type=pathlib.Path, metavar="FILE", help="write one image of what is found (.png or .jpg) and end; a file "
                                                             "that is there stays, and the image is FILE_2; without a display "
                                                             "the default is houghstream.png")  # fmt: skip
    add("--page", action="store_true", help="serve the page even where there is no display")
    add("--port", type=positive, default=8080, metavar="N", help="of the page, for this machine only (default 8080, or a free one)")
    add("--seconds", type=positive, metavar="N", help="end after so long; default: at Ctrl-C")
    add("--samples", type=pathlib.Path, metavar="DIR", help="forest, models and log; default: those of the package "
                                                            "houghstream-samples, in a clone build/samples")  # fmt: skip
    options = parser.parse_args(words)
    if options.picture and options.page:
        die("--picture and --page: expected one of them")
    if options.picture and options.picture.suffix not in (".png", ".jpg"):
        die(f"--picture {options.picture}: expected a .png or .jpg")
    if not options.page and not options.picture and not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        options.picture = pathlib.Path("houghstream.png")
    if options.picture and not options.picture.resolve().parent.is_dir():
        die(f"--picture {options.picture}: there is no folder {options.picture.resolve().parent}")
    if options.picture:
        options.picture = next_name(options.picture)
    return options


def next_name(file):
    """The file's name where nothing has it, else the first of FILE_2, FILE_3, ... that nothing has: as recordings are called."""
    names = (file.with_name(f"{file.stem}_{number}{file.suffix}") for number in itertools.count(2))
    return next(name for name in itertools.chain([file], names) if not os.path.lexists(name))


def find_samples(options, programs):
    folder = (options.samples or next((one for one in (programs.parent / SAMPLES, programs.parent / "samples") if one.is_dir()),
                                      programs.parent / SAMPLES)).resolve()  # fmt: skip
    missing = next((name for name in FILES if not (folder / name).is_file()), None)
    if missing:
        die(f"{folder / missing}: not there; install the package houghstream-samples, or make it in a clone: tools/demo, then "
            "cmake --build build -t samples")  # fmt: skip
    return folder


def listen(port):
    """A socket on this machine's loopback: at the port, or at a free one where it is taken."""
    opened = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    opened.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    for wanted in (port, 0):
        try:
            opened.bind(("127.0.0.1", wanted))
            break
        except OSError:
            if wanted == 0:
                raise
    opened.listen(32)
    return opened


def enter(options):
    """A network of one's own; the page's socket stays that of the machine. Returns the socket, or None without a page."""
    if options.picture:
        enter_private_network()
        return None
    if SOCKET not in os.environ:
        opened = listen(options.port)
        opened.set_inheritable(True)
        os.environ[SOCKET] = str(opened.detach())
    entered = enter_private_network()
    page = socket.socket(fileno=int(os.environ[SOCKET]))
    page.set_inheritable(False)
    if entered == "private":
        return page
    options.port = page.getsockname()[1]
    page.close()  # hs-view itself listens there
    return None


class Relay(threading.Thread):
    """Hands what comes at the machine's socket to the same port of the stream's network, and back."""

    def __init__(self, page):
        super().__init__(daemon=True)
        self.page, self.port = page, page.getsockname()[1]
        self.start()

    def run(self):
        while True:
            near, _ = self.page.accept()
            try:
                far = socket.create_connection(("127.0.0.1", self.port))
            except OSError:  # the page is not there yet
                near.close()
                continue
            for source, target in ((near, far), (far, near)):
                threading.Thread(target=self.hand_over, args=(source, target), daemon=True).start()

    @staticmethod
    def hand_over(source, target):
        try:
            while part := source.recv(CHUNK):
                target.sendall(part)
        except OSError:
            pass  # one side has ended the connection
        for end in (source, target):
            try:
                end.shutdown(socket.SHUT_RDWR)
            except OSError:
                pass


class Player(threading.Thread):
    """Plays a log over and over."""

    def __init__(self, folder, log):
        super().__init__(daemon=True)
        self.folder, self.log, self.process, self.ending = folder, log, None, threading.Event()
        self.start()

    def run(self):
        while not self.ending.is_set():
            self.process = Process(self.folder, "lcm-logplayer", self.log, name="player")
            # Ctrl-C reaches it too, a moment before it is asked to end.
            if self.process.process.wait() != 0 and not self.ending.wait(1.0):
                print(f"lcm-logplayer: {self.process.log.read_text(errors='replace').strip()}", file=sys.stderr)
                return

    def end(self):
        self.ending.set()
        if self.process:
            self.process.kill()
        self.join(5)


class Show:
    """One stream of the samples, what its processes say in a temporary folder."""

    def __init__(self, options, programs, samples, folder):
        self.options, self.programs, self.samples, self.folder = options, programs, samples, folder
        self.names, self.found = read_json(samples / "samples.json")["objects"], set()

    def view_options(self):
        if self.options.picture:
            return f"--pictures {self.folder / 'images'} --rate {IMAGE_HZ}"
        return f"--http 127.0.0.1:{self.options.port}"

    def start(self, running):
        stream = running.start("stream", self.programs / "hs-stream", "--follow", "--track", "--forest", self.samples / "forest",
                               "--models", self.samples / "models", "--view-options", self.view_options())  # fmt: skip
        end = time.monotonic() + READY_TIMEOUT_S
        while not all(f"{name}: ready" in stream.log.read_text(errors="replace") for name in FINDERS):
            if not stream.runs():
                stream.fail("ended before all was ready")
            if time.monotonic() > end:
                stream.fail(f"is not ready after {READY_TIMEOUT_S} s")
            time.sleep(0.1)
        running.start("logger", "lcm-logger", "-f", "-c", "HOUGHSTREAM_POSES", self.folder / "poses.lcmlog")
        return stream

    def poses(self):
        from studies.demo.posed import poses_by_frame  # whose messages are known only where the programs are

        return poses_by_frame(self.folder / "poses.lcmlog", is_growing=True)

    def tell_found(self):
        """Says which objects are there for the first time."""
        for poses in self.poses().values():  # of followed ones: there a moment after the first detections
            for pose in poses:
                if pose.class_name not in self.found:
                    self.found.add(pose.class_name)
                    x, y, z = pose.trans
                    step(f"found {pose.class_name} at {x:.3f} {y:.3f} {z:.3f} m, quality {pose.quality:.2f}")

    def await_objects(self, stream):
        end = time.monotonic() + FIND_TIMEOUT_S
        while len(self.found) < len(self.names) and time.monotonic() < end:
            if not stream.runs():
                stream.fail("ended while it was looked at")
            self.tell_found()
            time.sleep(0.3)
        if not self.found:
            stream.fail(f"has found nothing within {FIND_TIMEOUT_S} s")
        for name in sorted(set(self.names) - self.found):
            step(f"{name} was not found within {FIND_TIMEOUT_S} s")

    def write_image(self):
        """Of hs-view's images, of a few seconds or until all objects are shown, the one that shows most."""
        from PIL import Image

        from studies.demo.posed import fullest_image, fullest_of

        file, end = self.options.picture.resolve(), time.monotonic() + IMAGE_TIMEOUT_S
        time.sleep(IMAGE_SETTLES_S)
        while fullest_of(self.poses(), self.folder / "images")[1] < len(self.names) and time.monotonic() < end:
            time.sleep(0.3)
        with Image.open(fullest_image(self.poses(), self.folder / "images")) as image:
            image.save(file.with_name(file.name + ".part"), {".png": "PNG", ".jpg": "JPEG"}[file.suffix])
        os.replace(file.with_name(file.name + ".part"), file)
        step(f"{file}: what was found")

    def run(self):
        step(f"samples: {', '.join(self.names)}; {self.samples}")
        with Processes(self.folder / "log") as running:
            step("starting hs-detect, hs-pose --follow, hs-track and hs-view; nothing is taught")
            stream = self.start(running)
            step("ready; the recording is played in a loop")
            player = Player(self.folder / "log", self.samples / "frames.lcmlog")
            try:
                if not self.options.picture:
                    step(f"open http://127.0.0.1:{self.options.port}/ in a browser; Ctrl-C ends")
                self.await_objects(stream)
                if self.options.picture:
                    self.write_image()
                else:
                    running.by_name["logger"].kill()
                    self.linger(stream)
            finally:
                player.end()
                running.stop("stream")

    def linger(self, stream):
        end = time.monotonic() + (self.options.seconds or float("inf"))
        while time.monotonic() < end:
            if not stream.runs():
                stream.fail("ended while it was looked at")
            time.sleep(0.2)


def interrupted(*_):
    raise KeyboardInterrupt


def main():
    options = parse(sys.argv[1:])
    programs = pathlib.Path(know_messages(os.path.realpath(options.bin or "../build/bin")))
    samples = find_samples(options, programs)
    for program in ("lcm-logplayer", "lcm-logger"):
        if not shutil.which(program):
            die(f"{program}: not there; sudo apt-get install liblcm-bin")
    page = enter(options)
    if page:
        options.port = page.getsockname()[1]
        Relay(page)
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, interrupted)
    try:
        with tempfile.TemporaryDirectory(prefix="houghstream_demo_") as folder:
            Show(options, programs, samples, pathlib.Path(folder)).run()
    except ProcessFailed as error:
        die(error)
    except KeyboardInterrupt:
        step("ended")


if __name__ == "__main__":
    main()
