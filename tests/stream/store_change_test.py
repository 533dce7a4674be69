"""An object store that changes under a stream: what is renamed is there without a restart, and is the same object of the world, what is
removed leaves the world, what is torn is said, whoever is killed while he changes it leaves it whole, with somebody's files in it, and none
is replaced unless that is asked for.

Forest, models and scene are those that end_to_end_test.py has made.
"""

import json
import random
import shutil
import signal
import subprocess
import sys
import time

from PIL import Image

from folders import read_arguments
from houghstream import detections_t, known_objects_t, objects_t, status_t, tracked_object_t
from houghstream.event_log import read_log
from studies.still_scene import make_still_scene
from studies.stream import Process, enter_private_network
from end_to_end_test import CLASSES, THRESHOLD

RATE = 5  # frames a second
STILL = 22  # image in which each object is found once: before a camera that jumps, they might become others


def make_store(made, store):
    """Makes a store as hs-teach leaves one."""
    (store / "views").mkdir(parents=True)
    shutil.copy(made / "small.forest", store / "forest")
    shutil.copytree(made / "views" / "models", store / "models")
    objects = []
    for number, name in json.loads((store / "models" / "names.json").read_text()).items():
        Image.new("RGB", (120, 50)).save(store / "views" / f"obj_{int(number):06d}.png")
        objects.append({"id": int(number), "name": name, "mesh": "rendered", "coloured": True, "views": 9, "attitudes": "upright"})
    (store / "store.json").write_text(json.dumps({"houghstream_store": 1, "objects": objects, "settings": {}}))


def names_in(store):
    return {entry["name"] for entry in json.loads((store / "store.json").read_text())["objects"]}


def hs_teach(tools, *words):
    return subprocess.run([str(tools / "hs-teach"), *map(str, words)], capture_output=True, text=True, check=False, timeout=60)


def files_in(folder):
    return {file: file.read_bytes() for file in folder.rglob("*") if file.is_file()}


def check_refused(tools, store):
    """A teaching that says neither --add nor --replace changes nothing."""
    before = files_in(store.parent)
    mesh = store / "models" / "obj_000001.ply"
    for words in (("mesh", mesh), ("show", "--source", "log:nowhere.lcmlog", "--name", "cup")):
        done = hs_teach(tools, *words, "--out", store)
        assert done.returncode == 1, done
        expected = "expected --add to add to it, or --replace to put a new one in its place"
        assert done.stderr == f"hs-teach: {store}: holds {len(CLASSES)} objects, {expected}\n", done
        assert files_in(store.parent) == before


def put_notes(store):
    """Somebody's own files in a store."""
    (store / "NOTES.txt").write_text("the handle faces left")
    (store / "recordings").mkdir()
    (store / "recordings" / "monday.lcmlog").write_text("events")


def expect_notes(store, after):
    assert (store / "NOTES.txt").read_text() == "the handle faces left", after
    assert (store / "recordings" / "monday.lcmlog").read_text() == "events", after


def check_killed(tools, store):
    """At whatever moment: the store is the old one or the new one, and the next change goes through."""
    chance = random.Random(1)
    changed = 0
    for turn in range(20):
        before = names_in(store)
        old, new = ("bowl", "dish") if "bowl" in before else ("dish", "bowl")
        process = subprocess.Popen([tools / "hs-teach", "rename", store, old, new], stderr=subprocess.DEVNULL)
        time.sleep(chance.uniform(0.0, 0.25))
        process.send_signal(signal.SIGKILL)
        process.wait()
        listed = hs_teach(tools, "list", store)
        assert listed.returncode == 0, (turn, listed)
        changed += names_in(store) != before
        assert names_in(store) in (before, before - {old} | {new}), (turn, names_in(store))
        expect_notes(store, f"killed {turn}")
    expect_notes(store, "killed")
    print(f"killed 20 times, {changed} changes were made before that")
    if "bowl" in names_in(store):  # a change clears away what killed ones left
        assert hs_teach(tools, "rename", store, "bowl", "dish").returncode == 0
    assert hs_teach(tools, "rename", store, "dish", "bowl").returncode == 0
    assert [file.name for file in store.parent.glob(".*")] == [], "nothing is left beside it"


class Log:
    """The messages of the processes, in a log."""

    def __init__(self, file):
        self.file = file
        self.logger = subprocess.Popen(["lcm-logger", "-f", "-q", "--flush-interval=1", "-c", "HOUGHSTREAM_.*", str(file)],
                                       stderr=subprocess.DEVNULL)

    def read(self, channel, message):
        try:
            return [message.decode(data) for _, name, data in read_log(self.file) if name == channel]
        except (FileNotFoundError, ValueError):
            return []  # not there yet, or its end is just being written

    def wait(self, what, complaint, seconds=60):
        end = time.monotonic() + seconds
        while not what():
            assert time.monotonic() < end, complaint
            time.sleep(0.2)

    def known(self, process):
        said = [k for k in self.read("HOUGHSTREAM_KNOWN_OBJECTS", known_objects_t) if k.process == process]
        return said[-1] if said else None

    def worlds(self):
        """Numbers of the objects that are there by their names, after each frame."""
        return [[(one.class_name, one.track_id) for one in world.objects if one.state != tracked_object_t.GONE]
                for world in self.read("HOUGHSTREAM_OBJECTS", objects_t)]  # fmt: skip

    def wait_for_known(self, name):
        for process in ("hs-detect", "hs-pose", "hs-track"):
            self.wait(lambda: (known := self.known(process)) and name in known.object_names, f"{process} does not know {name}")

    def wait_for_found(self, name):
        def found():
            last = self.read("HOUGHSTREAM_DETECTIONS", detections_t)[-10:]
            return any(detection.class_name == name for some in last for detection in some.detections)

        self.wait(found, f"{name} is not found")


