"""The figures of the report as SVG texts; None, or none in a list, where nothing is measured that they could show."""

from studies.records import mean_of
from studies.report.charts import COLOURS, NARROW, Chart, grouped_bars, row_bars
from studies.reproduce import paper
from studies.reproduce.variants import (
    DETECTOR_NAMES,
    FEATURE_NAMES,
    FEATURE_SCENE,
    FEATURES,
    SCALE_SCENES,
    SCENES,
    forest_of,
)

# Figure 1 of the paper shows these; the other kernels of the derivatives are in Figure 2.
CURVES = ("intensity", "depth_value", "depth_derivatives_7", "depth_hog", "honv", "curvature", "pfh", "fpfh", "final")
COLOUR_OF = {
    "linemod": "#777777",
    "linemod_no_check": "#bbbbbb",
    "gall": COLOURS[0],
    "paper": COLOURS[1],
    "realtime": COLOURS[4],
}
SMALL = (4.2, 3.6)  # inches


def one_object(curve, name):
    return [(float(row["recall"]), float(row["precision"])) for row in curve if row["object"] == name]


def precision_recall(results, feature):
    """One line an object; the first training run is drawn strongly, the others faintly."""
    what = forest_of(feature)
    chart = Chart(("recall", 1.0), ("precision", 1.0), FEATURE_NAMES[feature], SMALL)
    curves = results.curve_files(what, FEATURE_SCENE)
    for name in results.objects(what, FEATURE_SCENE):
        lines = [line for line in (one_object(curve, name) for curve in curves) if line] or [[(0.0, 0.0)]]
        chart.line(f"{name} {results.auc(what, FEATURE_SCENE, name):.2f}", lines[0], lines[1:])
    return chart.svg()


def feature_curves(results):
    shown = [feature for feature in CURVES if results.auc(forest_of(feature), FEATURE_SCENE) is not None]
    return [precision_recall(results, feature) for feature in shown]


def feature_bars(results):
    rows = []
    for feature in (name for name in FEATURES if name not in results.left_out):
        what = forest_of(feature)
        ours = results.auc(what, FEATURE_SCENE)
        rows.append((FEATURE_NAMES[feature], ours, results.spread(what, FEATURE_SCENE), paper.feature_auc(feature)))
    if not any(ours for _, ours, _, _ in rows):
        return None
    return row_bars(rows, f"AUC, mean of the objects in {FEATURE_SCENE}", "measured here", "paper, its own data")


def depth_normalisation(results):
    """A chart for each scene: the mean of its objects, then each."""
    charts = []
    for scene in (name for name in SCALE_SCENES if results.auc(forest_of("normalised"), name) is not None):
        groups = ["mean", *results.objects("gall", scene)]
        series = []
        for what, name in (("five", "five scales"), ("single", "single scale"), ("normalised", "depth normalisation")):
            forest = forest_of(what)
            values = [results.auc(forest, scene, group) for group in groups]
            series.append((name, None, values, [results.spread(forest, scene, group) for group in groups]))
        charts.append(grouped_bars(groups, series, "AUC", scene, NARROW))
    return charts


def stride_chart(rows):
    known = [row for row in rows if row["auc_change"] is not None and row["time_change"] is not None]
    if not known:
        return None
    top = max([1.0] + [1.0 + row["auc_change"] for row in known])
    chart = Chart(("stride, pixels", 9.0), ("percent of stride 1", 112.0 * top))
    chart.dashes([(0.0, 100.0), (9.0, 100.0)])
    for name, key in (("AUC", "auc_change"), ("time from classification on", "time_change")):
        points = [(row["stride"], 100.0 * (1.0 + row[key])) for row in known]
        chart.line(name, points)
        for x, y in points[1:]:
            chart.label(x, y, f"{y:.0f} %")
    return chart.svg()


def final_bars(results):
    series = []
    for what, name in DETECTOR_NAMES.items():
        values = [results.auc(what, scene) for scene in SCENES]
        spreads = [results.spread(what, scene) for scene in SCENES] + [None]
        series.append((name, COLOUR_OF[what], [*values, mean_of(values)], spreads))
    measured = any(value is not None for _, _, values, _ in series for value in values)
    return grouped_bars([*SCENES, "mean"], series, "AUC") if measured else None


def reliability_chart(bins):
    if not bins:
        return None
    chart = Chart(("predicted score", 1.0), ("share of detections that are true", 1.0))
    chart.dashes([(0.0, 0.0), (1.0, 1.0)])
    for row in bins:
        chart.whisker(row["score"], max(row["low"], 0.0), min(row["high"], 1.0))
        chart.label(row["score"], row["share_true"], str(row["count"]))
    points = [(row["score"], row["share_true"]) for row in bins]
    chart.dots("realtime, six scenes; number of detections beside each dot", points, radius=2.5)
    return chart.svg()
