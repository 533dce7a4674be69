"""LCM logs of frames, one behind the other and again and again, as one recording at an even rate: a frame is known by its
utime, which must not repeat."""

from typing import NamedTuple

from houghstream.event_log import read_log, write_event
from studies.wire_patch import with_utime

FIRST_UTIME = 1_500_000_000_000_000


class Camera(NamedTuple):
    """Whose frames a log holds."""

    channel: str
    rate_hz: float


def frames_of(log, channel):
    return [data for _, name, data in read_log(log) if name == channel]


def there_and_back(frames):
    """A camera that goes on without a jump."""
    return frames + frames[-2:0:-1]


def write_joined(file, take, after, count_after, camera):
    """`take` once, then `count_after` frames of `after` there and back. Lists of encoded frames."""
    rest = there_and_back(after)
    with open(file, "wb") as log:
        for number in range(len(take) + count_after):
            data = take[number] if number < len(take) else rest[(number - len(take)) % len(rest)]
            utime = FIRST_UTIME + round(1e6 * number / camera.rate_hz)
            write_event(log, number, (utime, camera.channel, with_utime(data, utime)))
