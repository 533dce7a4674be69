"""The figures of the comparison as one dictionary. What was not measured is None and is listed under "missing"."""

from studies.records import mean_of, ratio, relative
from studies.reproduce import paper
from studies.reproduce.results import calibration_error, reliability
from studies.reproduce.variants import (
    FEATURE_SCENE,
    FEATURES,
    OTHER_SENSOR,
    OTHER_SENSOR_SCENES,
    PROFILES,
    SCALE_SCENES,
    SCENES,
    SCENES_20,
    STRIDES,
    TIMINGS,
    forest_of,
)


def all_auc(results):
    auc = {what: {scene: results.auc(what, scene) for scene in SCENES} for what in PROFILES}
    for what in (name for name in FEATURES if name not in results.left_out):
        auc.setdefault(what, {FEATURE_SCENE: results.auc(forest_of(what), FEATURE_SCENE)})
    return auc


def operating_point(results, what):
    """Precision and recall at the default threshold, over all objects of all scenes and runs."""
    true = false = required = 0
    for scene in SCENES:
        facts = {"what": what, "scene": scene}
        for name in results.objects(what, scene):
            counts = results.values("required", object=name, **facts)
            recalls = results.values("recall", object=name, **facts)
            required += sum(counts)
            true += sum(round(count * recall) for count, recall in zip(counts, recalls))
        false += sum(results.values("false_detections", **facts))
    return (true / (true + false) if true + false else None), (true / required if required else None)


def real(results):
    return {
        "auc_mean": results.auc("real_realtime", "scenes"),
        "auc_weighted": results.auc("real_realtime", "scenes", "weighted"),
        "auc_gall_mean": results.auc("real_gall", "scenes"),
        "auc_paper_mean": results.auc("real_paper", "scenes"),
        "auc_linemod_mean": results.auc("real_linemod", "scenes"),
        "auc_linemod_no_check_mean": results.auc("real_linemod_no_check", "scenes"),
        "false_per_clutter_frame": results.mean("false_per_frame", what="real_realtime", scene="clutter"),
    }


def auc_by_object(results, what):
    """Mean over the scenes that hold the object: each counts once, however many those are. Empty until all scenes are
    measured."""
    if None in [results.auc(what, scene) for scene in SCENES_20]:
        return {}
    found = {}
    for scene in SCENES_20:
        for name in results.objects(what, scene):
            found.setdefault(name, []).append(results.auc(what, scene, name))
    return {name: mean_of(values) for name, values in found.items()}


def twenty_objects(results):
    """Returns the figures of a forest of twenty and one of four, on the same frames; None where one is not measured in all
    scenes."""
    ms_20, ms_4 = (
        mean_of(results.mean("ms", what=what, scene=scene, kind="side_by_side") for scene in SCENES_20)
        for what in ("objects_20_realtime", "realtime")
    )
    twenty = auc_by_object(results, "objects_20_realtime")
    four = auc_by_object(results, "realtime")
    return {
        "time_ratio": ratio(ms_20, ms_4),
        "auc_mean": mean_of(twenty.values()),
        "auc_mean_of_four": mean_of(four.values()),
        "auc_same_four": mean_of(twenty.get(name) for name in four),
        "auc": twenty or None,
        "ms_20": ms_20,
        "ms_4": ms_4,
    }


def other_sensor(results):
    """AUC of realtime, taught by views of one sensor model, where it sees with the same one and with another."""
    return {
        scene: {"structured_light": results.auc("realtime", scene),
                OTHER_SENSOR: results.auc(f"{OTHER_SENSOR}_realtime", scene)}
        for scene in OTHER_SENSOR_SCENES
    }  # fmt: skip


def strides(results):
    def measured(stride):
        what = f"stride_{stride}"
        return results.auc(what, FEATURE_SCENE), results.milliseconds(what, FEATURE_SCENE, classification_only=True)

    auc_1, ms_1 = measured(1)
    rows = []
    for stride in STRIDES:
        auc, ms = measured(stride)
        changes = {"auc_change": relative(auc, auc_1), "time_change": relative(ms, ms_1)}
        rows.append({"stride": stride, "auc": auc, "ms": ms, **changes})
    return rows


def depth_normalisation(results):
    scenes = {}
    for scene in SCALE_SCENES:
        auc = {what: results.auc(forest_of(what), scene) for what in ("five", "single", "normalised")}
        times = {what: results.milliseconds(forest_of(what), scene) for what in ("five", "normalised")}
        gain = relative(auc["normalised"], auc["five"])
        scenes[scene] = {**auc, "gain": gain, "time_change": relative(times["normalised"], times["five"])}
    return scenes


def timings(results):
    ms = {name: results.milliseconds(name, FEATURE_SCENE, kind="time") for name in TIMINGS}
    return {
        name: {"ms": value, "change": relative(value, ms["original"]), "paper": paper.SAVINGS.get(name)}
        for name, value in ms.items()
    }


def gains(time):
    """Returns how many times as fast as the original it is: in the same engine on one thread each, and as the whole systems
    run."""
    ms = {name: found["ms"] for name, found in time.items()}
    return {
        "same_engine_one_thread": ratio(ms["fast_engine_one_thread"], ms["realtime_one_thread"]),
        "whole_system": ratio(ms["original"], ms["realtime"]),
    }


def was_left_out(path, left_out):
    """Nobody misses what a quick run does without."""
    of_real = {f"real.auc_{name.removeprefix('real_')}_mean" for name in left_out if name.startswith("real_")}
    return path.split(".")[0].removeprefix("auc_") in left_out or path in of_real


def missing(value, path=""):
    """Paths of all that is None."""
    if value is None:
        return [path]
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    return [found for key, item in items for found in missing(item, f"{path}.{key}" if path else str(key))]


def summarise(results):
    precision, recall = operating_point(results, "realtime")
    time = timings(results)
    bins = reliability([curve for scene in SCENES for curve in results.curve_files("realtime", scene)])
    summary = {
        "auc": all_auc(results),
        "auc_linemod": {scene: results.auc("linemod", scene) for scene in SCENES},
        "auc_linemod_no_check": {scene: results.auc("linemod_no_check", scene) for scene in SCENES},
        "precision_at_default": precision,
        "recall_at_default": recall,
        "real": real(results),
        "train_seconds": results.mean("train_seconds", what="realtime"),
        "objects_20": twenty_objects(results),
        "stride": strides(results),
        "depth_normalisation": depth_normalisation(results),
        "time": time,
        "gain_over_original": gains(time),
        "other_sensor": other_sensor(results),
        "reliability": {"bins": bins, "calibration_error": calibration_error(bins)},
    }
    paths = [path for path in missing(summary) if not path.endswith(".paper")]
    summary["missing"] = [path for path in paths if not was_left_out(path, results.left_out)]
    return summary
