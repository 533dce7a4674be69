"""Everything that the comparison runs, as a list of units: what belongs to which figure is decided here."""

import sources
from planner import Planner
from variants import FEATURE_SCENE, FEATURES, PROFILES, SCALE_HANDLING, SCALE_SCENES, SCENES, SCENES_20, STRIDES

CHECK_DEPTH = ("--check-depth",)


def add_studies(planner, source, seed):
    for what in (name for name in FEATURES if name not in planner.protocol.left_out):
        planner.evaluate(what, source, FEATURE_SCENE, seed, "1, 2")
    for scene in SCALE_SCENES:
        for what in ("five", *SCALE_HANDLING):
            planner.evaluate(what, source, scene, seed, "4")
    for stride in STRIDES:
        planner.stride(source, stride, seed)
    for scene in SCENES:
        for what in PROFILES:
            planner.evaluate(what, source, scene, seed, "6")


def add_twenty_objects(planner, few):
    """Both forests look at the same frames, so that only the number of objects differs."""
    source, twenty = sources.twenty(planner.units, few)
    for scene in SCENES_20:
        planner.evaluate("realtime", source, scene, 1, "objects")
        planner.evaluate("realtime", twenty, scene, 1, "objects", prefix="objects_20_")


def add_comparison(planner, source):
    """The first run of everything comes first, so that an early report has all figures."""
    first, *others = planner.protocol.seeds
    every = planner.protocol.every
    add_studies(planner, source, first)
    planner.linemod("linemod", source, SCENES, "6", every, CHECK_DEPTH)
    planner.linemod("linemod_no_check", source, SCENES, "6", every)
    planner.hough_pictures(source)
    planner.timings(source)
    for seed in others:
        add_studies(planner, source, seed)


def add_real(planner, source):
    """Few pictures: even a quick run looks at all."""
    for seed in planner.protocol.seeds:
        for what in (name for name in PROFILES if "real_" + name not in planner.protocol.left_out):
            planner.evaluate(what, source, "scenes", seed, "real", prefix="real_", every=1)
        planner.evaluate("realtime", source, "clutter", seed, "real", prefix="real_", every=1)
    planner.linemod("real_linemod", source, ["scenes"], "real", 1, CHECK_DEPTH)
    planner.linemod("real_linemod_no_check", source, ["scenes"], "real", 1)


def make_plan(dataset, folder, real, protocol):
    """`dataset` is rendered, uw or real; `real` is the folder of recorded pictures, or empty."""
    planner = Planner(protocol)
    if dataset == "rendered":
        source = sources.rendered(planner.units)
        add_comparison(planner, source)
        if "objects_20" not in protocol.left_out:
            add_twenty_objects(planner, source)
    elif dataset == "uw":
        add_comparison(planner, sources.uw(planner.units, folder))
    if real:
        add_real(planner, sources.recorded(planner.units, real))
    return planner.units.all()
