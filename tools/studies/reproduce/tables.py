"""The tables of the report, each a list of rows with its header first."""

from studies.records import mean_of, relative
from studies.report.page import milliseconds, percent, show
from studies.reproduce import paper
from studies.reproduce.variants import (
    DETECTOR_NAMES,
    FEATURE_NAMES,
    FEATURE_SCENE,
    OTHER_SENSOR,
    SCENES,
    TIMINGS,
    forest_of,
)

WORST = 8  # failures


def quality_rows(summary):
    baseline, final = (summary["auc"][what][FEATURE_SCENE] for what in ("intensity", "final"))
    stated = paper.FEATURES["final"]
    desk = summary["depth_normalisation"]["desk_2"]
    rows = [
        (f"AUC with RGB features, {FEATURE_SCENE}", show(paper.BASELINE_AUC), show(baseline)),
        (f"AUC with the final features, {FEATURE_SCENE}", show(stated["auc"]), show(final)),
        ("gain of the final features", percent(stated["gain"]), percent(relative(final, baseline))),
    ]
    if "final_depth_by_pixel" in summary["auc"]:  # not in a quick run
        by_pixel = summary["auc"]["final_depth_by_pixel"][FEATURE_SCENE]
        rows.append(("AUC where tests on depth look at one pixel", "", show(by_pixel)))
        rows.append(("gain where tests on depth look at one pixel", "", percent(relative(by_pixel, baseline))))
    normalised = (
        "gain of depth normalisation, desk_2",
        percent(paper.NORMALISATION_GAIN_DESK_2),
        percent(desk["gain"]),
    )
    return [*rows, normalised]


def stride_rows(summary):
    found = next(row for row in summary["stride"] if row["stride"] == 2)
    return [
        ("stride 2: time from classification on", percent(paper.STRIDE_2["time"]), percent(found["time_change"])),
        ("stride 2: AUC", percent(paper.STRIDE_2["auc"]), percent(found["auc_change"])),
    ]


def time_rows(summary):
    time = summary["time"]
    savings = {"depth_normalisation": "depth normalisation: time", "half_size": "half the image's size: time"}
    rows = [(words, percent(time[name]["paper"]), percent(time[name]["change"])) for name, words in savings.items()]
    for name, words in (("original", "one frame, original"), ("final", "one frame, final version")):
        rows.append((words, f"{paper.SECONDS[name]:.0f} s", milliseconds(time[name]["ms"])))
    return rows + [("one frame, realtime profile", "", milliseconds(time["realtime"]["ms"])), *gain_rows(summary)]


def gain_rows(summary):
    gain = summary["gain_over_original"]
    same = "realtime against the original, same fast engine, one thread each"
    whole = (
        "realtime (fast engine, all threads) against the original as it was (reference engine, one thread), all maxima ranked"
    )
    rows = ((same, gain["same_engine_one_thread"]), (whole, gain["whole_system"]))
    return [(words, "", "–" if value is None else f"{value:.0f} times as fast") for words, value in rows]


def final_rows(summary):
    auc = {"LINEMOD with depth check": summary["auc_linemod"], "the original (gall)": summary["auc"]["gall"]}
    auc |= {"the final version (paper)": summary["auc"]["paper"], "the realtime profile": summary["auc"]["realtime"]}
    return [
        (f"AUC over six scenes, {name}", "curves only", show(mean_of(found.values()))) for name, found in auc.items()
    ]


def glance(summary):
    """Returns what the paper says and what was measured here."""
    return [
        ("", "paper", "here"),
        *quality_rows(summary),
        *stride_rows(summary),
        *time_rows(summary),
        *final_rows(summary),
    ]


def feature_rows(summary, left_out):
    baseline = summary["auc"]["gall"][FEATURE_SCENE]
    rows = [("features", "AUC here", "gain here", "AUC, paper", "gain, paper")]
    for feature in (feature for feature in FEATURE_NAMES if feature not in left_out):
        ours = summary["auc"].get(feature, summary["auc"].get(forest_of(feature)))[FEATURE_SCENE]
        stated = paper.FEATURES.get(feature, {})
        in_paper = (show(stated["auc"]) if "auc" in stated else "", percent(stated["gain"]) if "gain" in stated else "")
        rows.append((FEATURE_NAMES[feature], show(ours), percent(relative(ours, baseline)), *in_paper))
    return rows


