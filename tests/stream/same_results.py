"""Tells whether a change left every result as it was, bit for bit. A yardstick for work that only moves and renames code.

    python3 tests/stream/same_results.py build/bin --work out/same --write before.json     # before the change
    python3 tests/stream/same_results.py build/bin --work out/same --compare before.json   # after it

It digests (SHA-256): what is rendered; forests of the profiles gall, paper and realtime and one with surface features; a store
taught from a mesh and one from a take; detections, poses, followed poses and objects of a log; a fused model; the figures of
hs-evaluate and hs-study pose. Times are left out of all of them, as are the names of folders. With --only WORD, only the parts
whose names hold the word. Ends with status 1 and names the parts where a digest differs.
"""

import argparse
import hashlib
import json
import pathlib
import re
import shutil
import subprocess
import sys

SEED, THREADS = 1, 2
FRAMES = 30
TREES = ("--trees", 3, "--composites", 1, "--patches", 40, "--tests", 400)
TIME_KEY = re.compile(r"(^|_)(ms|us)(_|$)|(_s|seconds|time|times|commit|machine|started|threads|stages)$")


def hexadecimal(data):
    return hashlib.sha256(data).hexdigest()


def without_times(value):
    """A JSON value without the members that tell a time."""
    if isinstance(value, dict):
        return {key: without_times(member) for key, member in value.items() if not TIME_KEY.search(key)}
    return [without_times(member) for member in value] if isinstance(value, list) else value


def digest_json(file, work):
    text = json.dumps(without_times(json.loads(file.read_text())), sort_keys=True)
    return hexadecimal(text.replace(str(work), "").encode())


def digest_csv(file):
    """A table without its columns of times."""
    rows = [line.split(",") for line in file.read_text().splitlines()]
    kept = [number for number, name in enumerate(rows[0]) if not TIME_KEY.search(name)]
    return hexadecimal("\n".join(",".join(row[i] for i in kept if i < len(row)) for row in rows).encode())


def digest_file(file, work):
    if file.suffix == ".json":
        return digest_json(file, work)
    return digest_csv(file) if file.suffix == ".csv" else hexadecimal(file.read_bytes())


def digest_folder(folder, work, endings=None):
    files = sorted(f for f in folder.rglob("*") if f.is_file() and (endings is None or f.suffix in endings))
    return hexadecimal("\n".join(f"{f.relative_to(folder)} {digest_file(f, work)}" for f in files).encode())


def digest_log(file):
    """The messages of a results log in their order, without their times of receipt, stage times and heartbeats."""
    from houghstream import detections_t, object_poses_t, objects_t
    from houghstream.event_log import read_log

    types = {kind._get_packed_fingerprint(): kind for kind in (detections_t, object_poses_t, objects_t)}
    digest = hashlib.sha256()
    for event in read_log(file):
        if event.channel.endswith("STATUS"):
            continue
        data, kind = event.data, types.get(event.data[:8])
        if kind:
            message = kind.decode(data)
            message.stages, message.n_stages = [], 0
            data = message.encode()
        digest.update(event.channel.encode() + b"\0" + data)
    return digest.hexdigest()


