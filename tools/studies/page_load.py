"""The load of one viewer of hs-view's page on the stream: paired replays, without and with him, and what hs-view takes
meanwhile.

    cd tools && PYTHONPATH=../build/python python3 -m studies.page_load --scene SCENE --forest FOREST --models MODELS --out OUT

SCENE is a folder in BOP format. The viewer asks for what a browser's page asks for; his browser's own work is not counted, as it
is another machine's."""

import argparse
import http.client
import json
import pathlib
import socket
import statistics
import threading

from studies.command import step
from studies.follow_speed import make_log
from studies.records import about, read_json, write_json
from studies.stream import Process, Stream, UsageWatch, enter_private_network

CAMERA_HZ, PAGE_HZ = 30, 10
SECONDS, ROUNDS = 60, 4
IMAGES = ("colour", "depth")  # that the page shows when it is opened


class Viewer(threading.Thread):
    """Listens for frames and asks for the images of each, until he is told to leave. In `frames` how many came."""

    def __init__(self, port):
        super().__init__(daemon=True)
        self.port, self.frames, self.bytes, self.gone = port, 0, 0, threading.Event()
        self.start()

    def run(self):
        events, images = (http.client.HTTPConnection("127.0.0.1", self.port, timeout=10) for _ in range(2))
        events.request("GET", "/events")
        answer = events.getresponse()
        while not self.gone.is_set():
            line = answer.readline()
            if not line:
                break
            if line.strip() == b"event: frame":
                self.frames += 1
                for name in IMAGES:
                    images.request("GET", f"/picture/{name}.jpg")
                    self.bytes += len(images.getresponse().read())
        events.close()
        images.close()

    def leave(self):
        self.gone.set()
        self.join(20)


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def cpu_seconds(usage):
    return usage.samples[-1][1] - usage.samples[0][1]


def figures(observed, frames, page_cpu_s, seconds):
    """Returns of one replay: milliseconds from a frame's publication to its poses, frames without, and hs-view's cores."""
    total, pose = observed["latency_ms"]["total"], observed["processes"]["hs-pose"]
    return {
        "p50_ms": total["p50"],
        "p99_ms": total["p99"],
        "lost": frames - pose["received"],
        "skipped": pose["skipped"],
        "page_cores": round(page_cpu_s / seconds, 4),
    }


def replay(options, log, folder, is_viewed):
    frames = CAMERA_HZ * options.seconds
    folder.mkdir(parents=True, exist_ok=True)
    port = free_port()
    page = Process(folder, options.programs / "hs-view", "--http", port, "--rate", PAGE_HZ, "--models", options.models, name="page")
    try:
        page.wait_until_ready(60)
        viewer = Viewer(port) if is_viewed else None
        watch = UsageWatch({"page": page})
        Stream(options.programs, options.forest, options.models, frames, folder / "stream").play("lcm-logplayer", log)
        watch.summary()
        if viewer:
            viewer.leave()
        page.stop(10)
    finally:
        page.kill()
    run = figures(read_json(folder / "stream" / "observe.json"), frames, cpu_seconds(watch.usages["page"]), options.seconds)
    return {**run, "shown": viewer.frames, "shown_mb": round(viewer.bytes / 1e6, 1)} if viewer else run


def compare(pairs):
    """Medians of both sides, and of each pair's difference, with the least and the greatest."""
    sides = {name: {key: statistics.median(pair[name][key] for pair in pairs) for key in pairs[0][name]} for name in pairs[0]}
    differences = {}
    for key in ("p50_ms", "p99_ms"):
        each = [round(pair["viewed"][key] - pair["alone"][key], 3) for pair in pairs]
        differences[key] = {"median": round(statistics.median(each), 3), "least": min(each), "greatest": max(each)}
    return {**sides, "difference": differences, "runs": pairs}


def measure(options):
    """Interleaved: each round has both, the other one first each time, so that what else the machine does falls on both."""
    log = make_log(options.programs, options.scene, CAMERA_HZ, options.seconds, options.out / "viewed.lcmlog")
    pairs = []
    for number in range(options.rounds):
        pair = {}
        for name in ("alone", "viewed") if number % 2 == 0 else ("viewed", "alone"):
            step(f"{name}: {options.seconds} s at {CAMERA_HZ} Hz, round {number + 1} of {options.rounds}")
            pair[name] = replay(options, log, options.out / f"{name}_{number}", name == "viewed")
        pairs.append(pair)
    return compare(pairs)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    for name in ("scene", "forest", "models", "out"):
        parser.add_argument(f"--{name}", required=True, type=lambda text: pathlib.Path(text).resolve())
    parser.add_argument("--programs", default="../build/bin", type=lambda text: pathlib.Path(text).resolve())
    parser.add_argument("--seconds", type=int, default=SECONDS)
    parser.add_argument("--rounds", type=int, default=ROUNDS)
    options = parser.parse_args()
    enter_private_network()
    options.out.mkdir(parents=True, exist_ok=True)
    measured = measure(options)
    write_json(options.out / "viewed.json", {**measured, **about("studies.page_load")})
    print(json.dumps({name: value for name, value in measured.items() if name != "runs"}, indent=2))


if __name__ == "__main__":
    main()