def depth_normalisation(summary):
    rows = [("scene", "five scales", "single", "normalised", "gain", "gain, paper", "time, all threads")]
    for scene, found in summary["depth_normalisation"].items():
        in_paper = percent(paper.NORMALISATION_GAIN_DESK_2) if scene == "desk_2" else ""
        auc = (show(found[what]) for what in ("five", "single", "normalised"))
        rows.append((scene, *auc, percent(found["gain"]), in_paper, percent(found["time_change"])))
    return rows


def strides(summary):
    rows = [("stride", "AUC", "change", "ms", "change")]
    for row in summary["stride"]:
        auc, time = percent(row["auc_change"]), percent(row["time_change"])
        rows.append((row["stride"], show(row["auc"]), auc, show(row["ms"], "{:.1f}"), time))
    return rows


def final(summary):
    rows = [("AUC", *SCENES, "mean")]
    for what, name in DETECTOR_NAMES.items():
        by_scene = summary["auc_" + what] if what.startswith("linemod") else summary["auc"][what]
        values = [by_scene[scene] for scene in SCENES]
        rows.append((name, *(show(value) for value in values), show(mean_of(values))))
    return rows


def timings(summary):
    rows = [("one frame", "here", "change", "paper", "change, paper")]
    for name, timing in TIMINGS.items():
        found = summary["time"][name]
        in_paper = f"{paper.SECONDS[name]:.0f} s" if name in paper.SECONDS else ""
        saved = percent(found["paper"]) if found["paper"] else ""
        rows.append((timing.words, milliseconds(found["ms"]), percent(found["change"]), in_paper, saved))
    return rows


def twenty(summary):
    found = summary["objects_20"]
    return [
        ("", ""),
        ("time of a frame, four objects taught", milliseconds(found["ms_4"])),
        ("time of a frame, twenty objects taught", milliseconds(found["ms_20"])),
        ("ratio (five times the objects)", show(found["time_ratio"], "{:.2f}")),
        ("mean AUC of the twenty", show(found["auc_mean"])),
        ("mean AUC of four, taught alone", show(found["auc_mean_of_four"])),
        ("mean AUC of these four among the twenty", show(found["auc_same_four"])),
    ]


def other_sensor(summary):
    rows = [("AUC of realtime", "structured light, as taught", "time of flight", "change")]
    for scene, found in summary["other_sensor"].items():
        usual, other = found["structured_light"], found[OTHER_SENSOR]
        rows.append((scene, show(usual), show(other), percent(relative(other, usual))))
    return rows


def real(summary):
    found = summary["real"]
    return [
        ("", "AUC"),
        ("realtime", show(found["auc_mean"])),
        ("realtime, weighted by objects", show(found["auc_weighted"])),
        ("paper", show(found["auc_paper_mean"])),
        ("gall", show(found["auc_gall_mean"])),
        ("LINEMOD with depth check", show(found["auc_linemod_mean"])),
        ("LINEMOD without it", show(found["auc_linemod_no_check_mean"])),
        (
            "false detections of realtime a frame of clutter, default threshold",
            show(found["false_per_clutter_frame"], "{:.2f}"),
        ),
    ]


def reliability(found):
    rows = [("mean score", "detections", "true", "95 % interval")]
    for row in found["bins"]:
        interval = f"{row['low']:.2f} to {row['high']:.2f}"
        rows.append((f"{row['score']:.2f}", row["count"], f"{row['share_true']:.2f}", interval))
    return [*rows, ("mean error, weighted", "", show(found["calibration_error"]), "")]


def failures(results):
    """The objects that realtime finds worst; no rows where nothing is measured."""
    metrics = ("recall", "precision", "required")
    found = []
    for scene in SCENES:
        for name in results.objects("realtime", scene):
            facts = {"what": "realtime", "scene": scene, "object": name}
            found.append(
                (results.mean("auc", **facts), scene, name, *(results.mean(metric, **facts) for metric in metrics))
            )
    rows = [
        (scene, name, show(auc), show(recall), show(precision), show(count, "{:.0f}"))
        for auc, scene, name, recall, precision, count in sorted(found, key=lambda row: row[0])[:WORST]
    ]
    return [("scene", "object", "AUC", "recall", "precision", "times there"), *rows] if rows else []
