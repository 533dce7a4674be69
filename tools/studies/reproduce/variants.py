"""The detectors that are compared: which program trains and measures each, what it is told, and what the report calls it.

The product's programs know the profiles paper and realtime; gall (the original) and what is made of it, the surface
features and the reference engine are known to the studies' programs alone, which take the same options."""

import dataclasses

from studies.command import TEST_SCENES as SCENES

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

# What a quick run does without: features, the study of twenty objects, two of the profiles on recorded images, and
# what the paper did not compare.
NOT_IN_QUICK = (
    *OTHER_KERNELS,
    *("honv", "curvature", "pfh", "fpfh", "objects_20", "real_gall", "real_paper"),
    *("final_depth_by_pixel", "linemod_no_check", "real_linemod_no_check"),
)

# The same forest under two names: the study's baseline is the profile, as is the one with five scales.
SAME_FOREST = {"intensity": "gall", "five": "gall"}

SCENES_20 = tuple(f"objects_20_{letter}" for letter in "abcdef")  # each holds the four and half of sixteen others
FEATURE_SCENE = "table_small_1"
SCALE_SCENES = ("table_small_1", "desk_2", "table_small_2")
STRIDES = (1, 2, 3, 4, 6, 8)
OTHER_SENSOR = "time_of_flight"  # training and all other scenes are rendered with structured_light
OTHER_SENSOR_SCENES = ("table_small_1", "desk_2", "kitchen_small_1")


def forest_of(what):
    return SAME_FOREST.get(what, what)


def is_gall(what):
    """Of the family of the original, which looks at every pixel in several sizes of the image and takes its time."""
    return TRAINING[forest_of(what)][:2] == PROFILES["gall"]


def trainer(what):
    """The words that start it."""
    return ("hs-study", "train") if is_gall(what) else ("hs-train",)


def evaluator(what, reference=False):
    return ("hs-study", "evaluate") if is_gall(what) or reference else ("hs-evaluate",)


def detection_options(what, stride=None):
    """Section 4: every patch, detections from a vote confidence of 0.1 on. That is gall's score. The scores of paper and
    realtime are probabilities, which only rank what has as many votes (--min-mass 0.05); both choose their own patch
    offset. Times are measured with the same options as AUC."""
    if is_gall(what):
        return ("--threshold", "0.1", "--stride", str(stride or 1))
    return ("--min-mass", "0.05", "--threshold", "0", *(("--stride", str(stride)) if stride else ()))


RANKED_WISHES = "min-mass=0.05,threshold=0"  # the same for hs-study speed


@dataclasses.dataclass(frozen=True)
class Timing:
    """One way of looking at a frame; Section 5 gives each saving relative to the original."""

    words: str
    forest: str
    threads: int = 0  # 0: all
    reference: bool = False  # the engine that is written for reading
    stride: int = 0  # 0: as where AUC is measured

    def options(self, threads):
        options = (*detection_options(self.forest, self.stride), "--threads", self.threads or threads)
        return (*options, "--reference") if self.reference else options


TIMINGS = {
    "original": Timing("original: RGB, five scales, reference engine, one thread", "gall", 1, True),
    "half_size": Timing("image at half size (5.1.1)", "half_size", 1, True),
    "depth_normalisation": Timing("depth normalisation (5.1.2)", "normalised", 1, True),
    "stride_2": Timing("stride 2, whole pipeline (5.1.3)", "gall", 1, True, 2),
    "all_threads": Timing("all threads (5.2.2; the paper used five)", "gall", 0, True),
    "fast_engine": Timing("original, fast engine, all threads", "gall"),
    "fast_engine_one_thread": Timing("original, fast engine, one thread", "gall", 1),
    "final": Timing("profile paper, fast engine, all threads", "paper"),
    "realtime": Timing("profile realtime, fast engine, all threads", "realtime"),
    "realtime_one_thread": Timing("profile realtime, fast engine, one thread", "realtime", 1),
}

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
DETECTOR_NAMES = {  # of Figure 6
    "linemod": "LINEMOD with depth check",
    "linemod_no_check": "LINEMOD without it",
    "gall": "gall (RGB Hough Forest)",
    "paper": "paper (its final version)",
    "realtime": "realtime (ours)",
}
LEFT_OUT_NAMES = {
    **FEATURE_NAMES,
    "objects_20": "twenty objects",
    "real_gall": "gall on recorded pictures",
    "real_paper": "paper on recorded pictures",
    "linemod_no_check": "LINEMOD without depth check",
    "real_linemod_no_check": "the same on recorded pictures",
}
