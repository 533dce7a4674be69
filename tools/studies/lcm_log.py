"""Reads LCM event logs and Houghstream's results without the lcm module: two formats of a few lines each."""

import struct
from dataclasses import dataclass

HEADER = struct.Struct(">Iqqii")  # sync word, event number, time of receipt, lengths of channel and data; big-endian
SYNC = 0xEDA1DA01


class DamagedLog(ValueError):
    pass


def read_log(path):
    """Yields (timestamp, channel, data) of each event of an LCM log. Raises DamagedLog where it is damaged or cut."""
    with open(path, "rb") as log:
        while header := log.read(HEADER.size):
            if len(header) < HEADER.size:
                raise DamagedLog(f"{path}: cut within a header")
            sync, number, timestamp, channel_size, data_size = HEADER.unpack(header)
            if sync != SYNC or channel_size < 0 or data_size < 0:
                raise DamagedLog(f"{path}: event {number} has no valid header")
            channel, data = log.read(channel_size), log.read(data_size)
            if len(channel) < channel_size or len(data) < data_size:
                raise DamagedLog(f"{path}: cut within event {number}")
            yield timestamp, channel.decode(), data


def count_events(path, channel):
    return sum(name == channel for _, name, _ in read_log(path))


class Wire:
    """An encoded message, read from front to back; big-endian."""

    def __init__(self, data):
        self.data = data
        self.position = 8  # behind the fingerprint

    def read(self, form):
        values = struct.unpack_from(">" + form, self.data, self.position)
        self.position += struct.calcsize(">" + form)
        return values if len(values) > 1 else values[0]

    def text(self):
        size = self.read("i")
        value = self.data[self.position : self.position + size - 1].decode()
        self.position += size
        return value


@dataclass
class Detection:
    class_id: int
    name: str
    score: float
    box: tuple  # x, y, width, height in pixels
    centre: tuple  # metres
    votes: tuple


def utime_of(data):
    return struct.unpack_from(">q", data, 8)[0]


def detections_of(data):
    """The detections of an encoded detections_t; stage times are left out, they differ from run to run."""
    wire = Wire(data)
    wire.read("q")
    wire.text()
    found = []
    for _ in range(wire.read("i")):
        class_id, name = wire.read("i"), wire.text()
        score, *box = wire.read("5f")
        centre = wire.read("3f")
        weight, total, count = wire.read("fii")
        votes = wire.read(f"{5 * count}f") if count else ()
        found.append(Detection(class_id, name, score, tuple(box), centre, (weight, total, votes)))
    return found


def detections_by_utime(events):
    """{utime: detections} of the detections_t among (timestamp, channel, data) events."""
    return {utime_of(data): detections_of(data) for _, channel, data in events if channel == "HOUGHSTREAM_DETECTIONS"}


def poses_of(data):
    """(class name, index of the detection, status, translation in metres) of each pose of an object_poses_t."""
    wire = Wire(data)
    wire.read("q")
    wire.text()
    poses = []
    for _ in range(wire.read("i")):
        wire.read("i")
        name = wire.text()
        _, index, status = wire.read("fib")
        translation = wire.read("3d")
        wire.read("4dbii5f")
        poses.append((name, index, status, translation))
    return poses


def objects_of(data):
    """(track_id, class name, state, probability) of each object of an objects_t; states are numbers of tracked_object_t."""
    wire = Wire(data)
    wire.read("q")
    wire.text(), wire.text()
    wire.read("i7d")
    objects = []
    for _ in range(wire.read("i")):
        track_id, _ = wire.read("qi")
        name = wire.text()
        state, probability, *_ = wire.read("bfb49diqq")
        wire.text(), wire.text()
        objects.append((track_id, name, state, probability))
    return objects


def images_of(data):
    """{image type: bytes} of an encoded images_t."""
    wire = Wire(data)
    wire.read("q")
    count = wire.read("i")
    types = [wire.read("h") for _ in range(count)]
    images = {}
    for image_type in types:
        wire.read("q4i")
        size = wire.read("i")
        images[image_type] = wire.data[wire.position : wire.position + size]
        wire.position += size
        for _ in range(wire.read("i")):
            wire.text()
            value_size = wire.read("i")
            wire.position += value_size
    return images


@dataclass
class Status:
    utime: int
    process: str
    received: int
    processed: int
    skipped: int
    lost: int
    last_error: str


def status_of(data):
    wire = Wire(data)
    utime, process = wire.read("q"), wire.text()
    wire.read("if")
    received, processed, skipped, lost, _ = wire.read("5q")
    wire.read("3f")
    return Status(utime, process, received, processed, skipped, lost, wire.text())


@dataclass
class KnownObjects:
    utime: int
    process: str
    store: str
    since: int
    objects: dict  # since when each is known, by name
    problem: str


def known_objects_of(data):
    wire = Wire(data)
    utime, process = wire.read("q"), wire.text()
    wire.read("i")
    store, since = wire.text(), wire.read("q")
    names = [wire.text() for _ in range(wire.read("i"))]
    times = [wire.read("q") for _ in names]
    return KnownObjects(utime, process, store, since, dict(zip(names, times)), wire.text())


TEACHING_STATES = ("invalid", "choosing", "tracking", "lost", "fusing", "training", "done", "failed")


@dataclass
class Teaching:
    utime: int
    name: str
    state: str
    message: str
    progress: float  # NaN: cannot be told
    frames: int
    keyframes: int
    box: tuple  # x, y, width, height in pixels; NaN where it is not known
    seen: tuple  # of the directions


def teaching_of(data):
    wire = Wire(data)
    utime, _, name = wire.read("q"), wire.text(), wire.text()
    state, message = TEACHING_STATES[wire.read("b")], wire.text()
    progress, frames, keyframes, *box = wire.read("fii4f")
    wire.read("7d")
    count = wire.read("i")
    wire.position += 3 * 4 * count
    seen = tuple(wire.data[wire.position : wire.position + count])
    return Teaching(utime, name, state, message, progress, frames, keyframes, tuple(box), seen)
