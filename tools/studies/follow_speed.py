"""The speed of hs-pose --follow: frame to pose, and to the world's objects of hs-track, at several rates, what is lost, and
what it costs. tools/bench tracks asks measure(); by itself:

    cd tools && PYTHONPATH=../build/python python3 -m studies.follow_speed --scene SCENE --forest FOREST --models MODELS --out OUT

SCENE is a folder in BOP format whose frames follow one another closely (hs-render scene NAME --frames 300)."""

import argparse
import json
import pathlib
import statistics
from typing import NamedTuple

from houghstream.event_log import read_log, write_event
from studies.command import call, step
from studies.wire_patch import with_utime
from studies.records import about, read_json, write_json
from studies.stream import Stream, enter_private_network
from studies.unit_runner import sha256_of

RATES = (30, 60, 90)  # Hz
LOOKS = 5  # of the detector, a second
SECONDS, ROUNDS = 20, 3  # a minute at each rate in all
FIRST_UTIME = 1_500_000_000_000_000


class Replays(NamedTuple):
    """How often, and for how long, the scene is played."""

    rates: tuple  # Hz
    seconds: int  # of each
    rounds: int


def figures(folder, frames):
    """Returns of one replay: milliseconds from a frame's publication to its first poses, and to the objects of the world after
    it, frames that never reached hs-pose, those that it passed over, those after which no objects came, and processor cores
    that detector, poses and tracks took together."""
    observed, usage = read_json(folder / "observe.json"), read_json(folder / "usage.json")
    pose = observed["processes"]["hs-pose"]
    return {
        "p50_ms": observed["latency_ms"]["total"]["p50"],
        "p99_ms": observed["latency_ms"]["total"]["p99"],
        "objects_p50_ms": observed["objects_latency_ms"]["p50"],
        "objects_p99_ms": observed["objects_latency_ms"]["p99"],
        "lost": frames - pose["received"],
        "skipped": round(pose["skipped"] / frames, 5),
        "without_objects": round(1.0 - observed["frames_with_objects"] / frames, 5),
        "cores": usage["cpu_cores"],
        "cores_detect": usage["cores"]["detect"],
        "cores_pose": usage["cores"]["pose"],
        "cores_track": usage["cores"]["track"],
    }


def medians(runs):
    return {key: statistics.median(run[key] for run in runs) for key in runs[0]}


def restamp(source, target, rate):
    """Copies a log of images_t whose utimes become those of a camera of that rate; a dataset's are of 30 Hz."""
    with open(target, "wb") as out:
        for number, (timestamp, channel, data) in enumerate(read_log(source)):
            utime = FIRST_UTIME + round(number * 1e6 / rate)
            write_event(out, number, (timestamp, channel, with_utime(data, utime)))


def make_log(programs, scene, rate, seconds, log):
    """The scene's frames over and over, with the times of a camera of that rate; made once of each scene and length."""
    stamp, made_of = log.with_suffix(".of"), f"{rate} Hz, {seconds} s, {sha256_of(pathlib.Path(scene))}\n"
    if not (log.exists() and stamp.is_file() and stamp.read_text() == made_of):
        captured, part = log.with_suffix(".captured"), log.with_suffix(".part")
        call(programs / "hs-capture", "--source", f"bop:{scene}", "--rate", rate, "--loop", "--frames", rate * seconds, "--log",
             captured, "--replace", into=log.with_suffix(".txt"))  # fmt: skip
        restamp(captured, part, rate)
        captured.unlink()
        part.rename(log)
        stamp.write_text(made_of)
    return log


def measure(programs, data, out, replays):
    """`data`: {"scene", "forest", "models"}. Interleaved: each round plays each rate once, so that what else the machine does
    falls on all. Returns {"hz30": medians over the rounds, ...}, each with "looks_per_second" and "runs"."""
    programs, out = pathlib.Path(programs), pathlib.Path(out)
    rates, seconds, rounds = replays
    out.mkdir(parents=True, exist_ok=True)
    logs = {rate: make_log(programs, data["scene"], rate, seconds, out / f"following_{rate}.lcmlog") for rate in rates}
    runs = {rate: [] for rate in rates}
    for number in range(rounds):
        for rate in rates:
            step(f"following: {seconds} s at {rate} Hz, round {number + 1} of {rounds}")
            folder = out / f"following_{rate}_{number}"
            stream = Stream(programs, data["forest"], data["models"], rate * seconds, folder, watch=True, detect_threads=1,
                            detect=("--looks-per-second", LOOKS), pose=("--follow",), track=True)  # fmt: skip
            stream.play("lcm-logplayer", logs[rate])
            runs[rate].append(figures(folder, rate * seconds))
    return {f"hz{rate}": {**medians(runs[rate]), "looks_per_second": LOOKS, "runs": runs[rate]} for rate in rates}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    for name in ("scene", "forest", "models", "out"):
        parser.add_argument(f"--{name}", required=True, type=lambda text: pathlib.Path(text).resolve())
    parser.add_argument("--programs", default="../build/bin", type=lambda text: pathlib.Path(text).resolve())
    parser.add_argument("--rates", default=",".join(map(str, RATES)), help="Hz, between commas")
    parser.add_argument("--seconds", type=int, default=SECONDS)
    parser.add_argument("--rounds", type=int, default=ROUNDS)
    options = parser.parse_args()
    enter_private_network()
    data = {name: getattr(options, name) for name in ("scene", "forest", "models")}
    rates = tuple(int(rate) for rate in options.rates.split(","))
    measured = measure(options.programs, data, options.out, Replays(rates, options.seconds, options.rounds))
    write_json(options.out / "following.json", {**measured, **about("studies.follow_speed")})
    print(json.dumps({name: {key: value for key, value in rate.items() if key != "runs"} for name, rate in measured.items()},
                     indent=2))  # fmt: skip


if __name__ == "__main__":
    main()
