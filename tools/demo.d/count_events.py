"""Counts the events of one channel in an LCM event log. Usage: count_events.py LOG CHANNEL"""

import struct
import sys

# Big-endian: sync word, event number, time of receipt, lengths of channel and data.
HEADER = struct.Struct(">Iqqii")
SYNC = 0xEDA1DA01


def count_events(log, channel):
    """The log is an open binary file. Raises ValueError where it is damaged or cut."""
    count = 0
    while header := log.read(HEADER.size):
        if len(header) < HEADER.size:
            raise ValueError("cut within a header")
        sync, number, _, channel_size, data_size = HEADER.unpack(header)
        if sync != SYNC or channel_size < 0 or data_size < 0:
            raise ValueError(f"event {number} has no valid header")
        name = log.read(channel_size)
        if len(name) < channel_size or len(log.read(data_size)) < data_size:
            raise ValueError(f"cut within event {number}")
        count += name == channel.encode()
    return count


def main():
    if len(sys.argv) != 3:
        sys.exit("usage: count_events.py LOG CHANNEL")
    try:
        with open(sys.argv[1], "rb") as log:
            print(count_events(log, sys.argv[2]))
    except (OSError, ValueError) as error:
        sys.exit(f"count_events.py: {sys.argv[1]}: {error}")


if __name__ == "__main__":
    main()
