"""Poses and objects as they come over the bus, or as a log holds them; LCM's Python module is not needed."""

from __future__ import annotations

from collections.abc import Generator

from houghstream._native import Listener
from houghstream.results import FoundPoses, WorldObjects, make_poses, make_world


def listen(
    url: str | None = None, *, cameras: str = ".*", poses: bool = True, objects: bool = True
) -> Generator[FoundPoses | WorldObjects, None, None]:
    """Yields what a running stream publishes: FoundPoses of each frame (hs-pose), WorldObjects after it (hs-track).

    url: as LCM has it, udpm://239.255.76.67:7667?ttl=0, tcpq://HOST:7700, or file://LOG, which is read to its end; None:
        $LCM_DEFAULT_URL, else the first of these.
    cameras: regular expression that the whole channel of a frame matches.
    poses, objects: whether the one and the other are wanted.

    On a network the newest results of each camera wait while the caller works: who is slow misses frames, and never lags.
    Ctrl-C raises KeyboardInterrupt while it waits. Each call listens for itself, in any thread.
    Raises InputError, a ValueError, at once where the URL is none or cannot be reached, later where a log is damaged.
    """
    return _results(Listener(url or "", cameras, poses, objects))


def _results(listener: Listener) -> Generator[FoundPoses | WorldObjects, None, None]:
    while (values := listener.next()) is not None:
        yield make_world(values) if "objects" in values else make_poses(values)
