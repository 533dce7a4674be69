"""Stands in for the programs that tools/bench teach runs: writes at once what they would after minutes.

Run as one of the names below. TEACH_FAKE_LOG gets a line for each call. TEACH_FAKE_POOR names an object that hs-teach calls
poor, TEACH_FAKE_REFUSED one that it refuses, TEACH_FAKE_CRASHES one that it dies of."""

import json
import os
import pathlib
import sys

import fake_programs
from fake_programs import value_of, write_json

NAMES = ("hs-render", "hs-teach", "hs-evaluate", "hs-capture", "hs-study")
IDS = {"bowl": 1, "cereal_box": 2, "coffee_mug": 3}
IMAGE = bytes.fromhex(
    "89504e470d0a1a0a0000000d49484452000000010000000108060000001f15c4890000000d49444154789c6360f8cf500f0003860180"
    "5a347d6b0000000049454e44ae426082"
)
MOVED = [1, 0, 0, 0.01, 0, 1, 0, 0.02, 0, 0, 1, 0.03]  # T_true_taught


def write_names(folder):
    write_json(folder / "models" / "names.json", {str(number): name for name, number in IDS.items()})


def render(words, out):
    write_names(out)
    if words[0] == "takes":
        write_json(out / "takes.json", [])
        return
    entry = {"obj_id": 2, "cam_R_m2c": [0, -1, 0, 1, 0, 0, 0, 0, 1], "cam_t_m2c": [0, 0, 1000]}
    write_json(out / "scene_gt.json", {"0": [entry, {**entry, "obj_id": 3}]})
    write_json(out / "scene_gt_info.json", {"0": []})
    write_json(out / "scene_camera.json", {"0": {}})
    for name in ("rgb", "depth", "mask_visib"):
        (out / name).mkdir()


def known(store):
    return json.loads((store / "store.json").read_text())["objects"] if (store / "store.json").is_file() else []


def keep(folder, name, verdict):
    write_json(folder / "report.json", {
        "name": name, "verdict": verdict, "reasons": [] if verdict == "good" else ["too short: 90 degrees"],
        "seen_share": 0.6, "tracking_hz": 40.0, "drift_mm": 1.0, "drift_deg": 0.2,
    })  # fmt: skip
    (folder / "model.ply").write_text("ply")
    (folder / "contact_sheet.jpg").write_bytes(IMAGE)


def teach(words, out):
    """`mesh` teaches the objects in order."""
    objects = known(out)
    name = value_of(words, "--name") if words[0] == "show" else f"mesh_{len(objects)}"
    if name == os.environ.get("TEACH_FAKE_CRASHES"):
        os.abort()
    if name == os.environ.get("TEACH_FAKE_REFUSED"):
        print("the words of a table")
        sys.exit("hs-teach: bop:x: no plane, expected a table")
    poor = name == os.environ.get("TEACH_FAKE_POOR")
    if words[0] == "show":
        keep(pathlib.Path(value_of(words, "--keep")), name, "poor" if poor else "good")
    if poor:
        sys.exit(3)
    if objects and "--add" not in words:
        sys.exit("hs-teach: the store is there, and --add is not")
    write_json(out / "store.json", {"objects": [*objects, name]})


def compare(words, out):
    figures = {"mesh_mm_median": 0.8, "mesh_mm_95": 3.0, "seen_mm_median": 0.9, "seen_mm_95": 3.1, "missing_share": 0.01,
               "seen_surface": 0.9, "drift_mm": 2.0, "drift_deg": 0.5, "tracking_mm_median": 1.0, "tracking_mm_95": 2.0,
               "tracking_deg_95": 0.4, "tracked": 240, "second_mm": None, "second_deg": None, "mask_iou": 0.95,
               "least_mask_iou": 0.9, "views": 40, "T_true_taught": MOVED}  # fmt: skip
    if value_of(words, "--object") == os.environ.get("TEACH_FAKE_POOR"):
        figures |= {"mesh_mm_median": 9.0}
    write_json(out / "compared.json", figures)
    for name in ("taught", "true"):
        (out / f"{name}.png").write_bytes(IMAGE)


def evaluate(words, out):
    names = known(pathlib.Path(value_of(words, "--objects")))
    if names[0].startswith("mesh_"):
        names = list(IDS)[1:]
    write_json(out / "summary.json", {
        "auc": {**{name: 0.9 for name in names}, "mean": 0.9}, "pose_recall_add_s_10": {name: 0.8 for name in names},
    })  # fmt: skip


def stand_in(name, words):
    if name == "hs-study":
        name, words = f"hs-study {words[0]}", words[1:]
    with open(os.environ["TEACH_FAKE_LOG"], "a") as log:
        log.write(" ".join([name, *words]) + "\n")
    out = pathlib.Path(value_of(words, "--out"))
    {"hs-render": render, "hs-teach": teach, "hs-study shown": compare, "hs-evaluate": evaluate}[name](words, out)


def install(folder):
    fake_programs.install(folder, NAMES, __file__)


if __name__ == "__main__":
    stand_in(sys.argv[1], sys.argv[2:])
