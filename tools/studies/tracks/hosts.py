"""Objects on two hosts: two detectors with disjoint forests, each with its hs-pose on a host and a processor core of its
own, feed one hs-track on a third host, where the camera is too. Forty taught objects on two hosts beside twenty on one,
and what happens when a host's cable is pulled. tools/bench tracks asks measure(); by itself, when all is built:

    cd tools && PYTHONPATH=../build/python python3 -m studies.tracks.hosts --out OUT
"""

import argparse
import json
import os
import pathlib
import shutil
import time

from studies.command import step
from studies.follow_speed import make_log
from studies.records import about, read_json, threads, write_json
from studies.network import URL, Network
from studies.stream import Processes, UsageWatch, enter_private_network
from studies.tracks.host_records import Record, figures, lost_host
from studies.unit_runner import Runner, Store, Units

SCENE = "objects_20_a"  # twelve of the forty stand in it
SEEN_VIEWS = ("--azimuths", 24, "--pitches", 2)
OTHER_VIEWS = ("--azimuths", 8, "--pitches", 1)  # of what does not stand there: enough for what it costs to look for it
RATE = 10  # Hz
ALONE_S, TOGETHER_S, CUT_S, AGAIN_S = 20, 20, 15, 10
WARM_UP_S = 3.0
HOSTS = ("a", "b")
HOW = (
    "Forty taught objects, twenty a host, in a table's scene that holds six of each twenty: one rendered picture, shown again "
    "and again. Network namespaces at a bridge, ttl=1; each host's hs-detect and hs-pose have one core of the machine, the "
    "third host's camera, hs-track and recorder what is left of both."
)


def divided(names, visible):
    """All names in two parts with as many of the visible ones each."""
    seen = [name for name in names if name in visible]
    rest = [name for name in names if name not in visible]
    return [seen[part::2] + rest[part::2] for part in range(2)]


def copy_models(models, objects, folder):
    """A models folder with some of the objects of another."""
    folder.mkdir(parents=True, exist_ok=True)
    names = {key: name for key, name in read_json(models / "names.json").items() if name in objects}
    info = read_json(models / "models_info.json")
    write_json(folder / "names.json", names)
    write_json(folder / "models_info.json", {key: info[key] for key in names})
    for key in names:
        for file in models.glob(f"obj_{int(key):06}.*"):
            shutil.copy(file, folder)
    return folder


class Taught:
    """The scene, and for each host its objects, forest and models; made once, as tools/bench tracks makes its own."""

    def __init__(self, programs, out):
        self.programs, self.out, self.units = programs, out, Units()
        scene = self._add("scene", "hs-render", "scene", SCENE, "--frames", 300, "--every", 300, "--out", "{out}")
        known = self._add("known", "hs-render", "training", "--objects", "all_40", "--azimuths", 1, "--pitches", 1, "--out",
                          "{out}")  # fmt: skip
        rooms = self._add("rooms", "hs-render", "background", "--count", 60, "--out", "{out}")
        self.scene, self.models = self._made(scene, known)
        self.models = self.models / "models"
        names = read_json(self.models / "names.json")
        seen = next(iter(read_json(next(self.scene.glob("**/scene_gt.json"))).values()))
        self.visible = {names[str(one["obj_id"])] for one in seen}
        self.objects = divided([names[key] for key in sorted(names, key=int)], self.visible)
        forests = [self._taught(host, objects, rooms) for host, objects in zip(HOSTS, self.objects)]
        self.forests = self._made(*forests)
        self.host_models = [
            copy_models(self.models, objects, out / f"models_{host}") for host, objects in zip(HOSTS, self.objects)
        ]

    def _taught(self, host, objects, rooms):
        """The unit of a host's forest: those that stand in the scene by more views than the others."""
        views = []
        for kind, how, wanted in (("seen", SEEN_VIEWS, True), ("other", OTHER_VIEWS, False)):
            some = [name for name in objects if (name in self.visible) == wanted]
            views.append(
                self._add(f"{kind}_{host}", "hs-render", "training", "--objects", ",".join(some), *how, "--out", "{out}")
            )
        words = [word for one in views for word in ("--views", f"bop:{{{one}}}")]
        return self._add(f"forest_{host}", "hs-train", "--threads", threads(), "--composites", 2, *words, "--background",
                         f"bop:{{{rooms}}}", "--out", "{out}")  # fmt: skip

    def _add(self, name, *command):
        return self.units.add(name, "", *command)

    def _made(self, *names):
        units = self.units.all()
        store = Store(self.out, self.programs, units, files="hosts")
        Runner(store, tell=lambda words: step(f"hosts: {words}")).run(units)
        return [store.file(self.units.by_name[name]) for name in names]


