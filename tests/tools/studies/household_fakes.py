"""Stands in for the programs that tools/bench household runs: writes at once what they would after hours.

Run as one of the names below. HOUSEHOLD_FAKE_LOG gets a line for each call. An object is found with an area of 0.9 in a store of
at most seven, less 0.01 for each further one."""

import json
import os
import pathlib
import sys

import fake_programs
from fake_programs import value_of, write_json

NAMES = ("hs-teach", "hs-evaluate", "hs-capture", "hs-detect", "hs-pose", "hs-study")
FRAMES = 2  # of a room


def values_of(words, option):
    return [word for before, word in zip(words, words[1:]) if before == option]


def known(store):
    return json.loads((pathlib.Path(store) / "store.json").read_text())["objects"]


def write_store(folder, objects):
    write_json(folder / "store.json", {"houghstream_store": 1, "objects": objects})
    (folder / "forest").write_bytes(b"0" * 1_000_000 * len(objects))


def teach(words, out):
    if words[0] == "merge":
        stores = words[1 : words.index("--out")]
        write_store(out, [entry for store in stores for entry in known(store)])
        return
    names = json.loads((pathlib.Path(words[1]) / "names.json").read_text())
    taught = [{"id": int(one), "name": names[one]} for one in value_of(words, "--ids").split(",")]
    write_store(out, (known(out) if "--add" in words else []) + taught)


def render(words, out):
    if int(value_of(words, "--max-objects")) > len(value_of(words, "--ids").split(",")):
        sys.exit("hs-study household: too few objects")
    for room in range(1, int(value_of(words, "--rooms")) + 1):
        write_json(out / f"{room:06}" / "scene_gt.json", {str(frame): [] for frame in range(FRAMES)})


def bins(count, fraction):
    return [{"from": 0.0, "to": 0.5, "count": 0, "mean_score": None, "true_fraction": None},
            {"from": 0.5, "to": 1.0, "count": count, "mean_score": 0.9, "true_fraction": fraction}]  # fmt: skip


def calibration(ece, recall, of):
    proposed = [{"precision": 0.95, "score": 0.4, "recall": 1.0}, {"precision": 0.98, "score": 0.6, "recall": recall}]
    return {"ece": ece, "count": of, "bins": bins(of, 0.75), "proposed": proposed}


def evaluate(words, out):
    names = [entry["name"] for entry in known(value_of(words, "--objects"))]
    area = 0.9 - 0.01 * max(0, len(names) - 7)
    there = {name: 0 if name == "name_3" else 4 for name in names}
    required = sum(there.values())
    every = {name: area if count else None for name, count in there.items()}
    rates = {name: 0.5 if count else None for name, count in there.items()}
    write_json(out / "summary.json", {
        "required": there, "auc": every | {"mean": area, "weighted": area}, "recall": rates, "precision": rates,
        "operating": {"recall": 0.5, "precision": 0.9}, "published": required // 2, "published_right_fraction": 0.5, "published_good_fraction": 0.75,
        "detection_calibration": calibration(0.1, 0.4, required), "pose_calibration": calibration(0.2, 0.5, required),
        "bop19": {"ar": {"all": 0.6} | rates, "targets": {"all": required}},
    })  # fmt: skip
    scenes = values_of(words, "--scene")
    rows = [f"{pathlib.Path(scene).name},{frame},{10 + len(names) + frame},{20 if frame else ''},1,1"
            for scene in scenes for frame in range(FRAMES)]  # fmt: skip
    (out / "frames.csv").write_text("\n".join(["scene,image_id,detect_ms,pose_ms,detections,poses", *rows]) + "\n")


def stand_in(name, words):
    """Writes what a program writes, at once."""
    with open(os.environ["HOUSEHOLD_FAKE_LOG"], "a") as log:
        log.write(" ".join([name, *words]) + "\n")
    if name in ("hs-capture", "hs-detect", "hs-pose"):
        pathlib.Path(value_of(words, "--log" if name == "hs-capture" else "--output-log")).write_bytes(b"log")
        return
    out = pathlib.Path(value_of(words, "--out"))
    out.mkdir(parents=True, exist_ok=True)
    {"hs-teach": teach, "hs-evaluate": evaluate, "hs-study": render}[name](words, out)


def install(folder):
    fake_programs.install(folder, NAMES, __file__)


if __name__ == "__main__":
    stand_in(sys.argv[1], sys.argv[2:])
