"""Adds up one run of tools/bench pose: writes pose.json and pose.html into its folder and prints the figures."""

import argparse
import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "report_kit"))

import pose_page
from measured import cpu_name, read_json


def figure(group, variant, *keys):
    """What a group of results.json says of a variant; None where it was not measured."""
    value = group.get(variant)
    for key in keys:
        value = None if value is None else value[key]
    return value


def summarise(results, real):
    """The figures by which runs are compared; `real` is poses.json of hs-bench-real, or None."""
    variants, beside_rivals = results["variants"], results["on_rival_frames"]
    return {
        "ms_per_pose_median": figure(variants, "ours", "ms_median"),
        "ms_per_pose_p99": figure(variants, "ours", "ms_p99"),
        "pcl_ms_median": figure(variants, "pcl", "ms_median"),
        "prerejective_ms_median": figure(beside_rivals, "prerejective", "ms_median"),
        "ppf_ms_median": figure(beside_rivals, "ppf", "ms_median"),
        "add_s_recall": figure(variants, "ours", "recall", "add_s"),
        "add_recall": figure(variants, "ours", "recall", "add"),
        "add_s_recall_from_0.5": figure(variants, "ours", "recall_from_0.5", "add_s"),
        "add_recall_from_0.5": figure(variants, "ours", "recall_from_0.5", "add"),
        "pcl_add_s_recall": figure(variants, "pcl", "recall", "add_s"),
        "pcl_add_recall": figure(variants, "pcl", "recall", "add"),
        "bop_ar": figure(variants, "ours", "bop_ar"),
        "bop_ar_pcl": figure(variants, "pcl", "bop_ar"),
        "bop_ar_on_rival_frames": figure(beside_rivals, "ours", "bop_ar"),
        "bop_ar_prerejective": figure(beside_rivals, "prerejective", "bop_ar"),
        "bop_ar_ppf": figure(beside_rivals, "ppf", "bop_ar"),
        "published_good_fraction": figure(variants, "ours", "published_good_fraction"),
        "translation_mm_median": figure(variants, "ours", "mm_median"),
        "translation_mm_median_at_1m": figure(variants, "ours", "mm_per_m_sq_median"),
        "rotation_deg_median": figure(variants, "ours", "deg_median"),
        "withheld": results["withheld"],
        "frames": results["frames"],
        "rival_frames": results["rival_frames"],
        "real": {
            key: None if real is None else real[key]
            for key in ("within_5mm_5deg", "frames", "with_pose", "median_mm", "median_deg")
        },
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--commit", required=True)
    arguments = parser.parse_args()
    out = arguments.out
    results = read_json(out / "pose" / "results.json")
    real_file = out / "real" / "poses.json"
    real = read_json(real_file) if real_file.is_file() else None
    summary = summarise(results, real)
    summary["cpu"] = cpu_name()
    summary["commit"] = arguments.commit
    (out / "pose.json").write_text(json.dumps(summary, indent=2) + "\n")
    (out / "pose.html").write_text(pose_page.render(out, summary, results))
    print(json.dumps(summary, indent=2))
    print(f"{out}/pose.html, {out}/pose.json")


if __name__ == "__main__":
    main()
