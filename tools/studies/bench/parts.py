"""The parts of tools/bench: the data that each needs, and what it runs."""

import json
import shutil
import subprocess

from studies.bench import attitudes, pose, speed
from studies.bop.plan import RANKED as RANKED_POSES
from studies.bop.plan import teach_seconds
from studies.command import TEST_SCENES, call, recorded_views, step
from studies.records import about, threads, write_json
from studies.stream import Stream
from studies.unit_runner import Runner, Store, Units

SPEED_SCENE = "table_small_1"
DISTANCES = ("--min-distance", "0.75", "--max-distance", "2.1")  # at which the objects of the test scenes stand
# Every detection, ranked, for the whole precision-recall curve. What stands beside an AUC is timed so too.
RANKED = ("--min-mass", "0.05", "--threshold", "0")
RANKED_WISHES = "min-mass=0.05,threshold=0"
GALL = ("--threshold", "0.1", "--stride", "1")  # of gall, whose score is the vote mass, all from 0.1 on: its defaults
FEW = 12  # the reference engine looks at every Nth frame
SETS = ("SSE4", "AVX2", "AVX3")  # Highway's names
STREAM_RATE, STREAM_SECONDS = 30, 60
OBJECTS, TREES, SCALES = (1, 2, 4, 8, 12, 20, 30, 40), (5, 10, 15, 20, 30), (0.5, 1, 1.5, 2)
GROWTH_VIEWS = ("--azimuths", 18, "--pitches", 2)  # fewer than usual: enough for how the time grows


class Bench:
    def __init__(self, options):
        self.options, self.programs, self.out = options, options.programs, options.out
        self.units = Units()

    def scene(self, name):
        """Units are named at once and made by make()."""
        return self.units.add(
            f"scene/{name}", "", "hs-render", "scene", name, "--frames", 300, "--every", 5, "--out", "{out}"
        )

    def views(self):
        return self.units.add("training", "", "hs-render", "training", "--out", "{out}")

    def train(self, name, *options, views=None, program=("hs-train",)):
        rooms = self.units.add("background", "", "hs-render", "background", "--count", 215, "--out", "{out}")
        views = views or self.views()
        return self.units.add(name, "", *program, *options, "--threads", threads(), "--out", "{out}", "--views",
                              f"bop:{{{views}}}", "--background", f"bop:{{{rooms}}}")  # fmt: skip

    def make_store(self):
        units = self.units.all()
        store = Store(self.out, self.programs, units, files="data")
        store.require_programs()
        for unit in units if self.options.fresh else ():
            store.forget(unit)
        Runner(store).run(units)
        return store

    def make(self):
        """Returns the path of each unit by name."""
        store = self.make_store()
        return {name: store.file(unit) for name, unit in store.units.items()}

    def fresh_folder(self, name):
        """Makes an empty folder: what an earlier run measured does not speak for this one."""
        folder = self.out / name
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        return folder

    def finish(self, part, folder):
        """A part may be of another day and commit than the others: it says which."""
        write_json(folder / "about.json", about(f"tools/bench {part}"))


def side_by_side(bench, scene, out, detectors, *more):
    listed = [word for detector in detectors for word in ("--detector", detector)]
    call(bench.programs / "hs-study", "speed", "--scene", scene, "--every", bench.options.every, "--out", out, *listed, *more,
         into=out.with_suffix(".txt"))  # fmt: skip


def instruction_sets(bench):
    listed = subprocess.run(
        [bench.programs / "hs-study", "speed", "--instruction-sets"], capture_output=True, text=True, check=True
    )
    return [name for name in listed.stdout.split() if name in SETS]


def speed_contenders(bench, path):
    """NAME=FOREST,wishes of everything that is timed. The ranked ones do what their AUC was measured with; threads and
    instruction sets are those of the detector as it runs, from its default score on."""
    most, ours = threads(), path["forest"]
    ranked = [
        f"realtime={ours},threads={most},{RANKED_WISHES}",
        f"realtime_one_thread={ours},threads=1,{RANKED_WISHES}",
        f"paper={path['paper_forest']},threads={most},{RANKED_WISHES}",
        f"serial={ours},threads=1,reference,frames=3,{RANKED_WISHES}",
        f"gall={path['gall_forest']},threads=1,reference,frames=1",
        f"gall_engine={path['gall_forest']},threads=1,frames=2",
    ]
    counts = [f"threads_{n}={ours},threads={n}" for n in range(1, most + 1)]
    return ranked + counts + [f"set_{name}={ours},threads=1,set={name}" for name in instruction_sets(bench)]


