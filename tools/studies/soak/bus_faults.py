"""Faults of the bus itself: a link that goes away, and rubbish while an object is shown."""

import random
import re
import subprocess
import threading
import time

from studies.network import MULTICAST, URL, Network, ip
from studies.soak.faults import HEARD, RESULTS, SENT, Faults, said
from studies.soak.wire import Listener, Sender, bus
from studies.stream import Process

GONE, BACK = "waiting until the bus can be reached", "the bus can be reached again"
HOST = "b"
PROCESSES = 5  # of hs-stream with --track and without a view, and hs-stream itself: each says it
AWAY_S = 4.0
BACK_LIMIT_S = 2.0
SETTLED_S = 1.0  # each process looks four times a second; the next loss is to be another one for all
DROPPED = re.compile(r"(\d+) messages were no frames of the take and were dropped")


class BusFaults(Faults):
    """Each function is one fault; it returns what it saw, with "good"."""

    def link_lost(self):
        """A stream on a host at a switch, ttl=1: its link goes down, loses its route, is taken out, has its cable pulled. What it
        sends is heard at the switch."""
        folder = self.folder("link_lost")
        with Network(HOST) as network:
            stream = Process(folder, *network.enter(HOST), self.programs / "hs-stream", "--source", f"bop:{self.data / 'scene'}",
                             "--capture-options=--loop", "--forest", self.data / "forest", "--models", self.models, "--track",
                             "--no-view", "--every", "0.5", "-l", URL)  # fmt: skip
            listener = Listener(SENT, RESULTS.values())
            try:
                self.wait_for(stream, r"pose [1-9][\d.]* Hz", 90)
                back = {name: self.without_link(stream, listener, away, again) for name, away, again in self.losses(network)}
                stream.stop(10.0)
            finally:
                stream.kill()
                listener.stop()
        lines = stream.log.read_text(errors="replace")
        outages = 3  # with the cable pulled, a host hears itself, and knows of nothing
        counts = {words: len(re.findall(words, lines)) for words in (GONE, BACK)}
        good = (all(time_s <= BACK_LIMIT_S for each in back.values() for time_s in each.values())
                and counts == {GONE: outages * PROCESSES, BACK: outages * PROCESSES} and "starts again" not in lines)  # fmt: skip
        return {"back_after_s": back, "limit_s": BACK_LIMIT_S, "said": counts, "reported": said(stream, f"{GONE}|ends:")[:12],
                "good": good}  # fmt: skip

    @staticmethod
    def losses(network):
        """(name, how it goes, how it comes back)"""
        host, device = network.enter(HOST), f"cable_{HOST}"

        def add_route():
            ip("route", "replace", MULTICAST, "dev", device, host=host)

        def up():
            ip("link", "set", device, "up", host=host)
            add_route()

        yield "link down", lambda: ip("link", "set", device, "down", host=host), up
        yield "no route", lambda: ip("route", "del", MULTICAST, "dev", device, host=host), add_route
        yield "taken out", lambda: network.take_out(HOST), lambda: network.put_in(HOST)
        yield "cable pulled", lambda: network.cut(HOST), lambda: network.join(HOST)

    @staticmethod
    def without_link(stream, listener, away, again):
        """Seconds from the link's return to the first message on each channel."""
        away()
        time.sleep(AWAY_S)
        again()
        start = time.monotonic()
        took = {}
        for name, channel in RESULTS.items():
            first = listener.wait_for(channel, lambda one: one.time > start, 30)
            if first is None:
                stream.fail(f"has brought nothing on {channel} within 30 s of the link's return")
            took[name] = round(first.time - start, 2)
        time.sleep(SETTLED_S)
        return took

    def rubbish_in_take(self):
        """Rubbish of three kinds on the frames' channel while an object is shown: the take goes on, each is counted."""
        folder = self.folder("rubbish_in_take")
        subprocess.run([str(word) for word in (self.programs / "hs-render", "takes", "--development", "--world", 4, "--objects",
                                               "coffee_mug", "--take", 1, "--frames", 240, "--fps", 15, "--out", folder / "takes")],
                       check=True, capture_output=True)  # fmt: skip
        scene = sorted((folder / "takes" / "test").glob("*/scene_camera.json"))[0].parent
        take = Process(folder, self.programs / "hs-teach", "show", "--from-stream", "--name", "shown", "--no-teach", "--seconds", 60,
                       "-l", bus(HEARD))  # fmt: skip
        capture = None
        stopped, sent = threading.Event(), [0]
        thread = threading.Thread(target=self.send_rubbish, args=(stopped, sent))
        try:
            take.wait_until_ready(30)
            thread.start()
            capture = Process(folder, self.programs / "hs-capture", "--source", f"bop:{scene}", "--rate", 15, "-l", bus(HEARD))
            capture.wait(120)
            stopped.set()
            take.wait(300)
        finally:
            stopped.set()
            thread.join()
            for process in (take, *([capture] if capture else [])):
                process.kill()
        words = take.log.read_text(errors="replace")
        found = DROPPED.search(words)
        dropped = int(found[1]) if found else 0
        lines = len(re.findall("message on OPENNI_FRAME dropped", words))
        return {"sent": sent[0], "dropped": dropped, "lines": lines, "reported": said(take, "dropped")[:6],
                "good": 0 < dropped <= sent[0] and 0 < lines < dropped / 5}  # fmt: skip

    @staticmethod
    def send_rubbish(stopped, sent):
        """Until asked to stop: noise, the beginning of a frame's message, and a status, fifty a second."""
        draw, sender = random.Random(8), Sender(HEARD)
        fingerprint = bytes.fromhex("20ba4f05e8f5e33a")  # of images_t
        while not stopped.wait(0.02):
            payload = (draw.randbytes(200), fingerprint + bytes(8) + draw.randbytes(100), b"")[sent[0] % 3]
            sender.send("OPENNI_FRAME", payload)
            sent[0] += 1

    def all(self):
        yield "the link goes away (ttl=1)", self.link_lost
        yield "rubbish while an object is shown", self.rubbish_in_take
