"""The measurements of the units, as rows (kind, what, scene, seed, object, metric, value), and questions about them: means,
spreads, times, and whether scores are the probabilities that they claim to be."""

import csv
import io
import json
import math

from studies.records import read_csv, read_json, train_seconds

COLUMNS = ("kind", "what", "scene", "seed", "object", "metric", "value")
BY_OBJECT = ("auc", "required", "precision", "recall")
WHOLE = ("frames", "false_detections", "false_per_frame")
BEFORE_CLASSIFICATION = ("decode", "resize", "features")  # stages; all others of the detector classify, vote and judge
BINS = 10  # of the score


def evaluation_rows(summary):
    """(object, metric, value) of one summary.json; object "" is the whole frame."""
    rows = [(name, metric, value) for metric in BY_OBJECT for name, value in summary.get(metric, {}).items()]
    return rows + [("", metric, summary.get(metric)) for metric in WHOLE] + time_rows(summary)


def time_rows(summary):
    return [("", f"ms {stage}", value) for stage, value in summary.get("stage_ms_median", {}).items()]


class Results:
    def __init__(self, store, units, left_out=()):
        self.store, self.left_out = store, left_out
        self.units = [unit for unit in units if store.is_current(unit)]
        self.rows = []
        self.curves = {}  # folder of each evaluation's curves by (what, scene), in order of the seeds
        for unit in self.units:
            self._read(unit)

    def _read(self, unit):
        folder = self.store.file(unit)
        if unit.kind in ("train", "linemod"):
            self._add(unit, unit.scene, [("", "train_seconds", train_seconds(self.store.log(unit)))])
        if unit.kind == "linemod":
            for scene in sorted(path for path in folder.iterdir() if path.is_dir()):
                self._read_evaluation(unit, scene.name, scene)
        elif unit.kind == "evaluate":
            self._read_evaluation(unit, unit.scene, folder)
        elif unit.kind == "time":
            self._add(unit, unit.scene, time_rows(read_json(folder / "summary.json")))
        elif unit.kind == "side_by_side":
            for name, measured in read_json(folder).items():
                self._add(unit, unit.scene, [("", "ms", measured["ms"]["p50"])], what=name)

    def _read_evaluation(self, unit, scene, folder):
        self._add(unit, scene, evaluation_rows(read_json(folder / "summary.json")))
        self.curves.setdefault((unit.what, scene), []).append(folder / "curves.csv")

    def _add(self, unit, scene, rows, what=None):
        facts = {"kind": unit.kind, "what": what or unit.what, "scene": scene, "seed": unit.seed}
        self.rows += [{**facts, "object": name, "metric": metric, "value": value} for name, metric, value in rows]

    def values(self, metric, **facts):
        """Returns the values of all rows that match, in order of the seeds; what was not measurable is left out."""
        found = [
            row
            for row in self.rows
            if row["metric"] == metric and all(row[key] == value for key, value in facts.items())
        ]
        return [row["value"] for row in found if row["value"] is not None]

    def mean(self, metric, **facts):
        values = self.values(metric, **facts)
        return sum(values) / len(values) if values else None

    def auc(self, what, scene, name="mean"):
        """Mean over the training runs."""
        return self.mean("auc", what=what, scene=scene, object=name)

    def spread(self, what, scene, name="mean"):
        """Smallest and largest AUC of the training runs, or None."""
        values = self.values("auc", what=what, scene=scene, object=name)
        return (min(values), max(values)) if values else None

    def objects(self, what, scene):
        """Returns the objects that are in the scene."""
        rows = [row for row in self.rows if (row["metric"], row["what"], row["scene"]) == ("required", what, scene)]
        return list(dict.fromkeys(row["object"] for row in rows if row["value"]))

    def milliseconds(self, what, scene, kind="evaluate", classification_only=False):
        """Returns the time of one frame: all stages of the detector, or those from classification on; mean over the training
        runs."""
        facts = {"what": what, "scene": scene, "kind": kind}
        rows = [row for row in self.rows if all(row[key] == value for key, value in facts.items())]
        metrics = dict.fromkeys(row["metric"] for row in rows if row["metric"].startswith("ms detect."))
        left_out = {f"ms detect.{stage}" for stage in BEFORE_CLASSIFICATION} if classification_only else set()
        values = [self.mean(metric, **facts) for metric in metrics if metric not in left_out]
        return sum(values) if values else None

    def curve_files(self, what, scene):
        return [read_csv(file) for file in self.curves.get((what, scene), [])]

    def csv(self):
        text = io.StringIO()
        writer = csv.DictWriter(text, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(self.rows)
        return text.getvalue()

    def json(self):
        return json.dumps(self.rows, indent=1) + "\n"


def verdicts(curve):
    """(score, is true) of each point of one curves.csv: recall rises exactly where a detection was true."""
    judged = []
    recall = {}
    for point in curve:
        name, now = point["object"], float(point["recall"])
        judged.append((float(point["score"]), now > recall.get(name, 0.0)))
        recall[name] = now
    return judged


def wilson(share, count, z=1.96):
    """95 % interval of a share seen in so many trials (Wilson 1927)."""
    centre = share + z * z / (2 * count)
    half = z * math.sqrt(share * (1 - share) / count + z * z / (4 * count * count))
    return (centre - half) / (1 + z * z / count), (centre + half) / (1 + z * z / count)


def reliability(curves):
    """Returns for each bin of the score that has any: its mean score, count, share that is true, and that share's interval."""
    bins = [[] for _ in range(BINS)]
    for score, is_true in (verdict for curve in curves for verdict in verdicts(curve)):
        bins[min(max(int(score * BINS), 0), BINS - 1)].append((score, is_true))
    rows = []
    for judged in filter(None, bins):
        share = sum(is_true for _, is_true in judged) / len(judged)
        low, high = wilson(share, len(judged))
        mean = sum(score for score, _ in judged) / len(judged)
        rows.append({"score": mean, "count": len(judged), "share_true": share, "low": low, "high": high})
    return rows


def calibration_error(rows):
    """Expected calibration error: |score - share| averaged over the detections; None without any."""
    count = sum(row["count"] for row in rows)
    return sum(row["count"] * abs(row["score"] - row["share_true"]) for row in rows) / count if count else None
