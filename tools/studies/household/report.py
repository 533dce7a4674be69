"""The output of tools/bench household: OUT/summary.json and OUT/report.md."""

from studies.command import step
from studies.household.figures import Results
from studies.household.plan import Plan
from studies.records import about, read_json, rounded, write_atomically, write_json
from studies.report.page import show
from studies.result_tables import table

# Heading, key, form.
COLUMNS = (
    ("objects", "objects", "{}"), ("forests", "groups", "{}"), ("AUC", "auc", "{:.3f}"), ("AUC in its group", "auc_alone", "{:.3f}"),
    ("right poses: recall", "right_recall", "{:.3f}"), ("precision", "right_precision", "{:.3f}"),
    ("up to shape", "shape_precision", "{:.3f}"), ("recall at 0.98", "right_recall_098", "{:.3f}"), ("detections: recall", "recall", "{:.3f}"),
    ("precision", "precision", "{:.3f}"), ("recall at 0.98", "recall_098", "{:.3f}"), ("AR", "ar", "{:.3f}"),
    ("ECE score", "ece_score", "{:.3f}"), ("ECE quality", "ece_quality", "{:.3f}"),
)  # fmt: skip
COSTS = (
    ("objects", "objects", "{}"), ("detection, ms", "ms_detect", "{:.1f}"), ("times that of 7", "slower", "{:.2f}"),
    ("poses, ms", "ms_pose", "{:.1f}"), ("teaching, GB", "teach_gb", "{:.2f}"), ("s an object", "teach_s_per_object", "{:.1f}"),
    ("one more, s", "add_s", "{:.1f}"), ("store, MB an object", "store_mb_per_object", "{:.1f}"),
    ("hs-detect, MB", "detect_mb", "{:.0f}"), ("hs-pose, MB", "pose_mb", "{:.0f}"),
)  # fmt: skip


def rows(columns, by_number):
    """The header first."""
    out = [tuple(heading for heading, _, _ in columns)]
    for number, entry in by_number.items():
        known = entry | {"slower": slower(entry), "objects": number if entry["objects"] is None else entry["objects"]}
        out.append(tuple(show(known[key], form) for _, key, form in columns))
    return out


def slower(entry):
    """How many times as long a detection takes as with seven objects."""
    small = entry["ms_detect_7"]
    return entry["ms_detect"] / small if small else None


def object_rows(by_object):
    """The header first, then from the object that loses most among others to the one that loses least."""

    def lost(pair):
        area = pair[1]["auc_alone"]
        return pair[1]["auc"] - (pair[1]["auc"] if area is None else area)

    keys = ("auc", "auc_alone", "recall", "ar")
    return [("object", "there", "AUC", "in its group", "recall", "AR")] + [
        (name, one["there"], *(show(one[key]) for key in keys)) for name, one in sorted(by_object.items(), key=lost)
    ]


def page(summary):
    yield from ("# A household", "", f"{summary['command']}; {summary['cpu']}; {summary['date']}; commit {summary['commit']}", "",
                f"{summary['rooms']} furnished rooms, {summary['frames']} frames; {len(summary['taught'])} objects are taught, "
                f"{len(summary['strangers'])} that never are stand among them. {summary['alone']}", "")  # fmt: skip
    yield table(rows(COLUMNS, summary["by_number"]))
    yield from ("", "Right: by MSSD (ADD without symmetries) below a tenth of the diameter. Recall at 0.98: from the least quality, or "
                "score, on that keeps this precision in these rooms. AUC counts detections that hs-evaluate ranks.", "")  # fmt: skip
    yield table(rows(COSTS, summary["by_number"]))
    yield from ("", f"Times are medians over {summary['rounds']} rounds, in which all stores looked at the same frames in turn.", "")
    for number, objects in summary["by_object"].items():
        yield from (f"## Each object in the store of {number}", "", table(object_rows(objects)), "")


def alone_words(plan):
    most = max((len(group.names) for group in plan.groups.values()), default=0)
    return f"In its group means: in the store of at most {most} objects with which an object was taught."


def summarise(options, plan, store):
    results = Results(plan, store)
    taught = {name for group in plan.groups.values() for name in group.names}
    frames = sum(len(read_json(store.path("scenes") / f"{room:06}" / "scene_gt.json")) for room in range(1, options.rooms + 1))
    largest = max(plan.numbers, default=None)
    return {
        **about("tools/bench household" + " --quick" * options.quick),
        "models": str(options.models),
        "stores": [str(folder) for folder, _ in options.stores or ()],
        "taught": [one for one, name in options.names.items() if name in taught],
        "strangers": options.strangers,
        "rooms": options.rooms,
        "frames": frames,
        "rounds": options.rounds,
        "alone": alone_words(plan),
        "by_number": {str(number): results.entry(number) for number in options.numbers},
        "by_object": {str(largest): results.by_object(largest)} if plan.numbers else {},
    }


def run(options):
    plan = Plan(options)
    store = plan.run()
    if options.scenes_only:
        step(f"{store.path('scenes')}")
        return
    summary = rounded(summarise(options, plan, store))
    write_json(options.out / "summary.json", summary)
    write_atomically(options.out / "report.md", "\n".join(page(summary)) + "\n")
    step(f"{options.out / 'summary.json'}, {options.out / 'report.md'}")
