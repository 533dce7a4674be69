"""The figures of a set: pooled over its scenes by counting, so that each object counts once, in whichever scene it stands."""

import json
import statistics

from studies.records import read_csv, read_json
from studies.reproduce.results import verdicts
from studies.unit_runner import UnitFailed

FIGURES = (
    "ar", "ar_nothing_withheld", "ar_vsd", "ar_mssd", "ar_mspd", "auc", "precision", "recall", "published_right_fraction",
    "published_good_fraction", "ece_score", "ece_quality", "ece_quality_up_to_shape", "ms_detect_median", "ms_pose_median", "linemod_auc", "ar_prerejective", "ar_ppf",
    "ar_on_rival_frames",
)  # fmt: skip
COUNTS = ("targets", "objects", "true", "false", "confirmed", "published", "frames", "linemod_frames", "rival_frames")


def share(part, whole):
    return part / whole if whole else None


def value(text):
    return float(text) if text not in ("", None) else None


class Evaluation:
    """One folder of hs-evaluate, or of a rival with its files."""

    def __init__(self, folder):
        self.folder = folder
        self.summary = read_json(folder / "summary.json")
        self.judged = {}  # object: (score, is true), strongest first
        for point in read_csv(folder / "curves.csv"):
            self.judged.setdefault(point["object"], []).append(point)
        self.judged = {name: verdicts(points) for name, points in self.judged.items()}
        self.required = self.summary.get("required", {})

    def times(self):
        """(detection, poses) milliseconds of each frame, None where it had none."""
        return [(value(row["detect_ms"]), value(row["pose_ms"])) for row in read_csv(self.folder / "frames.csv")]


def pooled_auc(evaluations):
    """Mean over the objects that are there of the area under each one's curve of all scenes."""
    areas = []
    for name in sorted({name for evaluation in evaluations for name in evaluation.required}):
        required = sum(evaluation.required.get(name, 0) for evaluation in evaluations)
        if required:
            areas.append(
                area([judged for evaluation in evaluations for judged in evaluation.judged.get(name, [])], required)
            )
    return sum(areas) / len(areas) if areas else None


def area(judged, required):
    """Un-interpolated: the sum of the precision at each true detection over the number of objects."""
    true, total = 0, 0.0
    for rank, (_, is_true) in enumerate(sorted(judged, key=lambda pair: -pair[0]), 1):
        true += is_true
        total += true / rank if is_true else 0.0
    return total / required


def counts_at_default(evaluations):
    """True and false detections of what is reported at the defaults, how many of the true ones are candidates that a pose
    has confirmed, and objects that are there."""
    operating = [one.summary["operating"] for one in evaluations]
    true, confirmed = sum(one["true"] for one in operating), sum(one["confirmed"]["true"] for one in operating)
    false = sum(one.summary["false_detections"] for one in evaluations)
    objects = sum(sum(one.required.values()) for one in evaluations)
    return {"true": true, "false": false, "confirmed": confirmed, "objects": objects}


def weighted(pairs):
    """Mean of values by weight; shares of counts become the share of all. None where nothing has weight."""
    known = [(figure, weight) for figure, weight in pairs if figure is not None and weight]
    return share(sum(figure * weight for figure, weight in known), sum(weight for _, weight in known))


def recalls(evaluations, key):
    """Average recalls over all targets, which hs-evaluate counts in each scene: ar, ar_vsd, ar_mssd, ar_mspd, targets."""
    measured = [one.summary[key] for one in evaluations if key in one.summary]
    names = ("ar", "ar_vsd", "ar_mssd", "ar_mspd")
    out = {name: weighted([(one[name]["all"], one["targets"]["all"]) for one in measured]) for name in names}
    return out | {"targets": sum(one["targets"]["all"] for one in measured)}


def calibration(evaluations, key):
    """Bins of one kind pooled: {"ece", "bins"}, or None where hs-evaluate told none."""
    pooled = {}
    for one in evaluations:
        for bin in (one.summary.get(key) or {}).get("bins", []):
            if bin["count"]:
                sums = pooled.setdefault((bin["from"], bin["to"]), [0, 0.0, 0.0])
                sums[0] += bin["count"]
                sums[1] += bin["count"] * bin["mean_score"]
                sums[2] += bin["count"] * bin["true_fraction"]
    count = sum(sums[0] for sums in pooled.values())
    if not count:
        return None
    bins = [
        {"from": low, "to": high, "count": n, "mean_score": scores / n, "true_fraction": true / n}
        for (low, high), (n, scores, true) in sorted(pooled.items())
    ]
    return {"ece": sum(abs(scores - true) for _, scores, true in pooled.values()) / count, "bins": bins}


