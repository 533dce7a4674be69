"""The units of tools/bench tracks: for each sequence its log, what is found in it, its tracks, and the comparison."""

import pathlib

from studies.records import threads
from studies.unit_runner import Runner, Store, Units

WRONG = "0.02"  # metres by which one of three cameras is said to be elsewhere
CAMERAS = ("CAMERA_1", "CAMERA_2", "CAMERA_3")


class Plan:
    def __init__(self, options):
        self.options = options
        self.units = Units()
        self.forest, self.models = self.taught()
        self.digest = ""

    def add(self, name, *command):
        return self.units.add(name, "", *command)

    def taught(self):
        """The words for forest and models."""
        if self.options.forest:
            return str(self.options.forest.resolve()), str(self.options.models.resolve())
        views = self.add("training", "hs-render", "training", "--out", "{out}")
        rooms = self.add("background", "hs-render", "background", "--count", 215, "--out", "{out}")
        forest = self.add("forest", "hs-train", "--threads", threads(), "--out", "{out}", "--views", f"bop:{{{views}}}",
                          "--background", f"bop:{{{rooms}}}")  # fmt: skip
        return f"{{{forest}}}", f"{{{views}}}/models"

    def sequence(self, name):
        """Units of a sequence; the last ones are its comparisons."""
        development = ("--development",) if self.options.development else ()
        rendered = self.add(f"rendered/{name}", "hs-render", "sequences", "--names", name, "--threads", threads(), "--out",
                            "{out}", *development)  # fmt: skip
        folder = f"{{{rendered}}}/{name}"
        found = self.found(name, folder)
        channels = "|".join(CAMERAS) if name == "cameras" else CAMERAS[0]
        self.tracked(name, folder, found, channels)
        self.add(f"single/{name}.json", "hs-study", "tracks", "compare", "--single-frames", folder, f"{{{found}}}", "--models",
                 self.models, "--out", "{out}")  # fmt: skip
        if self.options.follow:
            slow = self.found(name, folder, every=3, kind="_10hz")
            self.add(f"single_10hz/{name}.json", "hs-study", "tracks", "compare", "--single-frames", "--every", 3, folder, f"{{{slow}}}",
                     "--models", self.models, "--out", "{out}")  # fmt: skip
        if name == "cameras":
            for camera in CAMERAS:
                self.tracked(camera, folder, found, camera)
            self.add("wrong.lcmlog", "hs-study", "tracks", "log", folder, "{out}", "--wrong", f"CAMERA_2={WRONG},0,0")
            self.add("wrong_found.lcmlog", "hs-study", "tracks", "join", "{wrong.lcmlog}", f"{{{found}}}", "--out", "{out}")

    def found(self, name, folder, every=1, kind=""):
        """The log of the sequence, or of every n-th of its frames, with detections and poses."""
        frames = self.add(f"frames{kind}/{name}.lcmlog", "hs-study", "tracks", "log", folder, "{out}", "--every", every)
        search = ("-c", "CAMERA_.*", "--threads", threads())
        detected = self.add(f"detected{kind}/{name}.lcmlog", "hs-detect", "-l", f"file://{{{frames}}}", "--output-log", "{out}",
                            "--keep-frames", "--forest", self.forest, *search)  # fmt: skip
        follow = ("--follow",) if self.options.follow else ()
        posed = self.add(f"posed{kind}/{name}.lcmlog", "hs-pose", "-l", f"file://{{{detected}}}", "--output-log", "{out}", "--models",
                         self.models, *search, *follow)  # fmt: skip
        return self.add(f"found{kind}/{name}.lcmlog", "hs-study", "tracks", "join", f"{{{frames}}}", f"{{{detected}}}", f"{{{posed}}}",
                        "--out", "{out}")  # fmt: skip

    def tracked(self, name, folder, found, channels):
        tracks = [self.add(f"tracks/{name}{again}.lcmlog", "hs-track", "-l", f"file://{{{found}}}", "--output-log", "{out}",
                           "--models", self.models, "-c", channels) for again in ("", "_again")]  # fmt: skip
        self.add(f"tracked/{name}.json", "hs-study", "tracks", "compare", folder, f"{{{tracks[0]}}}", "--models", self.models, "--out",
                 "{out}")  # fmt: skip

    def make(self):
        for name in self.options.sequences:
            self.sequence(name)
        units = self.units.all()
        store = Store(self.options.out, self.options.programs, units, files="tracks")
        store.require_programs()
        for unit in units if self.options.fresh else ():
            store.forget(unit)
        Runner(store).run(units)
        return store

    def path(self, store, words):
        """Returns the path that words for a forest or models name."""
        for unit in self.units.all():
            words = words.replace(f"{{{unit.name}}}", str(store.file(unit)))
        return pathlib.Path(words)