def accuracy(bench, out, name, program, *options):
    """AUC over the scene's frames, as OUT/NAME/summary.json."""
    step(f"speed: accuracy of {name}")
    call(bench.programs / program, *options, "--out", out / name, into=out / f"{name}.txt")


def measure_accuracy(bench, path, out):
    scene = ("--scene", path[f"scene/{SPEED_SCENE}"])
    ours, all_threads = ("--forest", path["forest"]), ("--threads", threads())
    accuracy(bench, out, "realtime", "hs-evaluate", *scene, *ours, *RANKED, *all_threads)
    accuracy(bench, out, "default", "hs-evaluate", *scene, *ours, *all_threads)
    accuracy(bench, out, "paper", "hs-evaluate", *scene, "--forest", path["paper_forest"], *RANKED, *all_threads)
    accuracy(bench, out, "gall", "hs-study", "evaluate", *scene, "--forest", path["gall_forest"], *GALL, *all_threads)
    few = ("--every", FEW)
    accuracy(bench, out, "realtime_few", "hs-evaluate", *scene, *ours, *RANKED, *few, *all_threads)
    accuracy(bench, out, "serial_few", "hs-study", "evaluate", *scene, *ours, *RANKED, *few, "--reference", "--threads", 1)
    views = ("--views", f"bop:{path['training']}")
    accuracy(bench, out, "linemod", "hs-study", "linemod", *views, *DISTANCES, *scene, *all_threads)


def bench_speed(bench):
    bench.scene(SPEED_SCENE)
    bench.train("forest")
    bench.train("paper_forest", "--profile", "paper")
    bench.train("gall_forest", "--profile", "gall", program=("hs-study", "train"))
    path, out = bench.make(), bench.fresh_folder("speed")
    scene = path[f"scene/{SPEED_SCENE}"]
    measure_accuracy(bench, path, out)
    step("speed: side by side")
    linemod = ("--linemod-views", f"bop:{path['training']}", *DISTANCES, "--linemod-threads", threads())
    side_by_side(bench, scene, out / "times.json", speed_contenders(bench, path), *linemod)
    step("speed: kernels")
    call(bench.programs / "hs-study", "kernels", "--scene", scene, "--forest", path["forest"], "--benchmark_repetitions=5",
         "--benchmark_report_aggregates_only=true", f"--benchmark_out={out / 'kernels.json'}",
         "--benchmark_out_format=json", into=out / "kernels.txt")  # fmt: skip
    bench.finish("speed", out)


def bench_stream(bench):
    """A minute of replay through the processes, capture to pose, as compressed and as raw frames."""
    frames = STREAM_RATE * STREAM_SECONDS
    bench.train("forest")
    bench.units.add("stream_scene", "", "hs-render", "scene", SPEED_SCENE, "--frames", 300, "--out", "{out}")
    forms = {"compressed": (), "raw": ("--raw-colour", "--raw-depth")}
    for name, options in forms.items():
        bench.units.add(f"{name}.lcmlog", "", "hs-capture", "--source", "bop:{stream_scene}", "--rate", STREAM_RATE, "--loop",
                        "--frames", frames, "--log", "{out}", *options)  # fmt: skip
    path = bench.make()
    for name in forms:
        step(f"stream: {STREAM_SECONDS} s of {name} frames at {STREAM_RATE} Hz")
        stream = Stream(bench.programs, path["forest"], path["training"] / "models", frames, bench.out / f"stream_{name}",
                        pose=("--threads", threads()), watch=True)  # fmt: skip
        stream.play("lcm-logplayer", path[f"{name}.lcmlog"])
        bench.finish("stream", stream.out)


def objects_forest(bench, names, count):
    """Makes the forest of the first so many of forty objects."""
    few = ",".join(names[:count])
    views = bench.units.add(
        f"growth/views_{count}", "", "hs-render", "training", "--objects", few, *GROWTH_VIEWS, "--out", "{out}"
    )
    return bench.train(f"growth/objects_{count}", "--composites", 2, views=views)


