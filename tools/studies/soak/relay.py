"""A relay between two LCM buses that does to messages what a network may: it listens where hs-capture sends, and sends on
to where the others listen.

Whole messages are lost, swapped and doubled, not their fragments: LCM gives up a message of which a fragment is missing, so
a lost fragment is a lost message, and what is counted stays exact.
"""

import itertools
import random
import socket
import threading
from typing import NamedTuple

from studies.soak.frames import FORGED, with_number
from studies.soak.wire import GROUP, LONG, LONG_HEADER, SHORT, SHORT_HEADER, datagrams, receiving_socket

SPARED = 3  # messages of a camera at the beginning and the end of a run: what is lost there nobody can know


class Chances(NamedTuple):
    """The fate of a message, as probabilities; most are passed on as they are."""

    lose: float = 0.0
    swap: float = 0.0  # the next one overtakes it
    double: float = 0.0
    forge: float = 0.0  # another follows it, with a forged sequence number


class Relay:
    """Passes on `expected` frames of each camera from port to port, with faults, until stop()."""

    def __init__(self, from_port, to_port, expected, chances, seed=1):
        self.listener = receiving_socket(from_port)
        self.sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.to = (GROUP, to_port)
        self.expected = expected
        self.random = random.Random(seed)
        self.chances = chances
        self.parts = {}  # of messages that are not whole yet, by (sender, number)
        self.held = {}  # by channel, a frame that the next one overtakes
        self.number = 0xF0000000  # of what it sends a second time: LCM takes a number for the same message
        self.counts = {"passed": 0, "lost": 0, "swapped": 0, "doubled": 0, "forged": 0}
        self.seen = {}  # frames by channel
        self.stopped = threading.Event()
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def stop(self):
        self.stopped.set()
        self.thread.join()
        self.listener.close()

    def run(self):
        while not self.stopped.is_set():
            try:
                data, address = self.listener.recvfrom(65536)
            except socket.timeout:
                continue
            message = self.whole(data, address)
            if message:
                self.treat(message)

    def whole(self, data, address):
        """The datagrams of a message once all have come."""
        magic, number = SHORT_HEADER.unpack_from(data)
        if magic == SHORT:
            return [data]
        of_message = self.parts.setdefault((address, number), [])
        of_message.append(data)
        count = LONG_HEADER.unpack_from(data)[5]
        return self.parts.pop((address, number)) if len(of_message) == count else None

    def treat(self, message):
        if SHORT_HEADER.unpack_from(message[0])[0] == SHORT:  # a status
            self.send(message)
            return
        channel, payload = content(message)
        self.seen[channel] = self.seen.get(channel, 0) + 1
        spared = self.seen[channel] <= SPARED or self.seen[channel] > self.expected - SPARED
        bounds = list(itertools.accumulate(self.chances))
        draw = 1.0 if spared else self.random.random()
        if draw < bounds[0]:
            self.counts["lost"] += 1
            return
        if draw < bounds[1] and channel not in self.held:
            self.held[channel] = message
            self.counts["swapped"] += 1
            return
        self.send(message)
        self.counts["passed"] += 1
        if bounds[1] <= draw < bounds[2]:
            self.send(self.renumbered(message))
            self.counts["doubled"] += 1
        if bounds[2] <= draw < bounds[3]:
            self.number += 1
            for part in datagrams(self.number, channel, with_number(payload, self.random.choice(FORGED))):
                self.sender.sendto(part, self.to)
            self.counts["forged"] += 1
        if channel in self.held:
            self.send(self.held.pop(channel))
            self.counts["passed"] += 1

    def renumbered(self, message):
        self.number += 1
        return [part[:4] + SHORT_HEADER.pack(LONG, self.number)[4:] + part[8:] for part in message]

    def send(self, message):
        for part in message:
            self.sender.sendto(part, self.to)


def content(message):
    """Channel and payload of a message of fragments."""
    by_place = sorted(message, key=lambda part: LONG_HEADER.unpack_from(part)[4])
    name, _, first = by_place[0][LONG_HEADER.size :].partition(b"\0")
    return name.decode(errors="replace"), first + b"".join(part[LONG_HEADER.size :] for part in by_place[1:])
