"""The units of tools/bench teach: takes, what is made of them, and scenes in which the objects are looked for."""

import dataclasses
import json

from studies.records import read_json, read_json_if_any, threads
from studies.unit_runner import Runner, Store, Units, sha256_of_file

# Every maximum, by its score: what an AUC is measured with.
RANKED = ("--min-mass", "0.05", "--threshold", "0", "--operating-score", "0")
SCENES = ("objects_20_b", "objects_20_d")  # they hold the twelve objects, no others of the twenty
DEVELOPMENT_SCENES = ("development_objects_20_b",)
FRAMES = 120  # of a scene
FPS = 15.0
CAMERA_FPS = 30.0  # of the stream in which an object is taught
STILL_CAMERA = ("teapot", "food_tin", "tea_box", "toy_truck")  # their takes have no camera that is carried
STREAM_PROGRAMS = ("hs-teach", "hs-detect", "hs-pose")


@dataclasses.dataclass
class ObjectFolders:
    """The output for an object; None where it was not."""

    name: str
    answer: dict  # of hs-teach show: status, seconds, said
    kept: object  # folder of hs-teach show --keep
    report: dict | None  # its report.json
    compared: object  # folder of hs-study shown


class Plan:
    def __init__(self, options):
        self.options = options
        self.teach = options.programs / "hs-teach"
        self.teach_digest = sha256_of_file(self.teach)
        self.scenes = DEVELOPMENT_SCENES if options.development else SCENES

    def make(self, units):
        store = Store(self.options.out, self.options.programs, units.all(), files="data")
        store.require_programs()
        for unit in units.all() if self.options.fresh else ():
            store.forget(unit)
        Runner(store).run(units.all())
        return store

    # Units, by name

    def add_takes(self, units, name):
        development = ("--development",) if self.options.development else ()
        one = ("--take", 1) if self.options.takes == 1 else ()
        return units.add(f"takes/{name}", "", "hs-render", "takes", "--objects", name, "--frames", self.options.frames,
                         "--fps", FPS, "--world", self.options.world, *development, *one, "--threads", threads(),
                         "--out", "{out}")  # fmt: skip

    def sources(self, name):
        """--source and --second of hs-teach show."""
        first = 2 * self.all_objects().index(name) + 1
        words = ["--source", f"bop:{{takes/{name}}}/test/{first:06}"]
        if self.options.takes == 2:
            words += ["--second", f"bop:{{takes/{name}}}/test/{first + 1:06}"]
        return words

    @staticmethod
    def all_objects():
        from studies.teach.__main__ import OBJECTS

        return OBJECTS

    def add_taught(self, units, name, kind, before, words):
        """An object that joins the store which unit `before` has left, or begins one."""
        joins = ("--before", f"{{{before}}}/store") if before else ()
        return units.add(f"{kind}/{name}", "", "studies.teach.add_object", "--program", self.teach, "--out", "{out}",
                         *joins, "--", *words, "--out", "{out}/store", "--seed", 1, "--threads", threads(),
                         of=self.teach_digest)  # fmt: skip

    def units_of_objects(self):
        units, shown, true = Units(), None, None
        for name in self.options.objects:
            takes = self.add_takes(units, name)
            show = ("show", *self.sources(name), "--name", name, "--keep", "{out}/kept")
            shown = self.add_taught(units, name, "shown", shown, show)
            model = f"{{{takes}}}/models"
            true = self.add_taught(units, name, "true", true, ("mesh", model))
        return units

    def units_of_comparisons(self, store):
        """Returns the comparisons of what was kept; a refused object has nothing that could be compared."""
        units = Units()
        for name in self.options.objects:
            if (store.path(f"shown/{name}") / "kept" / "model.ply").is_file():
                units.add(f"compared/{name}", "", "hs-study", "shown", "--takes", store.path(f"takes/{name}"), "--object",
                          name, "--kept", store.path(f"shown/{name}") / "kept", "--out", "{out}",
                          of=store.record(store.units[f"shown/{name}"])["made"])  # fmt: skip
        return units

    def units_of_scenes(self, store, compared):
        """Both stores in each scene, the shown one's with the truth of its own frames."""
        units = Units()
        last = self.options.objects[-1]
        words = {"shown": [], "true": []}
        known = [word for name in compared for word in ("--compared", f"{name}={compared[name] / 'compared.json'}")]
        digest = json.dumps({name: sha256_of_file(compared[name] / "compared.json") for name in compared})
        for scene in self.scenes:
            rendered = units.add(f"scenes/{scene}", "", "hs-render", "scene", scene, "--frames", FRAMES, "--every",
                                 self.options.every, "--threads", threads(), "--out", "{out}")  # fmt: skip
            truth = units.add(f"truth/{scene}", "", "studies.teach.taught_truth", "--scene", f"{{{rendered}}}", "--out",
                              "{out}", *known, of=digest)  # fmt: skip
            words["true"] += ["--scene", f"{{{rendered}}}"]
            words["shown"] += ["--scene", f"{{{truth}}}"]
        for kind, scenes in words.items():
            objects = store.path(f"{kind}/{last}") / "store"
            if objects.is_dir():
                made = store.record(store.units[f"{kind}/{last}"])["made"]
                units.add(f"found/{kind}", "", "hs-evaluate", "--objects", objects, *scenes, "--threads", threads(), "--out",
                          "{out}", *RANKED, of=made)  # fmt: skip
        return units

    def taught_in_stream(self):
        """(who is known before, who is taught), or None where too few are asked for."""
        first, *others = self.options.objects
        shown = [name for name in others if name not in STILL_CAMERA]
        return (first, shown[-1]) if shown and self.options.stream else None

    def units_of_stream(self, store, before, name):
        """A take of thirty seconds at a camera's rate, then a scene that holds the object, to programs that run."""
        units, options = Units(), self.options
        number = 2 * self.all_objects().index(name) + 1
        development = ("--development",) if options.development else ()
        frames = round(CAMERA_FPS * (10 if options.quick else 30))
        take = units.add("stream/take", "", "hs-render", "takes", "--objects", name, "--take", 1, "--frames", frames, "--fps",
                         CAMERA_FPS, "--world", options.world, *development, "--threads", threads(), "--out",
                         "{out}")  # fmt: skip
        scene = units.add("stream/scene", "", "hs-render", "scene", self.scenes[0], "--frames", 2 * FRAMES, "--every", 2,
                          "--threads", threads(), "--out", "{out}")  # fmt: skip
        logs = {}
        for what, folder in (("take", f"{{{take}}}/test/{number:06}"), ("scene", f"{{{scene}}}")):
            logs[what] = units.add(f"stream/{what}.lcmlog", "", "hs-capture", "--source", f"bop:{folder}", "--rate",
                                   CAMERA_FPS, "--jpeg-quality", 85, "--log", "{out}")  # fmt: skip
        of = [sha256_of_file(options.programs / program) for program in STREAM_PROGRAMS]
        of.append(store.record(store.units[f"true/{before}"])["made"])
        units.add("stream/live", "", "studies.teach.live_teaching", "--programs", options.programs, "--store",
                  store.path(f"true/{before}") / "store", "--name", name, "--take", f"{{{logs['take']}}}", "--after",
                  f"{{{logs['scene']}}}", "--out", "{out}", of=" ".join(of))  # fmt: skip
        return units

    def run(self):
        """The folders of each object, by name, the summaries of hs-evaluate by kind (shown, true), and how the teaching in
        a stream went, or None."""
        store = self.make(self.units_of_objects())
        comparisons = self.make(self.units_of_comparisons(store))
        compared = {unit.name.split("/")[1]: comparisons.file(unit) for unit in comparisons.units.values()}
        found = self.make(self.units_of_scenes(store, compared))
        folders = {}
        for name in self.options.objects:
            shown = store.path(f"shown/{name}")
            folders[name] = ObjectFolders(name, read_json(shown / "taught.json"), shown / "kept",
                                          read_json_if_any(shown / "kept" / "report.json"), compared.get(name))  # fmt: skip
        summaries = {kind: read_json(found.path(f"found/{kind}") / "summary.json")
                     for kind in ("shown", "true") if f"found/{kind}" in found.units}  # fmt: skip
        return folders, summaries, self.run_stream(store)

    def run_stream(self, store):
        pair = self.taught_in_stream()
        return read_json(self.make(self.units_of_stream(store, *pair)).path("stream/live") / "live.json") if pair else None
