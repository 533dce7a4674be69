"""A relay between two LCM buses that does to messages what a network may: it listens where hs-capture sends, and sends on
to where the others listen.

Whole messages are lost, swapped and doubled, not their fragments: LCM gives up a message of which a fragment is missing, so
a lost fragment is a lost message, and what is counted stays exact. Wire format: LCM's udpm protocol, "LC02" for small
messages and "LC03" for fragments.
"""

import random
import socket
import struct
import threading
import time

GROUP = "239.255.76.67"
SHORT, LONG = 0x4C433032, 0x4C433033
SPARED = 3  # messages at the beginning and the end of a run: what is lost there nobody can know


def bus(port):
    return f"udpm://{GROUP}:{port}?ttl=0"


def receiving_socket(port):
    listener = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 24)
    listener.bind(("", port))
    listener.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP,
                        struct.pack("4sL", socket.inet_aton(GROUP), socket.INADDR_ANY))  # fmt: skip
    listener.settimeout(0.1)
    return listener


class Relay:
    """Passes on `expected` frames of one channel from port to port, with faults, until stop()."""

    def __init__(self, from_port, to_port, expected, seed=1, lose=0.0, swap=0.0, double=0.0):
        self.listener = receiving_socket(from_port)
        self.sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.to = (GROUP, to_port)
        self.expected = expected
        self.random = random.Random(seed)
        self.lose, self.swap, self.double = lose, swap, double
        self.parts = {}  # of messages that are not whole yet, by (sender, number)
        self.held = None  # a frame that the next one overtakes
        self.number = 0xF0000000  # of what it sends a second time: LCM takes a number for the same message
        self.counts = {"passed": 0, "lost": 0, "swapped": 0, "doubled": 0}
        self.seen = 0
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
        magic, number = struct.unpack_from(">II", data)
        if magic == SHORT:
            return [data]
        of_message = self.parts.setdefault((address, number), [])
        of_message.append(data)
        count = struct.unpack_from(">H", data, 18)[0]
        return self.parts.pop((address, number)) if len(of_message) == count else None

    def treat(self, message):
        if struct.unpack_from(">I", message[0])[0] == SHORT:  # a status
            self.send(message)
            return
        self.seen += 1
        spared = self.seen <= SPARED or self.seen > self.expected - SPARED
        draw = self.random.random()
        if not spared and draw < self.lose:
            self.counts["lost"] += 1
            return
        if not spared and self.held is None and draw < self.lose + self.swap:
            self.held = message
            self.counts["swapped"] += 1
            return
        self.send(message)
        self.counts["passed"] += 1
        if not spared and self.lose + self.swap <= draw < self.lose + self.swap + self.double:
            self.send(self.renumbered(message))
            self.counts["doubled"] += 1
        if self.held is not None:
            self.send(self.held)
            self.counts["passed"] += 1
            self.held = None

    def renumbered(self, message):
        self.number += 1
        return [part[:4] + struct.pack(">I", self.number) + part[8:] for part in message]

    def send(self, message):
        for part in message:
            self.sender.sendto(part, self.to)


def rubbish(port, channel, payloads):
    """Small messages on a channel, as anybody on the bus may send them."""
    sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    for number, payload in enumerate(payloads):
        sender.sendto(struct.pack(">II", SHORT, 0xE0000000 + number) + channel.encode() + b"\0" + payload, (GROUP, port))
        time.sleep(0.01)
