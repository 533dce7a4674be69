"""The figures of the paper (Haensch, Kaiser, Hellwich, VISAPP 2017): only what its text states in numbers."""

BASELINE_AUC = 0.576  # Section 4.1
# Section 4: gain over the baseline; AUC where the text states it.
FEATURES = {
    "intensity": {"auc": BASELINE_AUC, "gain": 0.0},
    "depth_value": {"auc": 0.768, "gain": 0.33},
    "depth_derivatives_7": {"gain": 0.20},  # "at least"
    "depth_hog": {"gain": 0.34},
    "honv": {"gain": 0.23},
    "curvature": {"gain": 0.30},
    "pfh": {"gain": 0.29},
    "final": {"auc": 0.834, "gain": 0.46},
}
NORMALISATION_GAIN_DESK_2 = 0.12  # Section 5.1.2
STRIDE_2 = {"time": -0.70, "auc": -0.01}  # Section 5.1.3, of classification and voting
SAVINGS = {"half_size": -0.75, "depth_normalisation": -0.77, "stride_2": -0.40, "all_threads": -0.75}  # Section 5
SECONDS = {"original": 53.0, "final": 2.0}  # Sections 5 and 6


def feature_auc(feature):
    """Returns the figure as stated, else from the gain over the baseline; None where the paper has no figure for it."""
    known = FEATURES.get(feature)
    if known is None:
        return None
    return known.get("auc", round(BASELINE_AUC * (1.0 + known["gain"]), 3))
