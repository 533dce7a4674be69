"""Faults of the page of hs-view, and to what draws frames: clients that mean no good, frames of odd shapes."""

import contextlib
import http.client
import pathlib
import re
import signal
import socket
import struct
import threading
import time

from houghstream import camera_t, image_metadata_t, image_t, images_t

from studies.soak.faults import HEARD, Faults, account, said
from studies.soak.wire import Sender

PORT = 8090
CROWD = 40  # clients at a time, more than hs-view has threads for them
REACHABLE_S = 3.0  # the page, for everybody else; it has the lowest priority
ENDED_S = 1.0  # after Ctrl-C
MOST_MB = 1000
USUAL = (64, 48)
ODD = ((16384, 1), (1, 16384), (16384, 506), (506, 16384), (1, 1))
IMAGES = tuple(f"/picture/{name}.jpg" for name in ("colour", "depth", "3d", "world"))


def frame_message(utime, width, height):
    """A raw frame of that shape, with its camera."""
    camera = camera_t()
    camera.width, camera.height, camera.fx, camera.fy, camera.cx, camera.cy = width, height, 500.0, 500.0, width / 2, height / 2
    about = image_metadata_t()
    about.key, about.value = "houghstream.camera", camera.encode()
    about.n = len(about.value)
    message = images_t()
    message.utime, message.n_images, message.image_types = utime, 2, [images_t.LEFT, images_t.DEPTH_MM]
    for pixelformat, pixel in ((image_t.PIXEL_FORMAT_BGR, b"\x40\x80\xc0"), (image_t.PIXEL_FORMAT_LE_GRAY16, struct.pack("<H", 900))):
        image = image_t()
        image.utime, image.width, image.height, image.pixelformat = utime, width, height, pixelformat
        image.row_stride, image.data = width * len(pixel), pixel * (width * height)
        image.size, image.nmetadata, image.metadata = len(image.data), 1, [about]
        message.images.append(image)
    return message.encode()


