"""What the units measured, as rows (kind, what, scene, seed, object, metric, value), and questions about them."""

import csv
import io
import json

from measured import read_csv, read_json

COLUMNS = ("kind", "what", "scene", "seed", "object", "metric", "value")
BY_OBJECT = ("auc", "required", "precision", "recall")
WHOLE = ("frames", "false_detections", "false_per_frame")


def train_seconds(log):
    """The last line "train_seconds X" of a trainer's words, or None."""
    values = [line.split()[1] for line in log.read_text().splitlines() if line.startswith("train_seconds ")]
    return float(values[-1]) if values else None


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
        """Of all rows that match, in order of the seeds; what was not measurable is left out."""
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
        """Those that are in the scene."""
        rows = [row for row in self.rows if (row["metric"], row["what"], row["scene"]) == ("required", what, scene)]
        return list(dict.fromkeys(row["object"] for row in rows if row["value"]))

    def milliseconds(self, what, scene, stages=None, kind="evaluate"):
        """Of one frame: all stages of the detector, or those named; mean over the training runs."""
        facts = {"what": what, "scene": scene, "kind": kind}
        rows = [row for row in self.rows if all(row[key] == value for key, value in facts.items())]
        metrics = {row["metric"] for row in rows if row["metric"].startswith("ms detect.")}
        wanted = {f"ms {stage}" for stage in stages} if stages else metrics
        if not wanted or not wanted <= metrics:
            return None
        return sum(self.mean(metric, **facts) for metric in wanted)

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
