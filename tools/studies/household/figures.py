"""The figures of tools/bench household: of each store in the same rooms, and of its objects alone."""

import pathlib
import statistics

from studies.bop.figures import share
from studies.records import read_json
from studies.unit_runner import INPUT

PRECISION = 0.98
KEYS = ("objects", "auc", "auc_alone", "recall", "precision", "ar", "ms_detect", "ms_detect_7", "ms_pose", "teach_gb",
        "teach_s_per_object", "add_s", "store_mb_per_object", "detect_mb", "pose_mb", "ece_score", "ece_quality")  # fmt: skip
FURTHER = ("right_recall", "right_precision", "shape_precision", "right_recall_098", "recall_098", "groups",
           "targets")  # right by MSSD, or up to shape by ADD-S
SMALL = 7  # the number with whose times others are compared


def objects_there(summary):
    """Names of the objects of a store that stand in the rooms."""
    return [name for name, count in summary["required"].items() if count]


def mean_auc(summary, names):
    """Mean area of these objects; None where none of them stands there."""
    areas = [summary["auc"][name] for name in names]
    return sum(areas) / len(areas) if areas else None


def alone(summaries):
    """{name: area} of each object in the group in which it was taught."""
    return {name: summary["auc"][name] for summary in summaries for name in objects_there(summary)}


def recall_at(calibration, precision=PRECISION):
    """Recall from the least value on from which so large a part is right; None where no value keeps that."""
    return next((one["recall"] for one in calibration["proposed"] if one["precision"] == precision), None)


def right_poses(calibration):
    """The number of right ones among all poses that were judged."""
    return sum(round(bin["count"] * bin["true_fraction"]) for bin in calibration["bins"] if bin["count"])


def right_figures(summary):
    """Of poses that are right by MSSD: found of all objects, right of those that are published (and those that are right up to
    shape), and how many of all objects have a right pose from the least quality on that keeps PRECISION."""
    required = sum(summary["required"].values())
    published, right = summary["published"] or 0, summary["published_right_fraction"]
    least = recall_at(summary["pose_calibration"])
    return {
        "right_recall": share(published * (right or 0.0), required),
        "right_precision": right,
        "shape_precision": summary["published_good_fraction"],
        "right_recall_098": None if least is None else share(least * right_poses(summary["pose_calibration"]), required),
    }


def found_figures(summary, areas_alone):
    """Of one store's look at the rooms."""
    names = objects_there(summary)
    known = [areas_alone[name] for name in names if name in areas_alone]
    return {
        "auc": mean_auc(summary, names),
        "auc_alone": sum(known) / len(known) if names and len(known) == len(names) else None,
        "recall": summary["operating"]["recall"],
        "precision": summary["operating"]["precision"],
        "recall_098": recall_at(summary["detection_calibration"]),
        **right_figures(summary),
        "ar": summary["bop19"]["ar"]["all"] if "bop19" in summary else None,
        "targets": summary["bop19"]["targets"]["all"] if "bop19" in summary else None,
        "ece_score": summary["detection_calibration"]["ece"],
        "ece_quality": summary["pose_calibration"]["ece"],
    }


def by_object(summary, areas_alone):
    """{name: its figures} of the objects that stand there."""
    recalls = summary.get("bop19", {}).get("ar", {})
    return {
        name: {"there": summary["required"][name], "auc": summary["auc"][name], "auc_alone": areas_alone.get(name),
               "recall": summary["recall"][name], "precision": summary["precision"][name], "ar": recalls.get(name)}
        for name in objects_there(summary)
    }  # fmt: skip


def median(values):
    return statistics.median(values) if values else None


def time_figures(times, number):
    """Medians over frames and rounds; `times` is of rounds.py."""
    small = times.get(str(SMALL))
    return {
        "ms_detect": median(times[str(number)]["detect_ms"]),
        "ms_detect_7": median(small["detect_ms"]) if small else None,
        "ms_pose": median(times[str(number)]["pose_ms"]),
    }


def folder_mb(folder):
    return sum(file.stat().st_size for file in folder.rglob("*") if file.is_file()) / 1e6


def teach_figures(runs, joined, count):
    """Memory of the largest teaching, and seconds of all with their joining; None of stores that were taught before. `runs` and
    `joined` are of measured_run.py."""
    if None in runs:
        return {"teach_gb": None, "teach_s_per_object": None}
    all_runs = runs + [joined] * (joined is not None)
    return {
        "teach_gb": max(run["memory_mb"] for run in all_runs) / 1e3,
        "teach_s_per_object": sum(run["seconds"] for run in all_runs) / count,
    }


def empty():
    return dict.fromkeys(KEYS + FURTHER)


class Results:
    """Reads what the units have made."""

    def __init__(self, plan, store):
        self.plan, self.store = plan, store
        self.alone = alone(self.found(key) for key in plan.groups)
        self.times = read_json(store.path("times.json")) if "times.json" in store.units else {}

    def found(self, key):
        return read_json(self.store.path(f"found/{key}") / "summary.json")

    def of_store(self, number):
        """The summary of hs-evaluate with the store of that number."""
        groups = self.plan.numbers[number]
        return self.found(groups[0].key if len(groups) == 1 else number)

    def run(self, name):
        """Seconds and memory of a unit, None where it was none of this bench's."""
        return read_json(self.store.path(name) / "run.json") if name in self.store.units else None

    def folder(self, number):
        """The folder of a number's store."""
        words, _ = self.plan.store_of(number)
        return pathlib.Path(INPUT.sub(lambda name: str(self.store.path(name[1])), words))

    def entry(self, number):
        if number not in self.plan.numbers:
            return empty()
        groups = self.plan.numbers[number]
        count = sum(len(group.names) for group in groups)
        runs = [self.run(f"taught/{group.key}") for group in groups]
        detected, posed, added = (self.run(f"{kind}/{number}") for kind in ("detected", "posed", "added"))
        return empty() | found_figures(self.of_store(number), self.alone) | time_figures(self.times, number) | {
            **teach_figures(runs, self.run(f"joined/{number}"), count),
            "objects": count,
            "groups": len(groups),
            "add_s": added and added["seconds"],
            "store_mb_per_object": folder_mb(self.folder(number)) / count,
            "detect_mb": detected and detected["memory_mb"],
            "pose_mb": posed and posed["memory_mb"],
        }  # fmt: skip

    def by_object(self, number):
        return by_object(self.of_store(number), self.alone)
