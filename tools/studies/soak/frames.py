"""Frames of the demo's recording, with other times and numbers than they had."""

import itertools
import struct
import time

from houghstream.event_log import read_log
from studies.wire_patch import utime_of, with_utime
from studies.soak.wire import Sender

FRAME = "OPENNI_FRAME"
SEQUENCE = b"houghstream.sequence"  # a key of the metadata, decimal text
# Numbers that a sender may state; none that a real frame has which may be lost: which of the two came nobody could know.
FORGED = (10**15, 2**63 - 1, -7, 0, 1, 450, 470, 700, 99_000, 10**6)


def with_metadata(payload, key, value):
    """An encoded images_t with another text under a key that it has."""
    entry = struct.pack(">i", len(key) + 1) + key + b"\0"
    at = payload.index(entry) + len(entry)
    size = struct.unpack_from(">i", payload, at)[0]
    text = str(value).encode()
    return payload[:at] + struct.pack(">i", len(text)) + text + payload[at + 4 + size :]


def frames_of(recording):
    """Yields the encoded frames of a recording, in their order."""
    return (payload for _, channel, payload in read_log(recording) if channel == FRAME)


def taken_at(payload, utime, number):
    """The frame as a camera sends it that takes it at this time, as its frame of this number."""
    return with_metadata(with_utime(payload, utime), SEQUENCE, number)


def with_number(payload, number):
    """Another frame, that its sender says has this number."""
    return taken_at(payload, utime_of(payload) + 1, number)


class FrameSender:
    """Sends frames of a recording at a rate, one camera's or several cameras' at once."""

    KEPT = 60  # of the recording, in memory

    def __init__(self, recording, port):
        self.sender = Sender(port)
        self.frames = list(itertools.islice(frames_of(recording), self.KEPT))

    def send(self, times, channels=(FRAME,), rate=30.0):
        """A frame for each of `times`, microseconds since the epoch, on each channel."""
        self.send_numbered(enumerate(times), channels, rate)

    def send_numbered(self, frames, channels=(FRAME,), rate=30.0):
        """A frame for each (number, utime), in the order in which they stand there."""
        start = time.monotonic()
        for place, (number, utime) in enumerate(frames):
            time.sleep(max(0.0, start + place / rate - time.monotonic()))
            self.send_one(number, utime, channels)

    def send_one(self, number, utime, channels=(FRAME,)):
        payload = taken_at(self.frames[number % len(self.frames)], utime, number)
        for channel in channels:
            self.sender.send(channel, payload)
