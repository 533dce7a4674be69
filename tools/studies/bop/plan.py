"""The units of tools/bench bop: teaching first, since it gives the names, then what looks for the objects and measures."""

import dataclasses
import pathlib

from studies.bop.subset import BadSet, read_targets
from studies.bop.dataset import folder_digest, known_objects, true_objects
from studies.command import step
from studies.records import threads
from studies.unit_runner import Runner, Store, Units

# Every maximum, by its score: what an AUC is measured with; a pose counts whatever its detection's score, as BOP counts.
RANKED = ("--min-mass", "0.05", "--threshold", "0", "--operating-score", "0")
VISIBLE = 0.1  # what is less visible is no target
MARGIN = 0.05  # by which LINEMOD is taught nearer and farther than the objects stand


@dataclasses.dataclass(frozen=True)
class Taught:
    """A dataset with the store of one seed."""

    dataset: object
    store: pathlib.Path
    seed: int
    names: dict  # of the known objects, by the dataset's ids
    views: pathlib.Path | None  # rendered training views, where they were taught in this run


@dataclasses.dataclass
class SceneFolders:
    """The places of a scene's measurements; None where there are none."""

    name: str
    ranked: pathlib.Path  # every detection, ranked
    default: pathlib.Path  # from the default score on
    poses: pathlib.Path | None = None  # hs-study pose: ours unchecked, rivals, the worst
    linemod: pathlib.Path | None = None
    failures: pathlib.Path | None = None


