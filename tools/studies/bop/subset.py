"""Writes a scene of a BOP set that holds the chosen images and the known objects only; images are links.

Usage: subset.py --scene FOLDER --out FOLDER --names 2=cracker,5=mustard [--every N] [--targets FILE] [--digest TEXT]"""

import argparse
import json
import pathlib

from studies.unit_runner import UnitFailed

IMAGES = ("rgb", "depth", "mask_visib")
FILES = ("scene_camera.json", "scene_gt.json", "scene_gt_info.json")
IGNORED = 0.0  # visible fraction of what is there but is no target: neither missed nor false


class BadSet(UnitFailed):
    """One line that names the file, what it says, and what was expected."""


def read(file):
    try:
        return json.loads(pathlib.Path(file).read_text())
    except FileNotFoundError:
        raise BadSet(f"{file}: not there, expected as in BOP's format") from None
    except (OSError, ValueError) as error:
        raise BadSet(f"{file}: {error}") from None


def read_targets(file):
    """{scene id: {image id: {object id: count}}} of a test_targets_bop19.json."""
    found = {}
    entries = read(file)
    if not isinstance(entries, list) or not entries:
        raise BadSet(f"{file}: no list of targets, expected scene_id, im_id, obj_id, inst_count of each")
    for number, entry in enumerate(entries):
        try:
            scene, image, name, count = (int(entry[key]) for key in ("scene_id", "im_id", "obj_id", "inst_count"))
        except (KeyError, TypeError, ValueError):
            raise BadSet(
                f"{file}: entry {number} is {json.dumps(entry)}, expected scene_id, im_id, obj_id, inst_count"
            ) from None
        found.setdefault(scene, {}).setdefault(image, {})[name] = count
    return found


def chosen_images(scene, targets, every):
    """Ids of every Nth image: of those that `targets` ({image id: ...}) name, or of all where it is None."""
    there = sorted(int(key) for key in read(scene / "scene_camera.json"))
    if not there:
        raise BadSet(f"{scene / 'scene_camera.json'}: no images")
    if targets is None:
        return there[::every]
    missing = sorted(set(targets) - set(there))
    if missing:
        raise BadSet(
            f"{scene}: image {missing[0]} is not there, expected it as the targets name it ({len(missing)} such)"
        )
    return sorted(targets)[::every]


def missing_image(scene, images):
    """The first file that an image lacks, or None."""
    for image in images:
        if not any((scene / "rgb" / f"{image:06}.{ending}").exists() for ending in ("png", "jpg")):
            return scene / "rgb" / f"{image:06}.png"
        depth = scene / "depth" / f"{image:06}.png"
        if not depth.exists():
            return depth
    return None


def only_targets(truth, infos, wanted):
    """The infos with what is no target marked as ignored: of each object the `wanted` number most visible ones count."""
    left = dict(wanted)
    order = sorted(range(len(truth)), key=lambda i: -infos[i]["visib_fract"])
    out = [dict(info) for info in infos]
    for i in order:
        name = truth[i]["obj_id"]
        if left.get(name, 0) > 0:
            left[name] -= 1
        else:
            out[i]["visib_fract"] = IGNORED
    return out


def choose(scene, images, names, targets=None):
    """The contents of the three files, by name. `names`: of the known objects by id."""
    camera, gt, info = (read(scene / file) for file in FILES)
    out = {file: {} for file in FILES}
    for image in images:
        key = str(image)
        truth, infos = gt.get(key, []), info.get(key, [])
        if len(truth) != len(infos):
            raise BadSet(
                f"{scene / FILES[2]}: image {key} has {len(infos)} entries, expected {len(truth)} as in {FILES[1]}"
            )
        if targets is not None:
            infos = only_targets(truth, infos, targets[image])
        known = [i for i, entry in enumerate(truth) if entry["obj_id"] in names]
        out[FILES[0]][key] = camera[key]
        out[FILES[1]][key] = [truth[i] for i in known]
        out[FILES[2]][key] = [infos[i] for i in known]
    return out


def write(out, scene, contents, names, digest):
    out.mkdir(parents=True)
    for file, content in contents.items():
        (out / file).write_text(json.dumps(content) + "\n")
    (out / "names.json").write_text(json.dumps({str(key): name for key, name in names.items()}) + "\n")
    (out / "source.json").write_text(json.dumps({"scene": str(scene), "digest": digest}) + "\n")
    for name in IMAGES:
        if (scene / name).is_dir():
            (out / name).symlink_to(scene.resolve() / name)


def names_of(text):
    pairs = [pair.split("=", 1) for pair in text.split(",")] if text else []
    return {int(key): name for key, name in pairs}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scene", type=pathlib.Path, required=True)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--names", type=names_of, required=True)
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--targets", type=pathlib.Path)
    parser.add_argument("--digest", default="")
    options = parser.parse_args()
    try:
        targets = read_targets(options.targets)[int(options.scene.name)] if options.targets else None
        images = chosen_images(options.scene, targets, options.every)
        contents = choose(options.scene, images, options.names, targets)
    except BadSet as error:
        parser.exit(1, f"{error}\n")
    write(options.out, options.scene, contents, options.names, options.digest)


if __name__ == "__main__":
    main()
