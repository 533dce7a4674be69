"""The comparison in one table: what the paper says and what was measured here."""

import paper
from arithmetic import mean_of, relative
from html_parts import show, table
from variants import FEATURE_SCENE
from words import milliseconds, percent


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
    normalised = ("gain of depth normalisation, desk_2", percent(paper.NORMALISATION_GAIN_DESK_2), percent(desk["gain"]))
    return [*rows, normalised]


def stride_rows(summary):
    found = next(row for row in summary["stride"] if row["stride"] == 2)
    return [
        ("stride 2: time of classification and voting", percent(paper.STRIDE_2["time"]), percent(found["time_change"])),
        ("stride 2: AUC", percent(paper.STRIDE_2["auc"]), percent(found["auc_change"])),
    ]


def time_rows(summary):
    time = summary["time"]
    savings = {"depth_normalisation": "depth normalisation: time", "half_size": "half the image's size: time"}
    rows = [(words, percent(time[name]["paper"]), percent(time[name]["change"])) for name, words in savings.items()]
    for name, words in (("original", "one frame, original"), ("final", "one frame, final version")):
        rows.append((words, f"{paper.SECONDS[name]:.0f} s", milliseconds(time[name]["ms"])))
    return rows + [("one frame, realtime profile", "", milliseconds(time["realtime"]["ms"]))]


def final_rows(summary):
    auc = {"LINEMOD with depth check": summary["auc_linemod"], "the original (gall)": summary["auc"]["gall"]}
    auc |= {"the final version (paper)": summary["auc"]["paper"], "the realtime profile": summary["auc"]["realtime"]}
    return [
        (f"AUC over six scenes, {name}", "curves only", show(mean_of(found.values()))) for name, found in auc.items()
    ]


def glance(summary):
    rows = quality_rows(summary) + stride_rows(summary) + time_rows(summary) + final_rows(summary)
    return table(("", "paper", "here"), rows)
