"""The figures of tools/bench pose: pose.json, and pose.html with the worst that was published."""

import json
import re

from studies.records import about, read_json, read_json_if_any, write_json
from studies.report.page import embedded, render, show

NAMES = {
    "ours": "ours",
    "pcl": "PCL's point-to-plane ICP from our starts, all else ours",
    "prerejective": "PCL: FPFH, prerejective RANSAC, ICP",
    "ppf": "OpenCV: point pair features, ICP",
    "unchecked": "ours, nothing withheld",
}
REAL = ("within_5mm_5deg", "frames", "with_pose", "median_mm", "median_deg")


def figure(group, variant, *keys):
    """Returns what a group of results.json says of a variant; None where it was not measured."""
    value = group.get(variant)
    for key in keys:
        value = None if value is None else value[key]
    return value


def summarise(results, real):
    """The figures by which runs are compared; `real` is poses.json of hs-study recorded, or None."""
    variants, beside_rivals = results["variants"], results["on_rival_frames"]
    return {
        "ms_per_pose_median": figure(variants, "ours", "ms_median"),
        "ms_per_pose_p99": figure(variants, "ours", "ms_p99"),
        "pcl_ms_median": figure(variants, "pcl", "ms_median"),
        "prerejective_ms_median": figure(beside_rivals, "prerejective", "ms_median"),
        "ppf_ms_median": figure(beside_rivals, "ppf", "ms_median"),
        "mssd_recall": figure(variants, "ours", "recall", "mssd"),
        "add_s_recall": figure(variants, "ours", "recall", "add_s"),
        "add_recall": figure(variants, "ours", "recall", "add"),
        "mssd_recall_from_0.5": figure(variants, "ours", "recall_from_0.5", "mssd"),
        "add_s_recall_from_0.5": figure(variants, "ours", "recall_from_0.5", "add_s"),
        "add_recall_from_0.5": figure(variants, "ours", "recall_from_0.5", "add"),
        "pcl_mssd_recall": figure(variants, "pcl", "recall", "mssd"),
        "pcl_add_s_recall": figure(variants, "pcl", "recall", "add_s"),
        "pcl_add_recall": figure(variants, "pcl", "recall", "add"),
        "bop_ar": figure(variants, "ours", "bop_ar"),
        "bop_ar_pcl": figure(variants, "pcl", "bop_ar"),
        "bop_ar_on_rival_frames": figure(beside_rivals, "ours", "bop_ar"),
        "bop_ar_prerejective": figure(beside_rivals, "prerejective", "bop_ar"),
        "bop_ar_ppf": figure(beside_rivals, "ppf", "bop_ar"),
        "published_right_fraction": figure(variants, "ours", "published_right_fraction"),
        "published_good_fraction": figure(variants, "ours", "published_good_fraction"),
        "translation_mm_median": figure(variants, "ours", "mm_median"),
        "translation_mm_median_at_1m": figure(variants, "ours", "mm_per_m_sq_median"),
        "rotation_deg_median": figure(variants, "ours", "deg_median"),
        "withheld": results["withheld"],
        "frames": results["frames"],
        "rival_frames": results["rival_frames"],
        "real": {key: None if real is None else real[key] for key in REAL},
    }


def variant_rows(group):
    def row(name):
        figures = group[name]
        recall, strong = figures["recall"], figures["recall_from_0.5"]
        shares = [
            figures["published_right_fraction"], recall["mssd"], strong["mssd"],
            recall["add_s"], recall["add"], strong["add_s"], strong["add"], figures["published_good_fraction"],
        ]  # fmt: skip
        errors = [figures["mm_median"], figures["mm_per_m_sq_median"], figures["deg_median"]]
        return (
            NAMES[name], figures["published"], show(figures["ms_median"], "{:.2f}"), show(figures["ms_p99"], "{:.2f}"),
            *(show(share) for share in shares), *(show(error, "{:.2f}") for error in errors), show(figures["bop_ar"]),
        )  # fmt: skip

    return [row(name) for name in NAMES if name in group]


def withheld_rows(withheld):
    keys = ("true", "false", "ignored", "would_have_been_right_by_mssd", "would_have_been_right")
    return [(reason, *(counts[key] for key in keys)) for reason, counts in withheld.items()]


def real_rows(real):
    return [
        ("frames with a reliable reference", real["frames"]),
        ("of these with a pose", real["with_pose"]),
        ("within 5 mm and 5 degrees", real["within_5mm_5deg"]),
        ("median difference, mm", show(real["median_mm"], "{:.2f}")),
        ("median difference, degrees", show(real["median_deg"], "{:.2f}")),
    ]


def sheet(folder, pattern):
    files = sorted(folder.glob(pattern), key=lambda file: int(re.search(r"\d+", file.stem).group()))
    return [embedded(file, "png") for file in files]


def page(out, summary, results):
    return render(
        "bench/pose.html",
        summary=summary,
        variants=variant_rows(results["variants"]),
        rivals=variant_rows(results["on_rival_frames"]) if results["rival_frames"] else [],
        withheld=withheld_rows(results["withheld"]),
        worst=sheet(out / "pose", "worst_*.png"),
        real=real_rows(summary["real"]) if summary["real"]["frames"] is not None else [],
        real_sheet=sheet(out / "real", "sheet_*.png"),
    )


def write(out):
    results = read_json(out / "pose" / "results.json")
    real = read_json_if_any(out / "real" / "poses.json")
    summary = {**summarise(results, real), **about("tools/bench pose")}
    write_json(out / "pose.json", summary)
    (out / "pose.html").write_text(page(out, summary, results))
    print(json.dumps(summary, indent=2))
    print(f"{out}/pose.html, {out}/pose.json")
