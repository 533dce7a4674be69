"""Packs what houghstream-demo shows without teaching anything: forest and models of the four objects that tools/demo has taught,
and ten seconds of its scene as an LCM log. The target `samples` of the build does it; by itself:

    cd tools && PYTHONPATH=../build/python python3 -m studies.demo.samples --data ../out/demo/data --out ../build/samples

The log has every second image of the scene, 15 a second, with colour of JPEG quality 85 and depth zipped as small as zlib makes it: the
forest is a quarter of the package, and all of it stays below 40 MB."""

import argparse
import os
import pathlib
import shutil

from studies.command import call, die, know_messages
from studies.records import about, read_json, write_json

CAMERA_HZ, EVERY, SECONDS = 30, 2, 10
JPEG_QUALITY, ZIP_LEVEL = 85, 9
LARGEST_MB = 60  # unpacked; the package is smaller, as the forest is compressed in it


def thin(scene, folder, every, most):
    """Makes a scene in BOP format of every n-th image of another one, at most so many; its images are links. Returns how many."""
    kept = sorted(read_json(scene / "scene_gt.json"), key=int)[::every][:most]
    folder.mkdir()
    for file in ("scene_camera.json", "scene_gt.json", "scene_gt_info.json"):
        of_images = read_json(scene / file)
        write_json(folder / file, {image: of_images[image] for image in kept})
    for kind in ("rgb", "depth"):
        (folder / kind).mkdir()
        for image in kept:
            name = f"{int(image):06d}.png"
            (folder / kind / name).symlink_to(scene / kind / name)
    return len(kept)


def size_mb(folder):
    return sum(file.stat().st_size for file in folder.rglob("*") if file.is_file()) / 1e6


def require_data(data):
    for name in ("forest", "training/models/names.json", "scene/scene_gt.json"):
        if not (data / name).exists():
            die(f"{data / name}: not there, expected what tools/demo makes")


def pack(programs, data, out):
    """Makes the folder anew, as a whole or not at all."""
    require_data(data)
    part = out.with_name(out.name + ".part")
    shutil.rmtree(part, ignore_errors=True)
    part.mkdir(parents=True)
    shutil.copyfile(data / "forest", part / "forest")
    shutil.copytree(data / "training/models", part / "models")
    rate = CAMERA_HZ // EVERY
    frames = thin(data / "scene", part / "scene", EVERY, rate * SECONDS)
    call(programs / "hs-capture", "--source", f"bop:{part / 'scene'}", "--rate", rate, "--jpeg-quality", JPEG_QUALITY,
         "--zip-level", ZIP_LEVEL, "--log", part / "frames.lcmlog")  # fmt: skip
    shutil.rmtree(part / "scene")
    names = sorted(read_json(part / "models/names.json").values())
    write_json(part / "samples.json", {"objects": names, "frames": frames, "seconds": frames / rate, **about("samples")})
    if size_mb(part) > LARGEST_MB:
        die(f"{part}: {size_mb(part):.1f} MB, expected at most {LARGEST_MB}")
    shutil.rmtree(out, ignore_errors=True)
    os.replace(part, out)
    print(f"{out}: {', '.join(names)}; {frames} frames; {size_mb(out):.1f} MB unpacked")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    for name, default in (("programs", "../build/bin"), ("data", "../out/demo/data"), ("out", "../build/samples")):
        parser.add_argument(f"--{name}", default=default, type=lambda text: pathlib.Path(text).resolve())
    options = parser.parse_args()
    know_messages(str(options.programs))
    pack(options.programs, options.data, options.out)


if __name__ == "__main__":
    main()
