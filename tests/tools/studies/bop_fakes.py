"""Stands in for the programs that tools/bench bop runs: writes at once what they would after minutes.

Run as one of the names below. BOP_FAKE_LOG gets a line for each call; hs-teach fails where BOP_FAKE_FAILS is set."""

import os
import pathlib
import sys

import fake_programs
from fake_programs import write_json

NAMES = ("hs-teach", "hs-evaluate", "hs-study")
# By scene: of object_2 (score, is true), how many there are, and what the poses came to.
SCENES = {
    "000001": {"judged": [(0.9, True), (0.8, False)], "required": 1, "ar": 0.9, "targets": 1, "ms": [4.0]},
    "000050": {
        "judged": [(0.95, True), (0.85, True), (0.7, True)], "required": 4, "ar": 0.5, "targets": 4, "ms": [8.0, 20.0],
    },
}  # fmt: skip
IMAGE = bytes.fromhex(
    "89504e470d0a1a0a0000000d49484452000000010000000108060000001f15c4890000000d49444154789c6360f8cf500f0003860180"
    "5a347d6b0000000049454e44ae426082"
)


def bins(score, fraction, count):
    return {"bins": [{"from": 0.5, "to": 1.0, "count": count, "mean_score": score, "true_fraction": fraction}]}


def recall(value, targets):
    every = {key: {"all": value} for key in ("ar", "ar_vsd", "ar_mssd", "ar_mspd")}
    return {**every, "targets": {"all": targets}}


def write_evaluation(folder, scene, least=0.0):
    facts = SCENES[scene]
    judged = [pair for pair in facts["judged"] if pair[0] >= least]
    folder.mkdir(parents=True)
    true, lines = 0, ["object,score,precision,recall"]
    for rank, (score, is_true) in enumerate(judged, 1):
        true += is_true
        lines.append(f"object_2,{score},{true / rank:.6f},{true / facts['required']:.6f}")
    (folder / "curves.csv").write_text("\n".join(lines) + "\n")
    times = [f"{scene},{i},{ms},,1,0" for i, ms in enumerate(facts["ms"])]
    (folder / "frames.csv").write_text("\n".join(["scene,image_id,detect_ms,pose_ms,detections,poses", *times]) + "\n")
    row = f"{int(scene)},1,2,0.9,1 0 0 0 1 0 0 0 1,0 0 1000,0.02"
    (folder / "bop_results.csv").write_text(f"scene_id,im_id,obj_id,score,R,t,time\n{row}\n")
    write_json(folder / "summary.json", {
        "frames": len(facts["ms"]), "required": {"object_2": facts["required"], "object_3": 0},
        "operating": {"true": true, "confirmed": {"true": 0, "false": 0}},
        "false_detections": sum(not is_true for score, is_true in judged), "bop19": recall(facts["ar"], facts["targets"]),
        "bop19_nothing_withheld": recall(1.0, facts["targets"]), "published": true, "published_right_fraction": 0.5,
        "published_good_fraction": 1.0,
        "detection_calibration": {"ece": 0.5, **bins(0.8, 0.3 if scene == "000001" else 0.9, facts["required"])},
        "pose_calibration": {"ece": 0.5, **bins(0.9, 0.9, true)},
        "pose_calibration_up_to_shape": {"ece": 0.5, **bins(0.9, 1.0, true)}, "linemod": {"frames": 1},
    })  # fmt: skip


def stand_in(name, words):
    """Writes what a program writes, at once; a line for each call goes into the file that BOP_FAKE_LOG names."""
    if name == "hs-study":
        name, words = f"hs-study {words[0]}", words[1:]
    with open(os.environ["BOP_FAKE_LOG"], "a") as log:
        log.write(" ".join([name, *words]) + "\n")
    out = pathlib.Path(words[words.index("--out") + 1])
    scenes = [pathlib.Path(word) for before, word in zip(words, words[1:]) if before == "--scene"]
    if name == "hs-teach":
        if os.environ.get("BOP_FAKE_FAILS"):
            sys.exit("hs-teach: obj_000002.ply: no faces")
        write_json(out / "store.json", {"houghstream_store": 1, "objects": [{"id": 2, "name": "object_2"}]})
        (out / "forest").write_text(" ".join(words))
        pathlib.Path(words[words.index("--dump-views") + 1]).mkdir()
    elif name == "hs-evaluate":
        write_evaluation(out, scenes[0].name, 0.0 if "--threshold" in words else 0.75)
    elif name == "hs-study linemod":
        for scene in scenes:
            write_evaluation(out / scene.name, scene.name, 0.9)
    elif name == "hs-study failures":
        out.write_bytes(IMAGE)
    elif name == "hs-study pose":
        facts = SCENES[scenes[0].name]
        rivals = {} if "--no-rivals" in words else {
            name: {"bop_ar": value, "bop_targets": facts["targets"]}
            for name, value in (("unchecked", 1.0), ("prerejective", facts["ar"] / 2), ("ppf", facts["ar"] / 3))
        }  # fmt: skip
        write_json(out / "results.json", {"on_rival_frames": rivals, "rival_frames": len(rivals) and 1})
        (out / "worst_1.png").write_bytes(IMAGE)


def install(folder):
    fake_programs.install(folder, NAMES, __file__)


if __name__ == "__main__":
    stand_in(sys.argv[1], sys.argv[2:])
