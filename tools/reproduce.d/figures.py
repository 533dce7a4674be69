"""The figures of the report as inline SVG."""

from bars import GroupedBars, row_bars
from charts import COLOURS, Chart
from html_parts import embedded
import paper
from variants import FEATURE_SCENE, FEATURES, SCALE_SCENES, SCENES, forest_of

FEATURE_NAMES = {
    "intensity": "RGB only (baseline)",
    "depth_value": "+ depth value",
    "depth_derivatives_3": "+ depth derivatives, 3×3",
    "depth_derivatives_5": "+ depth derivatives, 5×5",
    "depth_derivatives_7": "+ depth derivatives, 7×7",
    "depth_derivatives_9": "+ depth derivatives, 9×9",
    "depth_hog": "+ depth HoG",
    "honv": "+ HONV",
    "curvature": "+ principal curvature",
    "pfh": "+ PFH",
    "fpfh": "+ FPFH",
    "final": "final: value, derivatives, HoG",
    "final_depth_by_pixel": "final, tests on depth look at one pixel",
}
# Figure 1 of the paper shows these; the other kernels of the derivatives are in Figure 2.
CURVES = ("intensity", "depth_value", "depth_derivatives_7", "depth_hog", "honv", "curvature", "pfh", "fpfh", "final")
DETECTORS = {  # of Figure 6, with their colours
    "linemod": ("LINEMOD with depth check", "#777777"),
    "linemod_no_check": ("LINEMOD without it", "#bbbbbb"),
    "gall": ("gall (RGB Hough Forest)", COLOURS[0]),
    "paper": ("paper (its final version)", COLOURS[1]),
    "realtime": ("realtime (ours)", COLOURS[4]),
}


def one_object(curve, name):
    return [(float(row["recall"]), float(row["precision"])) for row in curve if row["object"] == name]


def precision_recall(results, feature):
    """One line an object; the first training run is drawn strongly, the others faintly."""
    what = forest_of(feature)
    chart = Chart("recall", "precision", 1.0, 1.0, FEATURE_NAMES[feature])
    curves = results.curve_files(what, FEATURE_SCENE)
    for name in results.objects(what, FEATURE_SCENE):
        lines = [line for line in (one_object(curve, name) for curve in curves) if line] or [[(0.0, 0.0)]]
        chart.line(f"{name} {results.auc(what, FEATURE_SCENE, name):.2f}", lines[0], lines[1:])
    return chart.svg()


def feature_curves(results):
    shown = [feature for feature in CURVES if results.auc(forest_of(feature), FEATURE_SCENE) is not None]
    return f'<div class="charts small">{"".join(precision_recall(results, feature) for feature in shown)}</div>'


def feature_bars(results):
    rows = []
    for feature in (name for name in FEATURES if name not in results.left_out):
        what = forest_of(feature)
        ours = results.auc(what, FEATURE_SCENE)
        rows.append((FEATURE_NAMES[feature], ours, results.spread(what, FEATURE_SCENE), paper.feature_auc(feature)))
    return row_bars(rows, f"AUC, mean of the objects in {FEATURE_SCENE}", "measured here", "paper, its own data")


def pictures(results, captions):
    """The pictures among the units, by name, with what stands below each."""
    return "".join(
        f"<figure>{embedded(results.store.file(unit), 'png')}<figcaption>{captions[unit.name]}</figcaption></figure>"
        for unit in results.units
        if unit.name in captions
    )


def hough_spaces(results):
    names = {"hough/before.png": "RGB features", "hough/after.png": "with depth value, derivatives and HoG"}
    return pictures(results, names)


def failures(results):
    return pictures(results, {"failures/realtime.png": "The gravest of each scene; red: false, yellow: not found"})


def depth_normalisation(results):
    """A chart for each scene: the mean of its objects, then each."""
    charts = []
    for scene in SCALE_SCENES:
        groups = ["mean", *results.objects("gall", scene)]
        chart = GroupedBars(groups, "AUC", width=620, title=scene)
        for what, name in (("five", "five scales"), ("single", "single scale"), ("normalised", "depth normalisation")):
            forest = forest_of(what)
            chart.add(
                name,
                [results.auc(forest, scene, group) for group in groups],
                [results.spread(forest, scene, group) for group in groups],
            )
        charts.append(chart.svg())
    return f'<div class="charts half">{"".join(charts)}</div>'


def stride_chart(rows):
    known = [row for row in rows if row["auc_change"] is not None and row["time_change"] is not None]
    top = max([1.0] + [1.0 + row["auc_change"] for row in known])
    chart = Chart("stride, pixels", "percent of stride 1", 9.0, 112.0 * top)
    chart.dashes([(0.0, 100.0), (9.0, 100.0)])
    for name, key in (("AUC", "auc_change"), ("time of classification and voting", "time_change")):
        points = [(row["stride"], 100.0 * (1.0 + row[key])) for row in known]
        if points:
            chart.line(name, points)
            for x, y in points[1:]:
                chart.label(x, y, f"{y:.0f} %")
    return chart.svg()


def final_bars(results):
    chart = GroupedBars(list(SCENES) + ["mean"], "AUC")
    for what, (name, colour) in DETECTORS.items():
        values = [results.auc(what, scene) for scene in SCENES]
        known = [value for value in values if value is not None]
        mean = sum(known) / len(known) if len(known) == len(SCENES) else None
        chart.add(name, values + [mean], [results.spread(what, scene) for scene in SCENES] + [None], colour)
    return chart.svg()


def reliability_chart(bins):
    chart = Chart("predicted score", "share of detections that are true", 1.0, 1.0)
    chart.dashes([(0.0, 0.0), (1.0, 1.0)])
    for row in bins:
        chart.whisker(row["score"], max(row["low"], 0.0), min(row["high"], 1.0))
        chart.label(row["score"], row["share_true"], str(row["count"]))
    chart.dots(
        "realtime, six scenes; number of detections beside each dot",
        [(row["score"], row["share_true"]) for row in bins],
        radius=5,
    )
    return chart.svg()
