"""Faults of the object store that a stream works on."""

import json
import re
import shutil
import subprocess
import time

from houghstream import objects_t, tracked_object_t
from houghstream.event_log import read_log
from studies.soak.faults import HEARD, RESULTS, Faults, said
from studies.soak.wire import Listener, bus
from studies.still_scene import make_still_scene
from studies.stream import Process, ProcessFailed

# After which the one who writes it is killed; of the time that it takes undisturbed.
MOMENTS = (0.05, 0.2, 0.35, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.3)


FOREIGN = {"NOTES.txt": "the handle faces left", "recordings/monday.lcmlog": "events", "models/mug.blend": "source of a mesh"}


class Worlds:
    """The objects of the world after each frame, in a log until stop()."""

    def __init__(self, file):
        self.file = file
        self.logger = subprocess.Popen(["lcm-logger", "-f", "-q", "--flush-interval=1", f"--lcm-url={bus(HEARD)}", "-c", "HOUGHSTREAM_OBJECTS",
                                        str(file)],
                                       stderr=subprocess.DEVNULL)  # fmt: skip

    def stop(self):
        self.logger.terminate()
        self.logger.wait()

    def read(self):
        """Returns of each frame when the log got it, seconds, and the numbers of the objects that are there, lists by name."""
        worlds = []
        for utime, _, data in self.events():
            named = {}
            for one in objects_t.decode(data).objects:
                if one.state != tracked_object_t.GONE:
                    named.setdefault(one.class_name, []).append(one.track_id)
            worlds.append((utime * 1e-6, named))
        return worlds

    def events(self):
        try:
            return list(read_log(self.file))
        except (FileNotFoundError, ValueError):
            return []  # not there yet, or its end is just being written

    def wait_for(self, is_it, seconds):
        """Returns whether the last world is so, soon."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            worlds = self.read()
            if worlds and is_it(worlds[-1][1]):
                return True
            time.sleep(0.2)
        return False


class StoreFaults(Faults):
    """Each function is one fault; it returns what it saw, with "good"."""

    def store(self, folder):
        """A store of the demo's objects."""
        store = folder / "objects.store"
        store.mkdir()
        shutil.copyfile(self.data / "forest", store / "forest")
        shutil.copytree(self.models, store / "models")
        (store / "views").mkdir()
        for image in self.models.glob("*.png"):  # of one size
            shutil.copyfile(self.models / "obj_000001.png", store / "views" / image.name)
        names = {int(number): name for number, name in json.loads((self.models / "names.json").read_text()).items()}
        objects = [{"id": number, "name": names[number], "mesh": f"obj_{number:06d}.ply", "coloured": True, "views": 1, "attitudes": "any"}
                   for number in sorted(names)]  # fmt: skip
        (store / "store.json").write_text(json.dumps({"houghstream_store": 1, "objects": objects, "settings": {}}))
        return store

    def teach(self, *words, kill_after=None):
        """hs-teach's exit status and words; None for a status where it was killed."""
        process = subprocess.Popen([self.programs / "hs-teach", *map(str, words)], stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, text=True)  # fmt: skip
        try:
            words, _ = process.communicate(timeout=60 if kill_after is None else kill_after)
            return process.returncode, words
        except subprocess.TimeoutExpired:
            process.kill()
            return None, process.communicate()[0]

    def changed(self, *words):
        """Changes the store by hs-teach, which nobody disturbs."""
        status, answer = self.teach(*words)
        if status != 0:
            raise ProcessFailed(f"hs-teach {' '.join(map(str, words))}: {answer}")

    def names(self, store):
        """Returns what the store holds, or None where it is none."""
        status, _ = self.teach("list", store)
        if status != 0:
            return None
        return sorted(one["name"] for one in json.loads((store / "store.json").read_text())["objects"])

    def goes_on(self, listener, seconds=20.0):
        """Returns whether detections and poses still come."""
        since = time.monotonic()
        return all(listener.wait_for(RESULTS[name], lambda one: one.time > since, seconds) for name in ("detect", "pose"))

    def writer_killed(self):
        """Kills programs that rename and remove at several moments while the stream runs."""
        folder = self.folder("writer_killed")
        store = self.store(folder)
        stream = self.stream(folder, "--objects", store)
        listener = Listener(HEARD, RESULTS.values())
        outcomes = {"before": 0, "after": 0, "torn": 0}
        try:
            self.wait_for(stream, r"pose [1-9][\d.]* Hz", 60)
            name = self.names(store)[0]
            start = time.monotonic()
            self.changed("rename", store, name, "at_first")
            took = time.monotonic() - start
            name = "at_first"
            for turn, moment in enumerate(MOMENTS):
                was, other = self.names(store), f"turn_{turn}"
                self.teach("rename", store, name, other, kill_after=moment * took)
                then = self.outcome(store, was, sorted([other, *(one for one in was if one != name)]))
                name = other if then == "after" else name
                outcomes[then] += 1
            for moment in MOMENTS:
                spare = shutil.copytree(store, folder / f"spare_{moment}" / "objects.store")
                was = self.names(spare)
                self.teach("remove", spare, name, kill_after=moment * took)
                outcomes[self.outcome(spare, was, [one for one in was if one != name])] += 1
            self.changed("rename", store, name, "at_last")
            self.wait_for(stream, r"hs-detect: .*new: at_last", 60)
            self.wait_for(stream, r"hs-pose: .*new: at_last", 60)
            runs = self.goes_on(listener)
            left = [one.name for one in folder.iterdir() if ".partial" in one.name]
            restarts = said(stream, "starts again")
            stream.stop(10.0)
        finally:
            stream.kill()
            listener.stop()
        return {"killed": len(MOMENTS) * 2, "store_then": outcomes, "left_behind": left, "restarts": restarts,
                "reported": said(stream, "from here on|what was known stays"),
                "good": outcomes["torn"] == 0 and runs and not left and not restarts}  # fmt: skip

    def outcome(self, store, before, after):
        names = self.names(store)
        return "after" if names == after else "before" if names == before else "torn"

    def torn(self):
        """The forest is cut while the stream runs, hs-detect is killed meanwhile, the forest comes back."""
        folder = self.folder("torn")
        store = self.store(folder)
        whole = (store / "forest").read_bytes()
        stream = self.stream(folder, "--objects", store)
        listener = Listener(HEARD, RESULTS.values())
        try:
            self.wait_for(stream, r"pose [1-9][\d.]* Hz", 60)
            with open(store / "forest", "r+b") as forest:
                forest.truncate(len(whole) // 2)
            self.wait_for(stream, r"hs-detect: .*truncated.*what was known stays", 20)
            kept = self.goes_on(listener)
            pid = int(re.findall(r"detect started, process (\d+)", stream.log.read_text())[-1])
            subprocess.run(["kill", "-9", str(pid)], check=True)
            self.wait_for(stream, r"detect ended with status 1; starts again", 20)
            start = time.monotonic()
            earlier = listener.senders(RESULTS["detect"])
            (store / "forest").write_bytes(whole)
            first = listener.wait_for(RESULTS["detect"], lambda one: one.sender not in earlier, 30)
            back = self.goes_on(listener)
            stream.stop(10.0)
        finally:
            stream.kill()
            listener.stop()
        return {"went_on_with_what_it_knew": kept, "back_after_s": round(first.time - start, 2) if first else None,
                "reported": said(stream, "truncated|starts again|was killed"), "good": bool(kept and first and back)}  # fmt: skip

    def replaced(self):
        """Another store takes its place in one step; then none is there, then the first one again."""
        folder = self.folder("replaced")
        store = self.store(folder)
        other = folder / "other.store"
        shutil.copytree(store, other)
        self.changed("rename", other, self.names(other)[0], "of_the_other")
        stream = self.stream(folder, "--objects", store)
        listener = Listener(HEARD, RESULTS.values())
        try:
            self.wait_for(stream, r"pose [1-9][\d.]* Hz", 60)
            store.rename(folder / "first.store")
            other.rename(store)
            self.wait_for(stream, r"hs-pose: .*new: of_the_other", 60)
            self.wait_for(stream, r"hs-detect: .*new: of_the_other", 60)
            store.rename(other)
            self.wait_for(stream, r"hs-detect: .*what was known stays", 30)
            kept = self.goes_on(listener)
            (folder / "first.store").rename(store)
            self.wait_for(stream, r"hs-detect: .*gone: of_the_other", 60)
            back = self.goes_on(listener)
            restarts = said(stream, "starts again")
            stream.stop(10.0)
        finally:
            stream.kill()
            listener.stop()
        return {"went_on_with_what_it_knew": kept, "restarts": restarts,
                "reported": said(stream, "from here on|what was known stays"),
                "good": kept and back and not restarts}  # fmt: skip

    def foreign_files(self):
        """Somebody's files lie in the store while its writers are killed at several moments."""
        folder = self.folder("foreign_files")
        store = self.store(folder)
        for name, words in FOREIGN.items():
            (store / name).parent.mkdir(exist_ok=True)
            (store / name).write_text(words)
        names = self.names(store)
        start = time.monotonic()
        self.changed("rename", store, names[0], "at_first")
        took = time.monotonic() - start
        name, lost = "at_first", []
        for turn, moment in enumerate(MOMENTS):
            was, other = self.names(store), f"turn_{turn}"
            self.teach("rename", store, name, other, kill_after=moment * took)
            name = name if self.names(store) == was else other
            lost += [f"{file} at {moment}" for file in self.missing(store)]
        self.changed("remove", store, name)
        lost += [f"{file} at the end" for file in self.missing(store)]
        left = [one.name for one in folder.iterdir() if one != store]
        return {"killed": len(MOMENTS), "lost": lost, "left_behind": left, "good": not lost and not left}

    @staticmethod
    def missing(store):
        """Returns those of somebody's files that are not there as they were."""
        return [name for name, words in FOREIGN.items() if not (store / name).is_file() or (store / name).read_text() != words]

    def changes_under_track(self):
        """An object of the world is renamed, and then its class is removed, while hs-track runs."""
        folder = self.folder("changes_under_track")
        store = self.store(folder)
        stream = self.stream(folder, "--objects", store, scene=make_still_scene(self.data / "scene", folder / "still"))
        track = Process(folder, self.programs / "hs-track", "--objects", store, "-l", bus(HEARD))
        worlds = Worlds(folder / "worlds.lcmlog")
        try:
            self.wait_for(stream, r"pose [1-9][\d.]* Hz", 60)
            known = set(self.names(store))
            if not worlds.wait_for(lambda world: world.keys() & known, 60):
                raise ProcessFailed("no object is in the world")
            name = sorted(worlds.read()[-1][1].keys() & known)[0]
            begun = time.time()
            self.changed("rename", store, name, "another")
            renamed = worlds.wait_for(lambda world: "another" in world and name not in world, 20)
            self.wait_for(stream, r"hs-pose: .*new: another", 60)
            time.sleep(3.0)  # for numbers to change, if they do
            numbers = [world.get(name, []) + world.get("another", []) for when, world in worlds.read() if when > begun]
            twice = [one for one in numbers if len(one) > 1]
            self.changed("remove", store, "another")
            removed = time.time()
            gone = worlds.wait_for(lambda world: "another" not in world, 20)
            self.wait_for(stream, r"hs-pose: .*gone: another", 60)
            time.sleep(2.0)
            late = [when - removed for when, world in worlds.read() if "another" in world and when > removed]
            track.stop()
            stream.stop(10.0)
        finally:
            for process in (track, stream):
                process.kill()
            worlds.stop()
        one_number = len({tuple(one) for one in numbers if one}) == 1
        return {"renamed": renamed, "same_number": one_number, "frames_with_two": len(twice),
                "gone": gone, "last_there_s_after_removal": round(max(late, default=0.0), 2),
                "reported": said(track, "from here on|is called|is gone"),
                "good": bool(renamed and one_number and not twice and gone and max(late, default=0.0) < 2.0)}  # fmt: skip

    def all(self):
        yield "who changes the store is killed at 22 moments", self.writer_killed
        yield "the store's forest is cut, and hs-detect killed meanwhile", self.torn
        yield "the store is replaced, taken away, put back", self.replaced
        yield "somebody's files lie in the store, and its writers are killed", self.foreign_files
        yield "an object is renamed and removed while hs-track runs", self.changes_under_track
