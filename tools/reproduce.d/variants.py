"""The detectors that are compared: what hs-study-train is told for each, and how hs-study-evaluate asks it."""

# Training options. The feature study adds one feature at a time to the intensity features (paper, Section 4).
FINAL = ("--profile", "gall", "--features", "intensity,depth_value,depth_derivatives,depth_hog", "--depth-kernel", "7")
FEATURES = {
    "intensity": ("--profile", "gall"),
    "depth_value": ("--profile", "gall", "--features", "intensity,depth_value"),
    "depth_derivatives_3": ("--profile", "gall", "--features", "intensity,depth_derivatives", "--depth-kernel", "3"),
    "depth_derivatives_5": ("--profile", "gall", "--features", "intensity,depth_derivatives", "--depth-kernel", "5"),
    "depth_derivatives_7": ("--profile", "gall", "--features", "intensity,depth_derivatives", "--depth-kernel", "7"),
    "depth_derivatives_9": ("--profile", "gall", "--features", "intensity,depth_derivatives", "--depth-kernel", "9"),
    "depth_hog": ("--profile", "gall", "--features", "intensity,depth_hog"),
    "honv": ("--profile", "gall", "--features", "intensity,honv"),
    "curvature": ("--profile", "gall", "--features", "intensity,curvature"),
    "pfh": ("--profile", "gall", "--features", "intensity,pfh"),
    "fpfh": ("--profile", "gall", "--features", "intensity,fpfh"),
    "final": FINAL,
    # The original compares two pixels in each test (Gall et al. 2011); depth is the same in any light without that.
    "final_depth_by_pixel": (*FINAL, "--shape-alone-share", "1"),
}
OTHER_KERNELS = ("depth_derivatives_3", "depth_derivatives_5", "depth_derivatives_9")  # beside the final features' 7
PROFILES = {name: ("--profile", name) for name in ("gall", "paper", "realtime")}
SCALE_HANDLING = {
    "single": ("--profile", "gall", "--scale-handling", "single"),
    "normalised": ("--profile", "gall", "--scale-handling", "normalised"),
}
HALF_SIZE = {"half_size": ("--profile", "gall", "--image-scale", "0.5")}
TRAINING = {**FEATURES, **PROFILES, **SCALE_HANDLING, **HALF_SIZE}

# What a quick run does without: features, the study of twenty objects, two of the profiles on recorded pictures, and
# what the paper did not compare.
NOT_IN_QUICK = (
    *OTHER_KERNELS,
    *("honv", "curvature", "pfh", "fpfh", "objects_20", "real_gall", "real_paper"),
    *("final_depth_by_pixel", "linemod_no_check", "real_linemod_no_check"),
)

# The same forest under two names: the study's baseline is the profile, as is the one with five scales.
SAME_FOREST = {"intensity": "gall", "five": "gall"}

SCENES = ("table_small_1", "table_small_2", "desk_1", "desk_2", "kitchen_small_1", "meeting_small_1")
SCENES_20 = tuple(f"objects_20_{letter}" for letter in "abcdef")  # each holds the four and half of sixteen others
FEATURE_SCENE = "table_small_1"
SCALE_SCENES = ("table_small_1", "desk_2", "table_small_2")
STRIDES = (1, 2, 3, 4, 6, 8)


def forest_of(what):
    return SAME_FOREST.get(what, what)


def is_gall(what):
    """Of the family of the original, which looks at every pixel in several sizes of the image and takes its time."""
    return TRAINING[forest_of(what)][:2] == PROFILES["gall"]


def detection_options(what):
    """Section 4: every patch, detections from a vote confidence of 0.1 on. That is gall's score. The scores of paper and
    realtime are probabilities, which only rank what has as many votes (--min-mass 0.05); both choose their own patch offset."""
    if is_gall(what):
        return ("--threshold", "0.1", "--stride", "1")
    return ("--min-mass", "0.05", "--threshold", "0")


TIMINGS = {  # name: forest, options; Section 5 gives each saving relative to the original
    "original": ("gall", ("--stride", "1", "--threads", "1", "--reference")),
    "half_size": ("half_size", ("--stride", "1", "--threads", "1", "--reference")),
    "depth_normalisation": ("normalised", ("--stride", "1", "--threads", "1", "--reference")),
    "stride_2": ("gall", ("--stride", "2", "--threads", "1", "--reference")),
    "all_threads": ("gall", ("--stride", "1", "--reference")),
    "fast_engine": ("gall", ("--stride", "1")),
    "final": ("paper", ()),
    "realtime": ("realtime", ()),
}