class ShapedFrames:
    """Sends frames at 10 Hz while it lasts, each third of an odd shape where that is asked for. Use with `with`."""

    def __init__(self, odd):
        self.sender, self.odd, self.sent = Sender(HEARD), odd, 0
        self.ending = threading.Event()
        self.thread = threading.Thread(target=self.run, daemon=True)

    def run(self):
        while not self.ending.wait(0.1):
            shape = ODD[self.sent // 3 % len(ODD)] if self.odd and self.sent % 3 == 0 else USUAL
            self.sender.send("OPENNI_FRAME", frame_message(int(time.time() * 1e6), *shape))
            self.sent += 1

    def __enter__(self):
        self.thread.start()
        return self

    def __exit__(self, *_):
        self.ending.set()
        self.thread.join()


def fetch(path, host=f"127.0.0.1:{PORT}", **headers):
    """(status, bytes, seconds) of a request; no status where nothing comes."""
    start = time.monotonic()
    connection = http.client.HTTPConnection("127.0.0.1", PORT, timeout=10 * REACHABLE_S)
    try:
        connection.request("GET", path, headers={"Host": host, **headers})
        answer = connection.getresponse()
        size = len(answer.read())
        status = answer.status
    except (OSError, http.client.HTTPException):
        status, size = None, 0
    finally:
        connection.close()
    return status, size, round(time.monotonic() - start, 2)


class Crowd:
    """Clients that say something, then a byte now and then, and read nothing. Use with `with`."""

    def __init__(self, words, drip=b"x"):
        self.words, self.drip = words, drip

    def __enter__(self):
        self.clients = []
        for _ in range(CROWD):
            client = socket.create_connection(("127.0.0.1", PORT), timeout=5)
            client.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            client.sendall(self.words)
            client.setblocking(False)
            self.clients.append(client)
        return self

    def drip_for(self, seconds):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            for client in self.clients:
                with contextlib.suppress(OSError):  # it has been ended
                    client.send(self.drip)
            time.sleep(0.1)

    def __exit__(self, *_):
        for client in self.clients:
            client.close()


def request(path, *lines, method="GET"):
    return "\r\n".join((f"{method} {path} HTTP/1.1", "Host: localhost", *lines, "", "")).encode()


CROWDS = {
    "that say nothing": (b"", b""),
    "that send a header a byte at a time": (b"GET / HTTP/1.1\r\nHost: local", b"h"),
    "that send headers without an end": (b"GET / HTTP/1.1\r\nHost: localhost\r\n", b"X: " + b"x" * 4000 + b"\r\n"),
    "that send content a byte at a time": (request("/orders", "X-Houghstream-Token: x", "Content-Length: 4000", method="POST"), b" "),
    "that read no picture": (request(IMAGES[0]), b""),
    "that read no events": (request("/events"), b""),
    "that ask for ranges": (request(IMAGES[0], "Range: bytes=0-" + ",0-" * 2600), b""),
}  # fmt: skip


def peak_mb(process):
    status = pathlib.Path(f"/proc/{process.process.pid}/status").read_text()
    return int(re.search(r"VmHWM:\s+(\d+)", status).group(1)) // 1024


class PageFaults(Faults):
    """Each function is one fault; it returns what it saw, with "good". None needs the demo's data."""

    def view(self, folder, name, *words):
        return self.worker(folder, "hs-view", *words, name=name)

    @staticmethod
    def end(process, limit_s):
        """Seconds from Ctrl-C until it has ended; more than the limit is waited for, to say how many."""
        start = time.monotonic()
        process.process.send_signal(signal.SIGINT)
        process.wait(10 * limit_s)
        return round(time.monotonic() - start, 2)

    def crowded(self):
        """Clients of each bad habit, and the page for everybody else meanwhile; then Ctrl-C in a crowd."""
        view = self.view(self.folder("page_crowds"), "view", "--http", PORT)
        reached, drawn = {}, {}
        try:
            with ShapedFrames(odd=False):
                for habit, (words, drip) in CROWDS.items():
                    with Crowd(words, drip) as crowd:
                        crowd.drip_for(1.0)
                        reached[habit], drawn[habit] = fetch("/"), fetch(IMAGES[1])
                        crowd.drip_for(1.0)
                peak = peak_mb(view)
                with Crowd(*CROWDS["that read no picture"]), Crowd(*CROWDS["that send a header a byte at a time"]) as crowd:
                    crowd.drip_for(0.5)
                    ended_s = self.end(view, ENDED_S)
        finally:
            view.kill()
        answered = [*reached.values(), *drawn.values()]
        return {"reached_after_s": {habit: seconds for habit, (_, _, seconds) in reached.items()}, "peak_mb": peak,
                "ended_after_s": ended_s, "reported": said(view, "WARN|ERROR|refused"),
                "good": all(status == 200 and seconds <= REACHABLE_S for status, _, seconds in answered) and peak <= MOST_MB
                and ended_s <= ENDED_S}  # fmt: skip

    def foreign_names(self):
        """A website that has its name resolved to this machine sees nothing, on a page for this machine and on an open one."""
        folder, seen = self.folder("page_names"), {}
        evil = ("evil.example", f"evil.example:{PORT}", "[::1].evil.example", "127.0.0.1.evil.example", "robot.example.evil.example")
        for where in (str(PORT), f"0.0.0.0:{PORT}"):
            view = self.view(folder, where.replace(":", "_"), "--http", where, "--http-host", "robot.example")
            try:
                with ShapedFrames(odd=False):
                    seen[where] = {host: fetch(path, host)[0] for host in evil for path in ("/", IMAGES[0], "/events")}
                    seen[where]["robot.example"] = fetch("/", "robot.example")[0]
                self.end(view, ENDED_S)
            finally:
                view.kill()
        return {"status": seen, "good": all((status == 200) == (host == "robot.example") and status in (200, 403)
                                            for each in seen.values() for host, status in each.items())}  # fmt: skip

    def shaped(self, name, *words):
        """hs-view among frames of odd shapes: its peak of memory, and whether it runs on."""
        view = self.view(self.folder(f"shapes_{name}"), "view", *words)
        views = IMAGES if "--http" in words else ()
        images = {path: 0 for path in views}
        try:
            with ShapedFrames(odd=True) as frames:
                end = time.monotonic() + 30
                while time.monotonic() < end and frames.sent < 4 * 3 * len(ODD):
                    for path in views:
                        images[path] += fetch(path)[0] == 200
                    time.sleep(0.05)
                runs, peak = view.runs(), peak_mb(view) if view.runs() else 0
            ended_s = self.end(view, 30) if runs else None
        finally:
            view.kill()
        refused = account(view)["refused"] if runs else None
        return {"peak_mb": peak, "ended_after_s": ended_s, "refused": refused, **({"pictures": images} if views else {}),
                "reported": said(view, "ends:|WARN|ERROR"), "good": runs and refused == 0 and peak <= MOST_MB
                and all(images.values())}  # fmt: skip

    def shapes(self):
        folder = self.folder("shapes")
        outputs = {"page": ("--http", PORT), "page_of_the_world": ("--http", PORT, "--world"),
                   "preview": ("--preview",), "snapshot": ("--snapshot", folder / "shot.png", "--after", 10_000),
                   "video": ("--video", folder / "seen.mp4"), "pictures": ("--pictures", folder / "pictures"),
                   "pictures_3d": ("--pictures", folder / "3d", "--3d"), "pictures_world": ("--pictures", folder / "world", "--world")}  # fmt: skip
        seen = {name: self.shaped(name, *words) for name, words in outputs.items()}
        written = [folder / "shot.png", folder / "seen.mp4", *(folder / name for name in ("pictures", "3d", "world"))]
        missing = [path.name for path in written if not path.exists()]
        return {"peak_mb": {name: one["peak_mb"] for name, one in seen.items()}, "missing": missing,
                "reported": sum((one["reported"] for one in seen.values()), []),
                "bad": [name for name, one in seen.items() if not one["good"]],
                "good": not missing and all(one["good"] for one in seen.values())}  # fmt: skip

    def all(self):
        yield "a crowd at the page", self.crowded
        yield "the page under a foreign name", self.foreign_names
        yield "frames of a single row or column in every view", self.shapes