class Stream:
    """The processes on three hosts, and the record of what the third one hears."""

    def __init__(self, taught, network, running, hosts):
        self.taught, self.network, self.running, self.hosts = taught, network, running, hosts
        self.recorded = running.folder / "recorded.lcmlog"

    def start(self):
        programs, taught = self.taught.programs, self.taught
        for host in self.hosts:
            part = HOSTS.index(host)
            core = ("taskset", "-c", sorted(os.sched_getaffinity(0))[part % threads()])
            self._start(f"detect_{host}", *self.network.enter(host), *core, programs / "hs-detect", "--threads", 1, "--forest",
                        taught.forests[part])  # fmt: skip
            self._start(f"pose_{host}", *self.network.enter(host), *core, programs / "hs-pose", "--threads", 1, "--models",
                        taught.host_models[part])  # fmt: skip
        self._start("track", programs / "hs-track", "--models", taught.models)
        for process in self.running.by_name.values():
            process.wait_until_ready(60)
        self._start("recorder", "lcm-logger", "-f", "-q", f"--lcm-url={URL}&recv_buf_size=4194304", "-c",
                    "OPENNI_FRAME|HOUGHSTREAM_(POSES|OBJECTS)", self.recorded)  # fmt: skip
        time.sleep(0.5)  # lcm-logger does not say when it listens

    def _start(self, name, *command):
        self.running.start(name, *command, LCM_DEFAULT_URL=URL)

    def watch(self):
        return UsageWatch({name: process for name, process in self.running.by_name.items() if name != "recorder"})

    def play(self, log):
        self._start("camera", "lcm-logplayer", log)

    def await_words(self, name, words, seconds):
        """Seconds until the process says it, or None."""
        begin = time.monotonic()
        while time.monotonic() - begin < seconds:
            if words in self.running.by_name[name].log.read_text(errors="replace"):
                return round(time.monotonic() - begin, 2)
            time.sleep(0.05)
        return None

    def record(self):
        """Returns what was received; the log, which holds all frames, goes."""
        record = Record(self.recorded)
        self.recorded.unlink()
        return record

    def stop(self):
        self.running.by_name["camera"].kill()
        self.running.stop(*(name for name in self.running.by_name if name != "camera"), seconds=20.0)


def run_one(taught, network, log, out):
    with Processes(out) as running:
        stream = Stream(taught, network, running, HOSTS[:1])
        stream.start()
        usage = stream.watch()
        stream.play(log)
        time.sleep(ALONE_S)
        summary = usage.summary()
        stream.stop()
    record = stream.record()
    end = max(record.frames.values())
    return {
        **figures(record, min(record.frames.values()) + WARM_UP_S, end, {"a": taught.objects[0]}),
        "cores": summary["cores"],
    }


def run_two(taught, network, log, out):
    parts = dict(zip(HOSTS, taught.objects))
    with Processes(out) as running:
        stream = Stream(taught, network, running, HOSTS)
        stream.start()
        usage = stream.watch()
        stream.play(log)
        time.sleep(TOGETHER_S)
        summary = usage.summary()
        times = {"cut": time.time()}
        network.cut("b")
        said = stream.await_words("track", "no heartbeat", CUT_S)
        time.sleep(max(0.0, times["cut"] + CUT_S - time.time()))
        times["joined"] = time.time()
        network.join("b")
        time.sleep(AGAIN_S)
        times["end"] = time.time()
        stream.stop()
    record = stream.record()
    together = figures(record, min(record.frames.values()) + WARM_UP_S, times["cut"], parts)
    return {**together, "cores": summary["cores"]}, lost_host(record, times, parts, said)


def measure(programs, out):
    """{"one": twenty objects on one host, "two": forty on two, "lost": a host goes away, ...}. Takes two minutes when
    the objects have been taught."""
    programs, out = pathlib.Path(programs), pathlib.Path(out)
    out.mkdir(parents=True, exist_ok=True)
    taught = Taught(programs, out)
    log = make_log(programs, taught.scene, RATE, TOGETHER_S + CUT_S + AGAIN_S + 5, out / f"camera_{RATE}.lcmlog")
    load = os.getloadavg()[0]
    with Network(*HOSTS) as network:
        step(f"hosts: {ALONE_S} s of twenty objects on one host")
        one = run_one(taught, network, log, out / "one")
        step(f"hosts: {TOGETHER_S + CUT_S + AGAIN_S} s of forty objects on two hosts, one of which goes away")
        two, lost = run_two(taught, network, log, out / "two")
    return {"how": HOW, "objects": [len(part) for part in taught.objects], "camera_hz": RATE, "one": one, "two": two, "lost": lost,
            "load_before": round(load, 2)}  # fmt: skip


def by_number(measured):
    """Returns rows for tables: (words, figures) of one host and of two."""
    return [("twenty objects", measured["one"]), ("forty objects", measured["two"])] if measured else []


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("--out", required=True, type=lambda text: pathlib.Path(text).resolve())
    parser.add_argument("--programs", default="../build/bin", type=lambda text: pathlib.Path(text).resolve())
    options = parser.parse_args()
    if enter_private_network() != "private":
        parser.error("network namespaces are refused here, and hosts are made of them")
    measured = measure(options.programs, options.out)
    write_json(options.out / "hosts.json", {**measured, **about("studies.tracks.hosts")})
    print(json.dumps(measured, indent=2))


if __name__ == "__main__":
    main()
