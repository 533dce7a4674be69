"""Reads and changes of an encoded message without decoding the whole. All of Houghstream's begin with a
utime; in results, the channel of the source frame follows. What else they hold: TYPE.decode(data) of the package houghstream."""

import struct

TIME = struct.Struct(">q")
FINGERPRINT = 8  # bytes before it


def utime_of(data):
    return TIME.unpack_from(data, FINGERPRINT)[0]


def with_utime(data, utime):
    """The message at another time; those of images in it stay."""
    return data[:FINGERPRINT] + TIME.pack(utime) + data[FINGERPRINT + TIME.size :]


def frame_of(result):
    """(channel, utime) of the frame that a result is of."""
    start = FINGERPRINT + TIME.size + 4
    size = struct.unpack_from(">i", result, start - 4)[0]
    return result[start : start + size - 1].decode(), utime_of(result)
