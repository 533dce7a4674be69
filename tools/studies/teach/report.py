"""The output of tools/bench teach: summary.json, and a page with every model beside the true one."""

from studies.command import step
from studies.records import about, read_json, rounded, threads, write_json
from studies.report.page import embedded, render, show
from studies.teach.plan import FPS, FRAMES, RANKED, Plan

LIMITS = {"mesh_mm_median": 2.0, "mesh_mm_95": 5.0, "drift_mm": 5.0, "drift_deg": 2.0}  # at most
LEAST = {"mask_iou": 0.9}
NEAR = 0.03  # of what is taught from the true mesh
COMPARED = ("mesh_mm_median", "mesh_mm_95", "seen_mm_median", "seen_mm_95", "missing_share", "seen_surface", "drift_mm",
            "drift_deg", "tracking_mm_median", "tracking_mm_95", "tracking_deg_95", "tracked", "second_mm", "second_deg",
            "mask_iou", "least_mask_iou", "views")  # fmt: skip
TABLE = (
    ("verdict", "verdict"), ("mesh_mm_median", "mesh, mm"), ("mesh_mm_95", "95 %"), ("missing_share", "missing"),
    ("drift_mm", "drift, mm"), ("drift_deg", "degrees"), ("mask_iou", "mask IoU"), ("seen_share", "seen"),
    ("auc", "AUC"), ("auc_true", "of true mesh"), ("add_s", "ADD-S"), ("add_s_true", "of true mesh"),
    ("tracking_hz", "tracking, Hz"), ("seconds", "s"),
)  # fmt: skip


def found(summaries, kind, name):
    """AUC and ADD-S recall of an object; None where its store does not know it."""
    summary = summaries.get(kind, {})
    return summary.get("auc", {}).get(name), summary.get("pose_recall_add_s_10", {}).get(name)


def figures(folders, summaries):
    out = {}
    for name, it in folders.items():
        compared = read_json(it.compared / "compared.json") if it.compared else {}
        report = it.report or {}
        one = {key: compared.get(key) for key in COMPARED}
        one["auc"], one["add_s"] = found(summaries, "shown", name)
        one["auc_true"], one["add_s_true"] = found(summaries, "true", name)
        one["seen_share"] = report.get("seen_share")
        one["verdict"] = report.get("verdict", "poor")
        one["reasons"] = report.get("reasons") or ([] if it.report else it.answer["said"][-1:])
        one["seconds"] = it.answer["seconds"]
        one["taught"] = it.answer["status"] == 0
        one["tracking_hz"] = report.get("tracking_hz")
        one["said_drift_mm"], one["said_drift_deg"] = report.get("drift_mm"), report.get("drift_deg")
        out[name] = one
    return out


def faults(one):
    """Returns the promises that an object does not keep, in words."""
    out = [f"{key} {show(one[key])}" for key, limit in LIMITS.items() if one[key] is None or one[key] > limit]
    out += [f"{key} {show(one[key])}" for key, limit in LEAST.items() if one[key] is None or one[key] < limit]
    for key in ("auc", "add_s"):
        mine, true = one[key], one[f"{key}_true"]
        if true is not None and (mine is None or mine < true - NEAR):
            out.append(f"{key} {show(mine)} beside {show(true)}")
    return out


def judged(objects):
    """Returns which objects keep everything, which do not and were named poor, and which do not and were called good."""
    kept = [name for name, one in objects.items() if not faults(one)]
    return {
        "kept": kept,
        "named_poor": [name for name, one in objects.items() if faults(one) and one["verdict"] == "poor"],
        "called_good": [name for name, one in objects.items() if faults(one) and one["verdict"] == "good"],
    }


def cell(key, value):
    if value is None or isinstance(value, str):
        return value or "–"
    return show(value, {"seconds": "{:.0f}", "tracking_hz": "{:.0f}", "mesh_mm_median": "{:.2f}"}.get(key, "{:.3g}"))


def rows(objects):
    return [(name, *(cell(key, one[key]) for key, _ in TABLE)) for name, one in objects.items()]


def images(it):
    """(words, image) of an object: the taught model, the true one, and what hs-teach kept to look at."""
    out = []
    if it.compared:
        out += [("taught", embedded(it.compared / "taught.png", "png")), ("true", embedded(it.compared / "true.png", "png"))]
    sheet = it.kept / "contact_sheet.jpg"
    if sheet.is_file():
        out.append(("keyframes and model", embedded(sheet, "jpeg")))
    return out


def page(summary, folders):
    objects = summary["objects"]
    shown = [{"name": name, "verdict": objects[name]["verdict"], "reasons": objects[name]["reasons"],
              "faults": faults(objects[name]), "images": images(it)} for name, it in folders.items()]  # fmt: skip
    return render("teach/page.html", summary=summary, header=("object", *(words for _, words in TABLE)),
                  rows=rows(objects), shown=shown)  # fmt: skip


def least(values):
    known = [value for value in values if value is not None]
    return min(known) if known else None


def stream_figures(live):
    """Returns what is said of the teaching in a stream."""
    if live is None:
        return {"seconds_to_found": None, "stream": None}
    kept = ("name", "seconds_to_taught", "frames", "lost", "skipped", "frame_rate_hz")
    return {"seconds_to_found": live["seconds_to_found"], "stream": {key: live[key] for key in kept}}


def summarise(options, folders, summaries, live):
    objects = figures(folders, summaries)
    return rounded({
        "objects": objects,
        **stream_figures(live),
        "tracking_hz": least(one["tracking_hz"] for one in objects.values()),
        "judged": judged(objects),
        **about("tools/bench teach"),
        "settings": {"objects": list(options.objects), "takes": options.takes, "frames": options.frames, "fps": FPS,
                     "world": options.world, "development": options.development, "scene_frames": FRAMES // options.every,
                     "ranked": " ".join(RANKED), "threads": threads()},
    })  # fmt: skip


def glance(summary):
    widths = [max(len(str(row[i])) for row in [("", *(words for _, words in TABLE)), *rows(summary["objects"])])
              for i in range(len(TABLE) + 1)]  # fmt: skip
    lines = [("", *(words for _, words in TABLE)), *rows(summary["objects"])]
    return "\n".join("  ".join(str(text).rjust(width) for text, width in zip(line, widths)) for line in lines)


def run(options):
    plan = Plan(options)
    step("show, teach and compare")
    folders, summaries, live = plan.run()
    step("report")
    summary = summarise(options, folders, summaries, live)
    write_json(options.out / "summary.json", summary)
    (options.out / "report.html").write_text(page(summary, folders))
    print(glance(summary))
    for words, names in summary["judged"].items():
        print(f"{words}: {', '.join(names) or 'none'}")
    print(f"found in the running stream: {show(summary['seconds_to_found'], '{:.1f}')} s after the take")
    print(f"{options.out}/report.html, {options.out}/summary.json")
