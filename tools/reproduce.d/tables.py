"""The tables of the report beside the figures of the paper."""

import paper
from arithmetic import mean_of, relative
from figures import DETECTORS, FEATURE_NAMES
from html_parts import show, table
from variants import FEATURE_SCENE, SCENES, forest_of
from words import milliseconds, percent

TIME_NAMES = {
    "original": "original: RGB, five scales, one thread",
    "half_size": "image at half size (5.1.1)",
    "depth_normalisation": "depth normalisation (5.1.2)",
    "stride_2": "stride 2, whole pipeline (5.1.3)",
    "all_threads": "all threads (5.2.2; the paper used five)",
    "fast_engine": "original, fast engine, all threads",
    "final": "profile paper, fast engine, all threads",
    "realtime": "profile realtime, all threads",
}


def features(results):
    baseline = results.auc("gall", FEATURE_SCENE)
    rows = []
    for feature in (feature for feature in FEATURE_NAMES if feature not in results.left_out):
        name = FEATURE_NAMES[feature]
        ours = results.auc(forest_of(feature), FEATURE_SCENE)
        stated = paper.FEATURES.get(feature, {})
        here = (show(ours), percent(relative(ours, baseline)))
        rows.append((name, *here, show(stated.get("auc")), percent(stated.get("gain"))))
    return table(("features", "AUC here", "gain here", "AUC, paper", "gain, paper"), rows)


def depth_normalisation(summary):
    rows = []
    for scene, found in summary["depth_normalisation"].items():
        in_paper = percent(paper.NORMALISATION_GAIN_DESK_2) if scene == "desk_2" else ""
        auc = (show(found[what]) for what in ("five", "single", "normalised"))
        rows.append((scene, *auc, percent(found["gain"]), in_paper, percent(found["time_change"])))
    return table(("scene", "five scales", "single", "normalised", "gain", "gain, paper", "time, all threads"), rows)


def strides(summary):
    rows = []
    for row in summary["stride"]:
        auc, time = percent(row["auc_change"]), percent(row["time_change"])
        rows.append((row["stride"], show(row["auc"]), auc, show(row["ms"], "{:.1f}"), time))
    return table(("stride", "AUC", "change", "ms", "change"), rows)


def final(summary):
    rows = []
    for what, (name, _) in DETECTORS.items():
        by_scene = summary["auc_" + what] if what.startswith("linemod") else summary["auc"][what]
        values = [by_scene[scene] for scene in SCENES]
        rows.append((name, *(show(value) for value in values), show(mean_of(values))))
    return table(("AUC", *SCENES, "mean"), rows)


def timings(summary):
    rows = []
    for name, words in TIME_NAMES.items():
        found = summary["time"][name]
        in_paper = f"{paper.SECONDS[name]:.0f} s" if name in paper.SECONDS else ""
        saved = percent(found["paper"]) if found["paper"] else ""
        rows.append((words, milliseconds(found["ms"]), percent(found["change"]), in_paper, saved))
    return table(("one frame", "here", "change", "paper", "change, paper"), rows)