class Plan:
    def __init__(self, options):
        self.options, self.out = options, options.out
        self.unknown = {}  # ids of what stands in a set's chosen images but not in the store, by the set's name

    def make(self, units):
        store = Store(self.out, self.options.programs, units.all(), files="data")
        store.require_programs()
        for unit in units.all() if self.options.fresh else ():
            store.forget(unit)
        Runner(store).run(units.all())
        return store

    def teach(self, datasets):
        """Each dataset with the store of each seed, and the seconds that teaching took."""
        if self.options.objects:
            names = {dataset.name: self.names(dataset, self.options.objects) for dataset in datasets}
            return [Taught(dataset, self.options.objects, 1, names[dataset.name], None) for dataset in datasets], {}
        units = Units()
        for dataset in datasets:
            digest = folder_digest(dataset.models)
            for seed in range(1, self.options.seeds + 1):
                units.add(self.taught(dataset, seed), "", "hs-teach", "mesh", "--out", "{out}/store", "--dump-views",
                          "{out}/views", "--seed", seed, "--threads", threads(), dataset.models.resolve(),
                          what=dataset.name, seed=seed, of=digest)  # fmt: skip
        store = self.make(units)
        taught, seconds = [], {}
        for dataset in datasets:
            for seed in range(1, self.options.seeds + 1):
                unit = store.units[self.taught(dataset, seed)]
                folder = store.file(unit)
                names = self.names(dataset, folder / "store")
                taught.append(Taught(dataset, folder / "store", seed, names, folder / "views"))
                seconds[dataset.name, seed] = teach_seconds(store.log(unit)) or store.record(unit)["seconds"]
        return taught, seconds

    @staticmethod
    def taught(dataset, seed):
        return f"{dataset.name}/seed_{seed}/taught"

    def names(self, dataset, store):
        """Returns the names of the objects that the store knows, by the dataset's ids. Those in its images that it does not
        know are told."""
        known = known_objects(dataset, store)
        there = {key for _, key, _, _ in true_objects(dataset, self.options.every)}
        unknown = sorted(there - set(known))
        if not there & set(known):
            raise BadSet(
                f"{store}: it knows none of the objects of {dataset.name}: {', '.join(map(str, sorted(there)))}"
            )
        if unknown and dataset.name not in self.unknown:
            step(f"{dataset.name}: left out, unknown to {store}: objects {', '.join(map(str, unknown))}")
        self.unknown[dataset.name] = unknown
        return known

    def measure(self, taught):
        """The folders of each scene, by (dataset's name, seed)."""
        units, folders = Units(), {}
        for one in taught:
            for scene in one.dataset.scenes:
                self.add_scene(units, one, scene)
            if one.seed == 1 and self.options.rivals:
                self.add_linemod(units, one)
        store = self.make(units)
        for one in taught:
            folders[one.dataset.name, one.seed] = [self.folders(store, one, scene) for scene in one.dataset.scenes]
        return folders

    def place(self, taught, what, scene):
        return f"{taught.dataset.name}/seed_{taught.seed}/{what}/{scene.name}"

    def seconds_a_scene(self, dataset):
        return round(self.options.rivals_seconds / len(dataset.scenes), 1)

    def add_scene(self, units, one, scene):
        dataset, facts = one.dataset, {"what": one.dataset.name, "scene": scene.name, "seed": one.seed}
        known = folder_digest(one.store)
        targets = ("--targets", dataset.targets.resolve()) if dataset.targets else ()
        names = ",".join(f"{key}={name}" for key, name in sorted(one.names.items()))
        chosen = units.add(f"{dataset.name}/seed_{one.seed}/scenes/{scene.name}", "", "studies.bop.subset", "--scene",
                           scene.resolve(), "--out", "{out}", "--names", names, "--every", self.options.every, "--digest",
                           folder_digest(scene), *targets, **facts)  # fmt: skip
        of_scene = ("--scene", f"{{{chosen}}}", "--threads", threads(), "--out", "{out}")
        evaluate = ("hs-evaluate", "--objects", one.store, *of_scene)
        units.add(self.place(one, "ranked", scene), "", *evaluate, *RANKED, of=known, **facts)
        units.add(self.place(one, "default", scene), "", *evaluate, of=known, **facts)
        if one.seed > 1:
            return  # rivals and images are of the first
        store = ("--objects", one.store)
        limit = (
            ("--rivals-every", 1, "--rivals-seconds", self.seconds_a_scene(dataset))
            if self.options.rivals
            else ("--no-rivals",)
        )
        units.add(self.place(one, "poses", scene), "", "hs-study", "pose", *store, *of_scene, "--min-mass", "0.05",
                  *limit, of=known, **facts)  # fmt: skip
        units.add(self.place(one, "failures", scene) + ".png", "", "hs-study", "failures", *store, *of_scene, of=known, **facts)

    def add_linemod(self, units, one):
        """One training for all scenes of a dataset."""
        dataset = one.dataset
        if one.views is None or not one.views.is_dir():
            step(f"{dataset.name}: LINEMOD is left out, it needs the training views of an own teaching")
            return
        depths = [
            entry["cam_t_m2c"][2] * 1e-3
            for _, key, entry, seen in true_objects(dataset, self.options.every)
            if key in one.names and seen["visib_fract"] >= VISIBLE and "cam_t_m2c" in entry
        ]
        if not depths:
            return
        scenes = [
            word
            for scene in dataset.scenes
            for word in ("--scene", f"{{{dataset.name}/seed_{one.seed}/scenes/{scene.name}}}")
        ]
        units.add(f"{dataset.name}/seed_{one.seed}/linemod", "", "hs-study", "linemod", "--views", f"bop:{one.views}", "--check-depth",
                  "--min-distance", f"{min(depths) * (1 - MARGIN):.3f}", "--max-distance",
                  f"{max(depths) * (1 + MARGIN):.3f}", "--seconds", self.seconds_a_scene(dataset), "--threads", threads(),
                  "--out", "{out}", *scenes, what=dataset.name, of=folder_digest(one.store))  # fmt: skip

    def folders(self, store, one, scene):
        def made(name):
            unit = store.units.get(name)
            return store.file(unit) if unit else None

        linemod = made(f"{one.dataset.name}/seed_{one.seed}/linemod")
        return SceneFolders(
            scene.name,
            made(self.place(one, "ranked", scene)),
            made(self.place(one, "default", scene)),
            made(self.place(one, "poses", scene)),
            linemod / scene.name if linemod else None,
            made(self.place(one, "failures", scene) + ".png"),
        )


def teach_seconds(log):
    """Returns the value of the last line "teach_seconds X" of hs-teach's words, or None."""
    values = [line.split()[1] for line in log.read_text().splitlines() if line.startswith("teach_seconds ")]
    return float(values[-1]) if values else None


def target_count(dataset):
    """Returns the number of all instances that the targets name, or None where there are none."""
    if dataset.targets is None:
        return None
    return sum(
        count
        for scene in read_targets(dataset.targets).values()
        for image in scene.values()
        for count in image.values()
    )
