"""Writes a scene whose truth is that of taught models, which have frames of their own; images are links.

Usage: taught_truth.py --scene FOLDER --out FOLDER [--compared NAME=FILE ...]
FILE is compared.json of hs-study shown: its T_true_taught maps the taught frame into that of the true mesh. Objects
without one stay as they are, and are nobody's whose store does not know them."""

import argparse
import json
import pathlib

IMAGES = ("rgb", "depth", "mask_visib")


def product(a, b):
    return [sum(a[3 * i + k] * b[3 * k + j] for k in range(3)) for i in range(3) for j in range(3)]


def in_taught_frame(entry, rows):
    """The entry of scene_gt.json for the taught frame. `rows`: 3x4, row by row, metres."""
    rotation = [rows[4 * i + j] for i in range(3) for j in range(3)]
    shift_mm = [1e3 * rows[4 * i + 3] for i in range(3)]
    R, t = entry["cam_R_m2c"], entry["cam_t_m2c"]
    moved = [sum(R[3 * i + k] * shift_mm[k] for k in range(3)) + t[i] for i in range(3)]
    return {**entry, "cam_R_m2c": product(R, rotation), "cam_t_m2c": moved}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scene", type=pathlib.Path, required=True)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    parser.add_argument("--compared", action="append", default=[])
    options = parser.parse_args()
    frames = {}
    for pair in options.compared:
        name, _, file = pair.partition("=")
        frames[name] = json.loads(pathlib.Path(file).read_text())["T_true_taught"]
    names = json.loads((options.scene / "models" / "names.json").read_text())
    truth = json.loads((options.scene / "scene_gt.json").read_text())
    for entries in truth.values():
        for i, entry in enumerate(entries):
            rows = frames.get(names[str(entry["obj_id"])])
            entries[i] = in_taught_frame(entry, rows) if rows else entry
    options.out.mkdir(parents=True)
    (options.out / "scene_gt.json").write_text(json.dumps(truth) + "\n")
    (options.out / "names.json").write_text(json.dumps(names) + "\n")
    for name in ("scene_camera.json", "scene_gt_info.json"):
        (options.out / name).write_text((options.scene / name).read_text())
    for name in IMAGES:
        (options.out / name).symlink_to((options.scene / name).resolve())


if __name__ == "__main__":
    main()
