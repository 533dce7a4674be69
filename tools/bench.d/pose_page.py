"""The report as one HTML page that needs no network: tables, and pictures inside it."""

import html
import re

from html_parts import STYLE, embedded, show, table

NAMES = {
    "ours": "ours",
    "pcl": "PCL's point-to-plane ICP from our starts, all else ours",
    "prerejective": "PCL: FPFH, prerejective RANSAC, ICP",
    "ppf": "OpenCV: point pair features, ICP",
    "unchecked": "ours, nothing withheld",
}

HEADER = (
    "", "poses", "ms, median", "ms, 99 %", "ADD-S recall", "ADD recall", "ADD-S, from score 0.5", "ADD, from score 0.5",
    "good, of published", "mm", "mm at 1 m", "degrees", "BOP AR",
)  # fmt: skip


def number_in(file):
    return int(re.search(r"\d+", file.stem).group())


def variant_rows(group):
    def row(name):
        figures = group[name]
        recall, strong = figures["recall"], figures["recall_from_0.5"]
        shares = [recall["add_s"], recall["add"], strong["add_s"], strong["add"], figures["published_good_fraction"]]
        errors = [figures["mm_median"], figures["mm_per_m_sq_median"], figures["deg_median"]]
        return (
            NAMES[name], figures["published"], show(figures["ms_median"], "{:.2f}"), show(figures["ms_p99"], "{:.2f}"),
            *(show(share) for share in shares), *(show(error, "{:.2f}") for error in errors), show(figures["bop_ar"]),
        )  # fmt: skip

    return [row(name) for name in NAMES if name in group]


def withheld_rows(withheld):
    keys = ("true", "false", "ignored", "would_have_been_right")
    return [(reason, *(counts[key] for key in keys)) for reason, counts in withheld.items()]


def sheet(folder, pattern):
    files = sorted(folder.glob(pattern), key=number_in)
    return '<div class="sheet">' + "".join(embedded(file, "png") for file in files) + "</div>"


def real_section(out, real):
    if real["frames"] is None:
        return []
    rows = [
        ("frames with a reliable reference", real["frames"]),
        ("of these with a pose", real["with_pose"]),
        ("within 5 mm and 5 degrees", real["within_5mm_5deg"]),
        ("median difference, mm", show(real["median_mm"], "{:.2f}")),
        ("median difference, degrees", show(real["median_deg"], "{:.2f}")),
    ]
    return [
        "<h2>Camera-recorded frames</h2>",
        "<p>One object's poses beside pseudo poses that another ICP gave: agreement, not accuracy. Below, outlines of the"
        " models in every frame (white: the pose was withheld), and the models painted over it.</p>",
        table(("", ""), rows),
        sheet(out / "real", "sheet_*.png"),
    ]


def rivals_section(results):
    if not results["rival_frames"]:
        return []
    return [
        f"<h2>Beside other methods, on {results['rival_frames']} frames</h2>",
        "<p>They are given the same boxes and centres and look at depth alone; all that they find is published. Ours,"
        " with nothing withheld, is what compares with that; it also looks at colour.</p>",
        table(HEADER, variant_rows(results["on_rival_frames"])),
    ]


def render(out, summary, results):
    parts = [
        f"<!doctype html><html lang=en><meta charset=utf-8><title>Houghstream: poses</title><style>{STYLE}</style>",
        f"<h1>Poses</h1><p>{html.escape(summary['cpu'])}; commit {html.escape(summary['commit'])}</p>",
        f"<h2>Six rendered scenes, {results['frames']} frames</h2>",
        "<p>Milliseconds are CPU time of one thread for one published pose. Recalls: share of the true detections from score"
        " 0.1 on, of objects at least 60 % visible, whose pose is within 10 % of the diameter by ADD-S or by ADD (ADD-S for"
        " symmetric objects); withheld poses count as not found. Good: poses of true detections within 10 % by ADD-S, of"
        " all that were published for true and false detections. Errors are medians over poses of true detections,"
        " degrees for objects without symmetries; at 1 m: divided by the square of the distance. BOP AR: average recall of"
        " the BOP challenge, over all targets, whether detected or not.</p>",
        table(HEADER, variant_rows(results["variants"])),
        *rivals_section(results),
        "<h2>What was withheld, and why</h2>",
        table(("reason", "of true detections", "of false", "of ignored", "would have been right"), withheld_rows(results["withheld"])),
        "<h2>The worst that was published</h2>",
        "<p>Poses of false detections first, then by ADD-S.</p>",
        sheet(out / "pose", "worst_*.png"),
        *real_section(out, summary["real"]),
        "</html>",
    ]
    return "\n".join(parts)
