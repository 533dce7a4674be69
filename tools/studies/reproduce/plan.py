"""Everything that the comparison runs, as a list of units: what belongs to which figure is decided here."""

import dataclasses

from studies.reproduce import sources, variants
from studies.reproduce.variants import (
    FEATURE_SCENE,
    FEATURES,
    NOT_IN_QUICK,
    OTHER_KERNELS,
    OTHER_SENSOR,
    PROFILES,
    SCALE_HANDLING,
    SCALE_SCENES,
    SCENES,
    SCENES_20,
    STRIDES,
    forest_of,
    is_gall,
)
from studies.unit_runner import Units

CHECK_DEPTH = ("--check-depth",)
HOUGH_FRAME = 0


@dataclasses.dataclass(frozen=True)
class Protocol:
    """Section 4 of the paper: five training runs."""

    seeds: tuple = (1, 2, 3, 4, 5)
    every: int = 1  # Nth frame of a scene is evaluated
    gall_every: int = 1  # Nth of these by forests of the family of gall
    left_out: tuple = ()  # see NOT_IN_QUICK
    timing_every: int = 20
    threads: int = 2


def quick(protocol):
    return dataclasses.replace(protocol, seeds=(1,), every=3, gall_every=2, timing_every=60, left_out=NOT_IN_QUICK)


FAST_TIMING_EVERY = 6


def every_nth(folder, every):
    """A quick run does not overwrite what a full one has measured."""
    return folder if every == 1 else f"{folder}_every_{every}"


@dataclasses.dataclass(frozen=True)
class Frames:
    """Of a source's scene, and the figure for which they are looked at."""

    source: sources.Source
    scene: str
    figure: str
    every: int = 0  # Nth of them; 0: as the protocol says


class Planner:
    """The kinds of work: training, evaluation, timing, images."""

    def __init__(self, protocol):
        self.units = Units()
        self.protocol = protocol
        self.threads = ("--threads", protocol.threads)

    def train(self, what, source, seed, figure, prefix=""):
        forest = forest_of(what)
        name = f"train/{prefix}{forest}/seed{seed}"
        options = (*variants.TRAINING[forest], "--seed", seed, *self.threads, *source.training)
        facts = {"what": prefix + forest, "seed": seed}
        return self.units.add(name, figure, *variants.trainer(forest), *options, "--out", "{out}", **facts)

    def evaluate(self, what, frames, seed, prefix=""):
        """Trains the forest where no other figure has, and measures it; nothing where the protocol leaves it out."""
        if prefix + what in self.protocol.left_out:
            return
        what = forest_of(what)
        forest = self.train(what, frames.source, seed, frames.figure, prefix)
        every = (frames.every or self.protocol.every) * (self.protocol.gall_every if is_gall(what) else 1)
        self.measure(prefix + what, what, forest, dataclasses.replace(frames, every=every))

    def stride(self, source, stride, seed):
        forest = self.train("paper", source, seed, "5")
        self.measure(f"stride_{stride}", "paper", forest, Frames(source, FEATURE_SCENE, "5"), stride)

    def measure(self, name, what, forest, frames, stride=None):
        """`name`: in the report; `what`: the kind of detector; `forest`: the unit that trains it."""
        seed = self.units.by_name[forest].seed
        every = frames.every or self.protocol.every
        command = (*variants.evaluator(what), *self._files(forest, frames.source, frames.scene, every))
        options = (*variants.detection_options(what, stride), *self.threads)
        unit = f"{every_nth('evaluate', every)}/{name}/{frames.scene}/seed{seed}"
        self.units.add(unit, frames.figure, *command, *options, what=name, scene=frames.scene, seed=seed)

    def _files(self, forest, source, scene, every):
        return ("--scene", source.scenes[scene], "--forest", f"{{{forest}}}", "--every", every, "--out", "{out}")

    def linemod(self, source, scenes, figure, every, prefix=""):
        """Runs LINEMOD with and without its check of depth. Learns its templates without chance: one run stands for all. As
        evaluate() where it is left out."""
        listed = [word for scene in scenes for word in ("--scene", source.scenes[scene])]
        for name, check in (("linemod", CHECK_DEPTH), ("linemod_no_check", ())):
            what = prefix + name
            if what in self.protocol.left_out:
                continue
            command = ("hs-study", "linemod", *source.training, *source.distances, *listed, "--every", every, *check, *self.threads)
            self.units.add(f"{every_nth('linemod', every)}/{what}", figure, *command, "--out", "{out}", what=what)

    def timings(self, source):
        """On one scene, few frames: the original takes long for each. What is fast takes longest for its first one."""
        for name, timing in variants.TIMINGS.items():
            every = self.protocol.timing_every if timing.reference else FAST_TIMING_EVERY
            forest = self.train(timing.forest, source, 1, "time")
            command = (
                *variants.evaluator(timing.forest, timing.reference),
                *self._files(forest, source, FEATURE_SCENE, every),
            )
            facts = {"what": name, "scene": FEATURE_SCENE, "seed": 1}
            self.units.add(
                f"{every_nth('time', every)}/{name}", "time", *command, *timing.options(self.protocol.threads), **facts
            )

    def side_by_side(self, forests, source, scene, figure):
        """Times forests, units by name, on every frame in turn: a machine is not always as fast."""
        wishes = f"threads={self.protocol.threads},{variants.RANKED_WISHES}"
        detectors = [
            word for name, forest in forests.items() for word in ("--detector", f"{name}={{{forest}}},{wishes}")
        ]
        command = ("hs-study", "speed", "--scene", source.scenes[scene], *detectors, "--out", "{out}")
        self.units.add(f"side_by_side/{scene}.json", figure, *command, scene=scene, seed=1)

    def hough_images(self, source):
        for name, what in (("before", "gall"), ("after", "final")):
            forest = self.train(what, source, 1, "3")
            command = ("hs-study", "hough", "--forest", f"{{{forest}}}", "--scene", source.scenes[FEATURE_SCENE])
            self.units.add(
                f"hough/{name}.png", "3", *command, "--frame", HOUGH_FRAME, "--out", "{out}", what=what, seed=1
            )

    def failure_images(self, source, scenes):
        forest = self.train("realtime", source, 1, "failures")
        listed = [word for scene in scenes for word in ("--scene", source.scenes[scene])]
        command = ("hs-study", "failures", "--forest", f"{{{forest}}}", *listed, "--count", 2, "--every", 2)
        self.units.add("failures/realtime.png", "failures", *command, "--out", "{out}", what="realtime", seed=1)