def check_stream(tools, made, folder, store):
    scene = make_still_scene(made / "scene", folder / "still", STILL)
    log = Log(folder / "results.log")
    processes = [Process(folder, tools / "hs-detect", "--objects", store, "--threshold", THRESHOLD),
                 Process(folder, tools / "hs-pose", "--objects", store),
                 Process(folder, tools / "hs-track", "--objects", store)]
    try:
        for process in processes:
            process.wait_until_ready()
        processes.append(Process(folder, tools / "hs-capture", "--source", f"bop:{scene}", "--loop", "--rate", RATE))
        log.wait_for_known("bowl")
        log.wait_for_found("bowl")
        log.wait(lambda: log.worlds() and len(log.worlds()[-1]) == len(CLASSES), "the world lacks an object")
        first = log.known("hs-detect")
        assert hs_teach(tools, "rename", store, "bowl", "dish").returncode == 0
        log.wait_for_known("dish")
        log.wait_for_found("dish")
        check_world_renamed(log, "bowl", "dish")
        second = log.known("hs-detect")
        since = dict(zip(second.object_names, second.object_since_utimes))
        assert "bowl" not in since and since["soda_can"] < since["dish"], since
        assert since["soda_can"] == dict(zip(first.object_names, first.object_since_utimes))["soda_can"], since
        check_torn(log, store)
        assert hs_teach(tools, "remove", store, "soda_can").returncode == 0
        log.wait(lambda: {name for name, _ in log.worlds()[-1]} == {"dish"}, "soda_can is still in the world", 30)
        log.wait(lambda: log.known("hs-detect").object_names == ["dish"], "soda_can is still known")
        worlds = len(log.worlds())
        log.wait(lambda: len(log.worlds()) > worlds + 3 * RATE, "no objects come")
        assert all({name for name, _ in world} <= {"dish"} for world in log.worlds()[worlds:]), log.worlds()[worlds:]
        for process in reversed(processes):
            process.stop()
        log.wait(lambda: last_of(log, "hs-detect").frames_received == last_of(log, "hs-capture").frames_processed, "the last word is missing", 10)
    finally:
        for process in processes:
            process.kill()
        log.logger.terminate()
        log.logger.wait()
    last = last_of(log, "hs-detect")
    print(f"{last.frames_received} frames received, {last.frames_lost} lost, {last.frames_skipped} passed over; the store changed four times")
    assert last.frames_lost == 0 and last.frames_received == last.frames_processed + last.frames_skipped
    words = processes[0].log.read_text()
    assert words.count("what was known stays") == 1, words


def check_world_renamed(log, former, name):
    """One object with one number, first by one name and then by the other."""
    log.wait(lambda: name in dict(log.worlds()[-1]), f"{name} is not in the world")
    worlds = [world for world in log.worlds() if any(known in (former, name) for known, _ in world)]
    of_object = [[(known, number) for known, number in world if known in (former, name)] for world in worlds]
    assert all(len(objects) == 1 for objects in of_object), ("it stands twice", of_object)
    assert len({number for ((_, number),) in of_object}) == 1, ("its number changes", of_object)


def last_of(log, process):
    return [status for status in log.read("HOUGHSTREAM_STATUS", status_t) if status.process == process][-1]


def check_torn(log, store):
    """Half a forest: the old one goes on, and it is said why. Then it is whole again."""
    whole = (store / "forest").read_bytes()
    (store / "forest").write_bytes(whole[: len(whole) // 2])
    log.wait(lambda: log.known("hs-detect").problem, "nobody says that the forest is torn")
    assert str(store / "forest") in log.known("hs-detect").problem, log.known("hs-detect").problem
    assert log.known("hs-detect").problem == last_of(log, "hs-detect").last_error
    assert "dish" in log.known("hs-detect").object_names
    log.wait_for_found("dish")
    (store / "forest").write_bytes(whole)
    log.wait(lambda: not log.known("hs-detect").problem, "the forest is whole again, expected that it is taken")


def main():
    enter_private_network()
    arguments = read_arguments(__doc__, made="what end_to_end_test.py has made")
    store = arguments.out / "my" / "store"
    make_store(arguments.made, store)
    assert names_in(store) == set(CLASSES.values()), names_in(store)
    put_notes(store)
    check_refused(arguments.tools, store)
    check_killed(arguments.tools, store)
    check_stream(arguments.tools, arguments.made, arguments.out, store)
    expect_notes(store, "changed under a stream")


if __name__ == "__main__":
    sys.exit(main())
