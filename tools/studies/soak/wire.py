"""LCM's udpm protocol, as far as faults need it: "LC02" for small messages and "LC03" for fragments."""

import collections
import itertools
import socket
import struct
import threading
import time

from studies.wire_patch import frame_of, utime_of

GROUP = "239.255.76.67"
SHORT, LONG = 0x4C433032, 0x4C433033
SHORT_HEADER = struct.Struct(">II")  # magic, number of the message
LONG_HEADER = struct.Struct(">IIIIHH")  # and its bytes, where these begin, which fragment of how many
FRAGMENT = 60_000  # bytes


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


def datagrams(number, channel, payload):
    """A message as it travels."""
    name = channel.encode() + b"\0"
    if len(name) + len(payload) <= FRAGMENT:
        return [SHORT_HEADER.pack(SHORT, number) + name + payload]
    first = FRAGMENT - len(name)
    starts = [0, *range(first, len(payload), FRAGMENT)]
    ends = [*starts[1:], len(payload)]
    return [LONG_HEADER.pack(LONG, number, len(payload), start, index, len(starts)) + (b"" if index else name) + payload[start:end]
            for index, (start, end) in enumerate(zip(starts, ends))]  # fmt: skip


class Sender:
    """Sends messages to a port, in anybody's name."""

    def __init__(self, port):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.to = (GROUP, port)
        self.numbers = itertools.count()

    def send(self, channel, payload):
        for part in datagrams(next(self.numbers), channel, payload):
            self.socket.sendto(part, self.to)


def rubbish(port, channel, payloads):
    sender = Sender(port)
    for payload in payloads:
        sender.send(channel, payload)
        time.sleep(0.01)


Heard = collections.namedtuple("Heard", "time sender utime source payload")


class Listener:
    """The messages that were received on some channels, until stop(): of each message when, from whom, the frame's utime and,
    of results, the frame's channel and, where they fit into a datagram, all their bytes."""

    RESULTS = ("HOUGHSTREAM_DETECTIONS", "HOUGHSTREAM_POSES", "HOUGHSTREAM_OBJECTS")

    def __init__(self, port, channels):
        self.socket = receiving_socket(port)
        self.heard = {channel: [] for channel in channels}
        self.stopped = threading.Event()
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def stop(self):
        self.stopped.set()
        self.thread.join()
        self.socket.close()

    def run(self):
        while not self.stopped.is_set():
            try:
                data, address = self.socket.recvfrom(65536)
            except socket.timeout:
                continue
            magic, _ = SHORT_HEADER.unpack_from(data)
            if magic == LONG and LONG_HEADER.unpack_from(data)[4] != 0:
                continue
            header = LONG_HEADER if magic == LONG else SHORT_HEADER
            name, _, payload = data[header.size :].partition(b"\0")
            channel = name.decode(errors="replace")
            if channel not in self.heard or len(payload) < 16:
                continue
            is_result = channel in self.RESULTS
            source = frame_of(payload)[0] if is_result else channel
            kept = payload if is_result and magic == SHORT else None
            self.heard[channel].append(Heard(time.monotonic(), address, utime_of(payload), source, kept))

    def senders(self, channel):
        return {one.sender for one in list(self.heard[channel])}

    def wait_for(self, channel, is_it, seconds):
        """The first message that is it, or None."""
        end = time.monotonic() + seconds
        at = 0
        while True:
            messages = self.heard[channel]
            while at < len(messages):
                if is_it(messages[at]):
                    return messages[at]
                at += 1
            if time.monotonic() > end:
                return None
            time.sleep(0.005)
