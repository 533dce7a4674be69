"""Stands in for the programs that tools/reproduce runs: writes at once what they would after hours.

Run as one of the names below. REPRODUCE_FAKE_LOG gets a line for each call; a call whose words contain
REPRODUCE_FAKE_FAILS fails, one whose words contain REPRODUCE_FAKE_SLEEPS hangs. Forests differ with
REPRODUCE_FAKE_DIFFERS."""

import base64
import json
import os
import pathlib
import random
import sys
import time

import fake_programs

NAMES = ("hs-render", "hs-import", "hs-log", "hs-train", "hs-evaluate", "hs-study")
OBJECTS = ("bowl", "cereal_box", "coffee_mug", "soda_can")
IMAGE = base64.b64decode(
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="
)
QUALITY = {
    "gall": 0.5,
    "depth_value": 0.65,
    "derivatives": 0.6,
    "hog": 0.7,
    "paper": 0.75,
    "realtime": 0.9,
    "linemod": 0.3,
}


def install(folder):
    fake_programs.install(folder, NAMES, __file__)


def option(words, name, default=""):
    return words[words.index(name) + 1] if name in words else default


def judged_curve(quality, required, chance):
    """(score, precision, recall) of detections that are true as often as their score says."""
    true, rows = 0, []
    for i in range(3 * required):
        score = 1.0 - (i + 0.5) / (3 * required)
        true += true < quality * required and chance.random() < 0.25 + 0.75 * score
        rows.append((score, true / (i + 1), true / required))
    return rows


def write_evaluation(folder, quality, times, chance):
    folder.mkdir(parents=True)
    auc, curves = {}, "object,score,precision,recall\n"
    for name in OBJECTS:
        rows = judged_curve(min(quality + chance.uniform(-0.08, 0.08), 1.0), 20, chance)
        auc[name] = sum(p * (r - before) for (_, p, r), before in zip(rows, [0.0] + [r for _, _, r in rows]))
        curves += "".join(f"{name},{s},{p:.6f},{r:.6f}\n" for s, p, r in rows)
    mean = sum(auc.values()) / len(auc)
    summary = {
        "frames": 20,
        "auc": {**auc, "mean": mean, "weighted": mean},
        "false_detections": 8,
        "false_per_frame": 0.4,
    }
    summary |= {
        "required": dict.fromkeys(OBJECTS, 20),
        "precision": dict.fromkeys(OBJECTS, 0.9),
        "recall": dict.fromkeys(OBJECTS, quality),
    }
    summary["stage_ms_median"] = times
    summary["bop19"] = {"ar": {"all": quality / 2}}
    (folder / "summary.json").write_text(json.dumps(summary))
    (folder / "curves.csv").write_text(curves)


def evaluate(words, out, chance):
    taught = pathlib.Path(option(words, "--forest")).read_text()
    slow = (
        (20.0 if "--reference" in words else 1.0)
        / float(option(words, "--stride", "2"))
        / (1 if "normalised" in taught else 4)
    )
    times = {
        "detect.features": 30.0,
        "detect.leaves": 400.0 * slow,
        "detect.votes": 300.0 * slow,
        "pose.registration": 20.0,
    }
    quality = max([value for name, value in QUALITY.items() if name in taught] or [0.5])
    write_evaluation(out, quality, times, chance)


def linemod(words, out, chance):
    for scene in (words[i + 1] for i, word in enumerate(words) if word == "--scene"):
        write_evaluation(out / pathlib.Path(scene).name, QUALITY["linemod"], {"detect.match": 900.0}, chance)
    print("train_seconds 3.5")


def bench_speed(words, out):
    """Twenty objects take half as long again as four."""
    names = [words[i + 1].split("=")[0] for i, word in enumerate(words) if word == "--detector"]
    out.write_text(json.dumps({name: {"ms": {"p50": 30.0 if "20" in name else 20.0}} for name in names}))


def run(name, words):
    if name == "hs-study":
        name, *words = words
    out = pathlib.Path(option(words, "--out", words[-1]))
    chance = random.Random(" ".join(words[1:-1]))
    if name in ("hs-train", "train"):
        out.write_text(" ".join(words) + os.environ.get("REPRODUCE_FAKE_DIFFERS", ""))
        print("train_seconds 101.5")
    elif name in ("hs-evaluate", "evaluate"):
        evaluate(words, out, chance)
    elif name == "linemod":
        linemod(words, out, chance)
    elif name == "speed":
        bench_speed(words, out)
    elif name in ("hough", "failures"):
        out.write_bytes(IMAGE)
    else:
        out.mkdir(parents=True)


def main():
    name, words = sys.argv[1], sys.argv[2:]
    call = " ".join([name, *words])
    with open(os.environ["REPRODUCE_FAKE_LOG"], "a") as log:
        log.write(call + "\n")
    for variable, act in (
        ("REPRODUCE_FAKE_FAILS", lambda: sys.exit("no such luck")),
        ("REPRODUCE_FAKE_SLEEPS", lambda: time.sleep(60)),
    ):
        if os.environ.get(variable) and os.environ[variable] in call:
            act()
    run(name, words)


if __name__ == "__main__":
    main()
