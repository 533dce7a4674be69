"""The kinds of work that the comparison consists of: training, evaluation, timing, pictures."""

import dataclasses

import variants
from units import Units
from variants import FEATURE_SCENE, NOT_IN_QUICK, forest_of, is_gall

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


def every_nth(folder, every):
    """A quick run does not overwrite what a full one has measured."""
    return folder if every == 1 else f"{folder}_every_{every}"


class Planner:
    def __init__(self, protocol):
        self.units = Units()
        self.protocol = protocol

    def train(self, what, source, seed, figure, prefix=""):
        forest = forest_of(what)
        name = f"train/{prefix}{forest}/seed{seed}"
        options = (*variants.TRAINING[forest], "--seed", seed, "--threads", self.protocol.threads, *source.training)
        command = ("hs-study-train", *options, "--out", "{out}")
        return self.units.add(name, figure, *command, what=prefix + forest, seed=seed)

    def evaluate(self, what, source, scene, seed, figure, prefix="", every=None):
        """Trains the forest where no other figure has, and measures it; nothing where the protocol leaves it out."""
        if prefix + what in self.protocol.left_out:
            return
        what = forest_of(what)
        forest = self.train(what, source, seed, figure, prefix)
        options = variants.detection_options(what)
        every = (every or self.protocol.every) * (self.protocol.gall_every if is_gall(what) else 1)
        self._evaluation(prefix + what, forest, source, scene, options, figure, every)

    def stride(self, source, stride, seed):
        forest = self.train("paper", source, seed, "5")
        options = (*variants.detection_options("paper"), "--stride", stride)
        self._evaluation(f"stride_{stride}", forest, source, FEATURE_SCENE, options, "5", self.protocol.every)

    def _evaluation(self, what, forest, source, scene, options, figure, every):
        seed = self.units.by_name[forest].seed
        name = f"{every_nth('evaluate', every)}/{what}/{scene}/seed{seed}"
        command = self._evaluate_command(forest, source, scene, every)
        threads = ("--threads", self.protocol.threads)
        self.units.add(name, figure, *command, *options, *threads, what=what, scene=scene, seed=seed)

    def _evaluate_command(self, forest, source, scene, every):
        files = ("--scene", source.scenes[scene], "--forest", f"{{{forest}}}")
        return ("hs-study-evaluate", *files, "--every", every, "--out", "{out}")

    def linemod(self, what, source, scenes, figure, every, extra=()):
        """Learns its templates without chance: one run stands for all. As evaluate() where it is left out."""
        if what in self.protocol.left_out:
            return
        listed = [word for scene in scenes for word in ("--scene", source.scenes[scene])]
        command = ("hs-linemod", *source.training, *source.distances, *listed, "--every", every, *extra)
        self.units.add(
            f"{every_nth('linemod', every)}/{what}",
            figure,
            *command,
            "--threads",
            self.protocol.threads,
            "--out",
            "{out}",
            what=what,
        )

    def timings(self, source):
        """On one scene, few frames: the original takes long for each."""
        every = self.protocol.timing_every
        for what, (forest, options) in variants.TIMINGS.items():
            file = self.train(forest, source, 1, "time")
            threads = () if "--threads" in options else ("--threads", self.protocol.threads)
            command = (*self._evaluate_command(file, source, FEATURE_SCENE, every), *options, *threads)
            self.units.add(
                f"{every_nth('time', every)}/{what}", "time", *command, what=what, scene=FEATURE_SCENE, seed=1
            )

    def side_by_side(self, forests, source, scene, figure):
        """Times forests, units by name, on every frame in turn: a machine is not always as fast."""
        named = (f"{name}={{{forest}}},threads={self.protocol.threads}" for name, forest in forests.items())
        detectors = [word for text in named for word in ("--detector", text)]
        command = ("hs-bench-speed", "--scene", source.scenes[scene], *detectors, "--out", "{out}")
        self.units.add(f"side_by_side/{scene}.json", figure, *command, scene=scene, seed=1)

    def hough_pictures(self, source):
        for name, what in (("before", "gall"), ("after", "final")):
            forest = self.train(what, source, 1, "3")
            command = ("hs-hough", "--forest", f"{{{forest}}}", "--scene", source.scenes[FEATURE_SCENE])
            self.units.add(
                f"hough/{name}.png", "3", *command, "--frame", HOUGH_FRAME, "--out", "{out}", what=what, seed=1
            )

    def failure_pictures(self, source, scenes):
        forest = self.train("realtime", source, 1, "failures")
        listed = [word for scene in scenes for word in ("--scene", source.scenes[scene])]
        command = ("hs-failures", "--forest", f"{{{forest}}}", *listed, "--count", 2, "--every", 2)
        self.units.add("failures/realtime.png", "failures", *command, "--out", "{out}", what="realtime", seed=1)
