"""Reads and writes LCM event logs, with or without the lcm module."""

import struct
from typing import NamedTuple

HEADER = struct.Struct(">Iqqii")  # sync word, event number, time of receipt, lengths of channel and data; big-endian
SYNC = 0xEDA1DA01


class DamagedLog(ValueError):
    """The log is damaged or cut; the message says where."""


class Event(NamedTuple):
    timestamp: int  # microseconds since the epoch, when the message was received
    channel: str
    data: bytes  # of a message: TYPE.decode(data)


def read_log(path):
    """Yields each Event of an LCM log in its order. Raises DamagedLog where it is damaged or cut."""
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
            yield Event(timestamp, channel.decode(), data)


def write_event(log, number, event):
    """Appends (timestamp, channel, data) to an open binary file. Events are numbered from 0 in their order."""
    timestamp, channel, data = event
    name = channel.encode()
    log.write(HEADER.pack(SYNC, number, timestamp, len(name), len(data)) + name + data)
