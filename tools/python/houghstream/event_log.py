"""Reads and writes LCM event logs, with or without the lcm module."""

import struct
import zlib
from typing import NamedTuple

HEADER = struct.Struct(">Iqqii")  # sync word, event number, time of receipt, lengths of channel and data; big-endian
SYNC = 0xEDA1DA01
SEAL = "HOUGHSTREAM_SEAL"  # channel of an event before each block of a sealed log, with the checksums of what follows
SEAL_HEADER = struct.Struct(">8sI")  # magic, number of checksums (32 bits each, big-endian)
SEAL_MAGIC = b"HSSEAL1\0"
SEALED_BLOCK = 256  # events, at most
MOST_CHANNEL, MOST_DATA = 999, 1 << 28  # bytes that LCM writes


class DamagedLog(ValueError):
    """The log is damaged or cut; the message says where."""


class Event(NamedTuple):
    timestamp: int  # microseconds since the epoch, when the message was received
    channel: str
    data: bytes  # of a message: TYPE.decode(data)


def read_log(path):
    """Yields each Event of an LCM log in its order; seals are checked and left out. Raises DamagedLog where it is damaged or
    cut, and where an event of a sealed log (`hs-log seal`) has changed or is missing."""
    sealed = []  # checksums of events to come, the next one's last
    with open(path, "rb") as log:
        for number, event in _events(path, log):
            if event.channel != SEAL:
                if sealed and sealed.pop() != checksum(event):
                    raise DamagedLog(f"{path}: event {number} on {event.channel} is damaged: its seal has another checksum")
                yield event
                continue
            if sealed:
                raise DamagedLog(f"{path}: {len(sealed)} sealed events are missing before event {number}")
            sealed = _checksums(path, event.data)[::-1]
    if sealed:
        raise DamagedLog(f"{path}: {len(sealed)} sealed events are missing at its end")


def checksum(event):
    """Returns a seal's checksum of an event: CRC-32 of its timestamp, channel and data."""
    return zlib.crc32(event.data, zlib.crc32(struct.pack(">q", event.timestamp) + event.channel.encode()))


def _events(path, log):
    while header := log.read(HEADER.size):
        if len(header) < HEADER.size:
            raise DamagedLog(f"{path}: cut within a header")
        sync, number, timestamp, channel_size, data_size = HEADER.unpack(header)
        if sync != SYNC or not 0 <= channel_size <= MOST_CHANNEL or not 0 <= data_size <= MOST_DATA:
            raise DamagedLog(f"{path}: event {number} has no valid header")
        channel, data = log.read(channel_size), log.read(data_size)
        if len(channel) < channel_size or len(data) < data_size:
            raise DamagedLog(f"{path}: cut within event {number}")
        try:
            name = channel.decode()
        except UnicodeDecodeError as error:
            raise DamagedLog(f"{path}: event {number} has a channel of {channel!r}, expected UTF-8") from error
        yield number, Event(timestamp, name, data)


def _checksums(path, seal):
    magic, count = SEAL_HEADER.unpack_from(seal) if len(seal) >= SEAL_HEADER.size else (b"", 0)
    if magic != SEAL_MAGIC or count > SEALED_BLOCK or len(seal) != SEAL_HEADER.size + 4 * count:
        raise DamagedLog(f"{path}: a damaged seal")
    return list(struct.unpack_from(f">{count}I", seal, SEAL_HEADER.size))


def write_event(log, number, event):
    """Appends (timestamp, channel, data) to an open binary file. Events are numbered from 0 in their order."""
    timestamp, channel, data = event
    name = channel.encode()
    log.write(HEADER.pack(SYNC, number, timestamp, len(name), len(data)) + name + data)
