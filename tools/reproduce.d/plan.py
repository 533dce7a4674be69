"""Everything that the comparison runs, as a list of units: what belongs to which figure is decided here."""

import sources
from planner import Planner
from variants import FEATURE_SCENE, FEATURES, OTHER_KERNELS, PROFILES, SCALE_HANDLING, SCALE_SCENES, SCENES, SCENES_20
from variants import STRIDES

CHECK_DEPTH = ("--check-depth",)


def add_profiles(planner, source, seed):
    for scene in SCENES:
        for what in PROFILES:
            planner.evaluate(what, source, scene, seed, "6")


def add_features(planner, source, seed):
    for what in (name for name in FEATURES if name not in OTHER_KERNELS):
        planner.evaluate(what, source, FEATURE_SCENE, seed, "1, 2")


def add_single_studies(planner, source, seed):
    for what in OTHER_KERNELS:
        planner.evaluate(what, source, FEATURE_SCENE, seed, "1, 2")
    for scene in SCALE_SCENES:
        for what in ("five", *SCALE_HANDLING):
            planner.evaluate(what, source, scene, seed, "4")
    for stride in STRIDES:
        planner.stride(source, stride, seed)


def add_twenty_objects(planner, few):
    """Both forests look at the same frames, so that only the number of objects differs."""
    source, twenty = sources.twenty(planner.units, few)
    forests = {
        "realtime": planner.train("realtime", source, 1, "objects"),
        "objects_20_realtime": planner.train("realtime", twenty, 1, "objects", "objects_20_"),
    }
    for scene in SCENES_20:
        planner.evaluate("realtime", source, scene, 1, "objects")
        planner.evaluate("realtime", twenty, scene, 1, "objects", prefix="objects_20_")
        planner.side_by_side(forests, source, scene, "objects")


def add_comparison(planner, source):
    """One run of everything."""
    first = planner.protocol.seeds[0]
    every = planner.protocol.every
    add_profiles(planner, source, first)
    add_features(planner, source, first)
    planner.linemod("linemod", source, SCENES, "6", every, CHECK_DEPTH)
    planner.linemod("linemod_no_check", source, SCENES, "6", every)
    add_single_studies(planner, source, first)
    planner.hough_pictures(source)
    planner.failure_pictures(source, SCENES)
    planner.timings(source)


def add_real(planner, source):
    """Few pictures: even a quick run looks at all."""
    first = planner.protocol.seeds[0]
    planner.evaluate("realtime", source, "scenes", first, "real", prefix="real_", every=1)
    planner.evaluate("realtime", source, "clutter", first, "real", prefix="real_", every=1)
    planner.linemod("real_linemod", source, ["scenes"], "real", 1, CHECK_DEPTH)
    planner.linemod("real_linemod_no_check", source, ["scenes"], "real", 1)
    for what in ("gall", "paper"):
        planner.evaluate(what, source, "scenes", first, "real", prefix="real_", every=1)


def add_real_runs(planner, source, seed):
    for scene in ("scenes", "clutter"):
        planner.evaluate("realtime", source, scene, seed, "real", prefix="real_", every=1)


def make_plan(dataset, folder, real, protocol):
    """`dataset` is rendered, uw or real; `real` is the folder of recorded pictures, or empty."""
    planner = Planner(protocol)
    source = None
    if dataset == "rendered":
        source = sources.rendered(planner.units)
    elif dataset == "uw":
        source = sources.uw(planner.units, folder)
    recorded = sources.recorded(planner.units, real) if real else None
    # The first run of everything comes first, so that an early report has all figures.
    if source:
        add_comparison(planner, source)
    if recorded:
        add_real(planner, recorded)
    if dataset == "rendered" and "objects_20" not in protocol.left_out:
        add_twenty_objects(planner, source)
    # What the protocol asks to be repeated, as training has its luck.
    for seed in protocol.seeds[1:]:
        if source:
            add_profiles(planner, source, seed)
        if recorded:
            add_real_runs(planner, recorded, seed)
    for seed in protocol.seeds[1:] if source else ():
        add_features(planner, source, seed)
    return planner.units.all()
