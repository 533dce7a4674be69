"""The tables of the report that the paper has no figure for."""

from html_parts import show, table
from variants import SCENES
from words import milliseconds

WORST = 8


def twenty(summary):
    found = summary["objects_20"]
    rows = [
        ("time of a frame, four objects taught", milliseconds(found["ms_4"])),
        ("time of a frame, twenty objects taught", milliseconds(found["ms_20"])),
        ("ratio (five times the objects)", show(found["time_ratio"], "{:.2f}")),
        ("mean AUC of the twenty", show(found["auc_mean"])),
        ("mean AUC of four, taught alone", show(found["auc_mean_of_four"])),
        ("mean AUC of these four among the twenty", show(found["auc_same_four"])),
    ]
    return table(("", ""), rows)


def real(summary):
    found = summary["real"]
    rows = [
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
    return table(("", "AUC"), rows)


def reliability(found):
    rows = [
        (f"{row['score']:.2f}", row["count"], f"{row['share_true']:.2f}", f"{row['low']:.2f} to {row['high']:.2f}")
        for row in found["bins"]
    ]
    rows.append(("mean error, weighted", "", show(found["calibration_error"]), ""))
    return table(("mean score", "detections", "true", "95 % interval"), rows)


def failures(results):
    found = []
    for scene in SCENES:
        for name in results.objects("realtime", scene):
            facts = {"what": "realtime", "scene": scene, "object": name}
            found.append(
                (
                    results.mean("auc", **facts),
                    scene,
                    name,
                    *(results.mean(metric, **facts) for metric in ("recall", "precision", "required")),
                )
            )
    rows = [
        (scene, name, show(auc), show(recall), show(precision), show(count, "{:.0f}"))
        for auc, scene, name, recall, precision, count in sorted(found, key=lambda row: row[0])[:WORST]
    ]
    return table(("scene", "object", "AUC", "recall", "precision", "times there"), rows) if rows else ""