def bench_growth(bench):
    """Measures how time grows with objects, trees and pixels."""
    bench.scene(SPEED_SCENE)
    bench.train("forest")
    bench.train("growth/trees_30", "--trees", 30)
    bench.units.add(
        "growth/all_views",
        "",
        "hs-render",
        "training",
        "--objects",
        f"all_{OBJECTS[-1]}",
        *GROWTH_VIEWS,
        "--out",
        "{out}",
    )
    known = json.loads((bench.make()["growth/all_views"] / "models" / "names.json").read_text())
    names = [known[key] for key in sorted(known, key=int)]
    for count in OBJECTS:
        objects_forest(bench, names, count)
    path, out, most = bench.make(), bench.fresh_folder("growth"), threads()
    detectors = [f"objects_{n}={path[f'growth/objects_{n}']},threads={most}" for n in OBJECTS]
    detectors += [f"trees_{n}={path['growth/trees_30']},threads={most},trees={n}" for n in TREES]
    detectors += [f"scale_{n}={path['forest']},threads={most},scale={n}" for n in SCALES]
    step("growth: side by side")
    side_by_side(bench, path[f"scene/{SPEED_SCENE}"], out / "times.json", detectors)
    bench.finish("growth", out)


def bench_rendered_poses(bench, path):
    scenes = [word for scene in TEST_SCENES for word in ("--scene", path[f"scene/{scene}"])]
    step("poses: ours, PCL's, and of two other methods")
    out, options = bench.fresh_folder("pose"), bench.options
    call(bench.programs / "hs-study", "pose", "--forest", path["forest"], "--models", path["training"] / "models", *scenes,
         "--every", options.every, "--rivals-every", options.rivals_every, "--threads", threads(), "--out", out,
         into=bench.out / "pose.txt")  # fmt: skip
    bench.finish("pose", out)


def bench_recorded_poses(bench, path):
    """Models are fused of the training views; the compared object's is replaced by its scanned mesh."""
    step("poses: recorded frames")
    real = bench.options.real
    call(bench.programs / "hs-study", "recorded", "--scenes", f"{real}/scenes", "--forest", path["real_forest"], "--models",
         path["real_models"], "--scan", f"{real}/model/ornament_3.obj", "--references",
         f"{real}/scenes/pseudo_poses_ornament_3.json", "--threshold", "0.01", "--threads", threads(), "--out",
         bench.out / "real", into=bench.out / "real.txt")  # fmt: skip


def bench_pose(bench):
    """On the six test scenes, and on camera-recorded data where that is there."""
    real = bench.options.real
    bench.train("forest")
    for scene in TEST_SCENES:
        bench.scene(scene)
    if real:
        views = recorded_views(real)
        rooms = ("--background", f"images:{real}/background")
        bench.units.add("real_forest", "", "hs-train", "--threads", threads(), "--out", "{out}", *views, *rooms)
        bench.units.add("real_models", "", "hs-fuse", "--threads", threads(), "--out", "{out}", *views)
    path = bench.make()
    shutil.rmtree(bench.out / "real", ignore_errors=True)
    bench_rendered_poses(bench, path)
    if real:
        bench_recorded_poses(bench, path)
    pose.write(bench.out)


def bench_attitudes(bench):
    """The four objects, taught by their meshes upright and in every attitude, where they lie and where they stand."""
    models = f"{{{bench.views()}}}/models"
    scenes = [scene for group in attitudes.GROUPS.values() for scene in group]
    for scene in scenes:
        bench.scene(scene)
    for name in attitudes.TAUGHT:
        bench.units.add(f"attitudes/{name}", "", "hs-teach", "mesh", models, "--attitudes", name, "--threads", threads(),
                        "--out", "{out}/store")  # fmt: skip
    store = bench.make_store()
    out = bench.fresh_folder("attitudes")
    for name in attitudes.TAUGHT:
        for scene in scenes:
            step(f"attitudes: {scene}, taught {name}")
            folders = attitudes.scene_folders(bench.out, name, scene)
            look = ("--scene", store.path(f"scene/{scene}"), "--objects", store.path(f"attitudes/{name}") / "store",
                    "--every", bench.options.every, "--threads", threads())  # fmt: skip
            for folder, options in ((folders.ranked, RANKED_POSES), (folders.default, ())):
                call(bench.programs / "hs-evaluate", *look, *options, "--out", folder, into=folder.with_suffix(".txt"))
    seconds = {name: teach_seconds(store.log(store.units[f"attitudes/{name}"])) for name in attitudes.TAUGHT}
    write_json(out / "teach_seconds.json", seconds)
    bench.finish("attitudes", out)
    attitudes.write(bench.out)


PARTS = {
    "speed": bench_speed,
    "stream": bench_stream,
    "growth": bench_growth,
    "pose": bench_pose,
    "attitudes": bench_attitudes,
}


def run(options):
    bench = Bench(options)
    for part in options.parts:
        PARTS[part](bench)
    step("report")
    speed.write(options.out)
