"""Plays the demo's recording at any rate, forwards and backwards again and again so that the camera never jumps, each frame at
the present time and with a number of its own, until SIGINT: a camera that decodes and encodes nothing. Called as
python3 -m studies.soak.player RECORDING PORT RATE."""

import itertools
import signal
import sys
import time

from studies.soak.frames import FRAME, frames_of, taken_at
from studies.soak.wire import Sender


def play(payloads, sender, rate, stopped):
    """Returns how many frames were sent until `stopped` says so. A frame that is due late is sent at once."""
    start = time.monotonic()
    for number, payload in enumerate(itertools.cycle(payloads + payloads[-2:0:-1])):
        time.sleep(max(0.0, start + number / rate - time.monotonic()))
        if stopped():
            return number
        sender.send(FRAME, taken_at(payload, time.time_ns() // 1000, number))


def main():
    recording, port, rate = sys.argv[1], int(sys.argv[2]), float(sys.argv[3])
    payloads = list(frames_of(recording))
    if not payloads:
        sys.exit(f"{recording}: no message on {FRAME}, expected frames")
    signals = []
    signal.signal(signal.SIGINT, lambda number, _: signals.append(number))
    print("ready", flush=True)
    start = time.monotonic()
    sent = play(payloads, Sender(port), rate, lambda: signals)
    seconds = time.monotonic() - start
    mean_kb = sum(map(len, payloads)) / len(payloads) / 1e3
    print(f"{sent} frames of {mean_kb:.1f} kB to {FRAME}, {seconds:.1f} s, {sent / seconds:.1f} Hz", flush=True)


if __name__ == "__main__":
    main()