def add_profiles(planner, source, seed):
    for scene in SCENES:
        for what in PROFILES:
            planner.evaluate(what, Frames(source, scene, "6"), seed)


def add_features(planner, source, seed):
    for what in (name for name in FEATURES if name not in OTHER_KERNELS):
        planner.evaluate(what, Frames(source, FEATURE_SCENE, "1, 2"), seed)


def add_single_studies(planner, source, seed):
    for what in OTHER_KERNELS:
        planner.evaluate(what, Frames(source, FEATURE_SCENE, "1, 2"), seed)
    for scene in SCALE_SCENES:
        for what in ("five", *SCALE_HANDLING):
            planner.evaluate(what, Frames(source, scene, "4"), seed)
    for stride in STRIDES:
        planner.stride(source, stride, seed)


def add_other_sensor(planner, source, seed):
    """Evaluates the same forest on scenes that another sensor saw."""
    forest = planner.train("realtime", source, seed, "sensor")
    other = sources.other_sensor(planner.units, source)
    for scene in other.scenes:
        planner.measure(f"{OTHER_SENSOR}_realtime", "realtime", forest, Frames(other, scene, "sensor"))


def add_twenty_objects(planner, few):
    """Both forests look at the same frames, so that only the number of objects differs."""
    source, twenty = sources.twenty(planner.units, few)
    forests = {
        "realtime": planner.train("realtime", source, 1, "objects"),
        "objects_20_realtime": planner.train("realtime", twenty, 1, "objects", "objects_20_"),
    }
    for scene in SCENES_20:
        planner.evaluate("realtime", Frames(source, scene, "objects"), 1)
        planner.evaluate("realtime", Frames(twenty, scene, "objects"), 1, prefix="objects_20_")
        planner.side_by_side(forests, source, scene, "objects")


def add_comparison(planner, source):
    """One run of everything."""
    first = planner.protocol.seeds[0]
    add_profiles(planner, source, first)
    add_features(planner, source, first)
    planner.linemod(source, SCENES, "6", planner.protocol.every)
    add_single_studies(planner, source, first)
    planner.hough_images(source)
    planner.failure_images(source, SCENES)
    planner.timings(source)


def add_real(planner, source):
    """Few images: even a quick run looks at all."""
    first = planner.protocol.seeds[0]
    add_real_runs(planner, source, first)
    planner.linemod(source, ["scenes"], "real", 1, prefix="real_")
    for what in ("gall", "paper"):
        planner.evaluate(what, Frames(source, "scenes", "real", every=1), first, prefix="real_")


def add_real_runs(planner, source, seed):
    for scene in ("scenes", "clutter"):
        planner.evaluate("realtime", Frames(source, scene, "real", every=1), seed, prefix="real_")


def make_plan(dataset, folder, real, protocol):
    """`dataset` is rendered, uw or real; `real` is the folder of recorded images, or empty."""
    planner = Planner(protocol)
    source = None
    if dataset == "rendered":
        source = sources.rendered(planner.units)
    elif dataset == "uw":
        source = sources.uw(planner.units, folder)
    recorded = sources.recorded(planner.units, real) if real else None
    # The first run of everything comes first, so that an early report has all figures.
    if source:
        add_comparison(planner, source)
    if dataset == "rendered":
        add_other_sensor(planner, source, protocol.seeds[0])
    if recorded:
        add_real(planner, recorded)
    if dataset == "rendered" and "objects_20" not in protocol.left_out:
        add_twenty_objects(planner, source)
    # What the protocol asks to be repeated, as training has its luck.
    for seed in protocol.seeds[1:]:
        if source:
            add_profiles(planner, source, seed)
        if dataset == "rendered":
            add_other_sensor(planner, source, seed)
        if recorded:
            add_real_runs(planner, recorded, seed)
    for seed in protocol.seeds[1:] if source else ():
        add_features(planner, source, seed)
    return planner.units.all()