def median(values):
    known = [number for number in values if number is not None]
    return statistics.median(known) if known else None


def of_scenes(folders):
    """All figures of these scenes together."""
    ranked = [Evaluation(scene.ranked) for scene in folders]
    default = [Evaluation(scene.default) for scene in folders]
    published, checked = recalls(ranked, "bop19"), recalls(ranked, "bop19_nothing_withheld")
    counts = counts_at_default(default)
    score, quality = calibration(ranked, "detection_calibration"), calibration(ranked, "pose_calibration")
    up_to_shape = calibration(ranked, "pose_calibration_up_to_shape")
    times = [pair for one in default for pair in one.times()]
    out = {
        **published,
        "ar_nothing_withheld": checked["ar"],
        "ar_at_default": recalls(default, "bop19")["ar"],
        "auc": pooled_auc(ranked),
        "precision": share(counts["true"], counts["true"] + counts["false"]),
        "recall": share(counts["true"], counts["objects"]),
        **{
            key: weighted([(one.summary.get(key), one.summary.get("published")) for one in default])
            for key in ("published_right_fraction", "published_good_fraction")
        },
        "published": sum(one.summary.get("published") or 0 for one in default),
        "ece_score": score["ece"] if score else None,
        "ece_quality": quality["ece"] if quality else None,
        "ece_quality_up_to_shape": up_to_shape["ece"] if up_to_shape else None,
        "ms_detect_median": median(detect for detect, _ in times),
        "ms_pose_median": median(pose for _, pose in times),
        "frames": sum(one.summary["frames"] for one in default),
        "calibration": {"score": score, "quality": quality},
    }
    return out | counts | of_rivals(folders)


def of_rivals(folders):
    linemod = [Evaluation(scene.linemod) for scene in folders if scene.linemod]
    poses = [read_json(scene.poses / "results.json") for scene in folders if scene.poses]

    def pose_figure(name):
        found = [one["on_rival_frames"][name] for one in poses if name in one["on_rival_frames"]]
        return weighted([(one["bop_ar"], one["bop_targets"]) for one in found])

    return {
        "linemod_auc": pooled_auc(linemod),
        "ar_prerejective": pose_figure("prerejective"),
        "ar_ppf": pose_figure("ppf"),
        "ar_on_rival_frames": pose_figure("unchecked"),
        "linemod_frames": sum(one.summary["linemod"]["frames"] for one in linemod),
        "rival_frames": sum(one["rival_frames"] for one in poses),
    }


def of_run(folders):
    return of_scenes(folders) | {"scenes": {scene.name: of_scenes([scene]) for scene in folders}}


def mean_figure(values):
    """Returns the mean over the seeds that have one."""
    known = [number for number in values if number is not None]
    return sum(known) / len(known) if known else None


def over_seeds(runs):
    """One run as it is; of several the means, with the least and the largest beside them. Counts and rivals are the first's."""
    first = runs[0]
    if len(runs) == 1:
        return first
    mean = {key: mean_figure([run[key] for run in runs]) for key in (*FIGURES, "ar_at_default")}
    spread = {}
    for key in mean:
        known = [run[key] for run in runs if run[key] is not None]
        if len(known) > 1:
            spread[key] = [min(known), max(known)]
    out = first | mean | {"spread": spread}
    if "scenes" in first:
        out["scenes"] = {name: over_seeds([run["scenes"][name] for run in runs]) for name in first["scenes"]}
    return out


def write_csv(folders, file):
    """One file of poses as BOP's tools read it; each scene's name is its id."""
    lines = []
    for scene in folders:
        source = scene.ranked / "bop_results.csv"
        if not source.is_file():
            continue
        header, *rows = source.read_text().splitlines()
        wrong = [row for row in rows if int(row.split(",", 1)[0]) != int(scene.name)]
        if wrong:
            raise UnitFailed(f"{source}: '{wrong[0]}', expected scene {int(scene.name)}")
        lines = lines or [header]
        lines += rows
    file.write_text("\n".join(lines or ["scene_id,im_id,obj_id,score,R,t,time"]) + "\n")


def settings_text(settings):
    return json.dumps(settings, indent=2)