class Results:
    def __init__(self, programs, work):
        self.programs, self.work = programs, work
        self.log = open(work / "same_results.log", "w")

    def call(self, program, *words):
        command = [str(self.programs / program), *map(str, words)]
        print(" ".join(command), file=self.log, flush=True)
        subprocess.run(command, stdout=self.log, stderr=subprocess.STDOUT, check=True, cwd=self.work)

    def fresh(self, name):
        path = self.work / name
        if path.is_dir():
            shutil.rmtree(path)
        path.unlink(missing_ok=True)
        return path

    def parts(self):
        """The names of the parts and what gives their digests, in an order in which each finds what it needs."""
        yield "rendered views", lambda: self.render("views", "training", "--azimuths", 12, "--pitches", 2)
        yield "rendered background", lambda: self.render("background", "background", "--count", 30)
        yield "rendered scene", lambda: self.render("scene", "scene", "table_small_1", "--frames", FRAMES)
        yield "rendered take", lambda: self.render("takes", "takes", "--development", "--objects", "tea_box", "--take", 1, "--frames", 120)
        yield "forest gall", lambda: self.forest("gall", ("hs-study", "train"), "--profile", "gall")
        yield "forest paper", lambda: self.forest("paper", ("hs-train",), "--profile", "paper")
        yield "forest realtime", lambda: self.forest("realtime", ("hs-train",), "--profile", "realtime")
        yield "forest surface", lambda: self.forest("surface", ("hs-study", "train"), "--profile", "realtime", "--features", "intensity,depth_derivatives,honv")
        yield "store from a mesh", self.mesh_store
        yield "store from a take", self.take_store
        yield "detections", self.detections
        yield "poses", lambda: self.poses("poses")
        yield "followed poses", lambda: self.poses("followed", "--follow")
        yield "objects", self.objects
        yield "fused model", self.fused
        yield "figures of hs-evaluate", lambda: self.evaluated(("hs-evaluate",), "realtime")
        yield "figures of hs-study evaluate, gall", lambda: self.evaluated(("hs-study", "evaluate"), "gall", "--every", 10)
        yield "figures of hs-study evaluate, surface", lambda: self.evaluated(("hs-study", "evaluate"), "surface", "--every", 10)
        yield "figures of hs-study pose", self.benched

    def render(self, name, *words):
        out = self.fresh(name)
        self.call("hs-render", *words, "--threads", THREADS, "--out", out)
        return digest_folder(out, self.work)

    def forest(self, name, program, *words):
        out = self.fresh(f"{name}.forest")
        self.call(*program, *words, *TREES, "--seed", SEED, "--threads", THREADS, "--views", f"bop:{self.work}/views",
                  "--background", f"bop:{self.work}/background", "--out", out)  # fmt: skip
        return digest_file(out, self.work)

    def teach(self, *words, store):
        out = self.fresh(store)
        self.call("hs-teach", *words, "--seed", SEED, "--threads", THREADS, "--cache", self.work / "cache", "--out", out)
        return digest_folder(out, self.work)

    def mesh_store(self):
        return self.teach("mesh", sorted((self.work / "views/models").glob("*.ply"))[0], "--attitudes", "upright", "--practice-rooms", 6, store="mesh.store")

    def take_store(self):
        scene = sorted((self.work / "takes/test").iterdir())[0]
        return self.teach("show", "--source", f"bop:{scene}", "--name", "shown", "--go-on", store="take.store")

    def detections(self):
        frames, out = self.fresh("frames.lcmlog"), self.fresh("detections.lcmlog")
        self.call("hs-capture", "--source", f"bop:{self.work}/scene", "--rate", 30, "--log", frames)
        self.call("hs-detect", "--forest", self.work / "realtime.forest", "--candidates", 0.01, "--keep-frames", "--threads", THREADS,
                  "-l", f"file://{frames}", "--output-log", out)  # fmt: skip
        return digest_log(out)

    def poses(self, name, *words):
        out = self.fresh(f"{name}.lcmlog")
        self.call("hs-pose", "--models", self.work / "views/models", "--threads", THREADS, "--keep-frames", *words, "-l",
                  f"file://{self.work}/detections.lcmlog", "--output-log", out)  # fmt: skip
        return digest_log(out)

    def objects(self):
        out = self.fresh("objects.lcmlog")
        self.call("hs-track", "--models", self.work / "views/models", "--camera-pose", "OPENNI_FRAME=0,0,0,1,0,0,0",
                  "-l", f"file://{self.work}/poses.lcmlog", "--output-log", out)  # fmt: skip
        return digest_log(out)

    def fused(self):
        out = self.fresh("fused")
        self.call("hs-fuse", "--views", f"bop:{self.work}/views", "--threads", THREADS, "--out", out)
        return digest_folder(out, self.work)

    def evaluated(self, program, forest, *words):
        out = self.fresh(f"evaluated_{forest}")
        self.call(*program, "--scene", self.work / "scene", "--forest", self.work / f"{forest}.forest", "--models",
                  self.work / "views/models", "--threads", THREADS, "--threshold", 0, *words, "--out", out)  # fmt: skip
        return digest_folder(out, self.work, {".json", ".csv"})

    def benched(self):
        out = self.fresh("benched")
        self.call("hs-study", "pose", "--forest", self.work / "realtime.forest", "--models", self.work / "views/models", "--scene",
                  self.work / "scene", "--every", 3, "--no-rivals", "--threads", THREADS, "--out", out)  # fmt: skip
        return digest_folder(out, self.work, {".json", ".csv"})


def read_options():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=pathlib.Path, help="folder of the programs that were built")
    parser.add_argument("--work", type=pathlib.Path, default=pathlib.Path("out/same"), help="what is made lies there (default: %(default)s)")
    parser.add_argument("--only", default="", metavar="WORD", help="the parts whose names hold it; the others' products must lie in --work")
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--write", type=pathlib.Path, metavar="FILE", help="writes the digests down")
    what.add_argument("--compare", type=pathlib.Path, metavar="FILE", help="compares them with those that were written down")
    options = parser.parse_args()
    options.programs, options.work = options.programs.resolve(), options.work.resolve()
    options.work.mkdir(parents=True, exist_ok=True)
    sys.path[:0] = [str(options.programs.parent / "python")]
    return options


def main():
    options = read_options()
    before = json.loads(options.compare.read_text()) if options.compare else {}
    digests, differing = {}, []
    for name, make in Results(options.programs, options.work).parts():
        if options.only not in name:
            continue
        try:
            digests[name] = make()
        except subprocess.CalledProcessError as error:
            sys.exit(f"{name}: {pathlib.Path(error.cmd[0]).name} ended with status {error.returncode}; its words are in {options.work}/same_results.log")
        same = not options.compare or digests[name] == before.get(name)
        print(f"{digests[name][:16]} {'' if same else 'DIFFERS '}{name}", flush=True)
        if not same:
            differing.append(name)
    if options.write:
        options.write.write_text(json.dumps(digests, indent=1) + "\n")
    if differing:
        sys.exit(f"{options.compare}: {len(differing)} of {len(digests)} results differ: {', '.join(differing)}")


if __name__ == "__main__":
    main()
