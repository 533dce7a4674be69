"""The words of the report: title of each part, what it shows, what the paper says of the same."""

TITLE = "Near real-time object detection in RGB-D data: the comparison, repeated"
LEAD = """Haensch, Kaiser and Hellwich (VISAPP 2017) made a Hough Forest see depth and made it fast. Houghstream repeats
    their comparison with its own programs, on data that anyone can make again, and adds a detector for 30 Hz cameras."""
PROTOCOL = """A detection is true if its box overlaps the object's by IoU 0.5 or more; repeated detections are false; up to
    250 detections of a class count, from a vote confidence of 0.1 on. For gall and its variants that is the score; the scores
    of paper and realtime are probabilities, so there everything counts that has as many votes, a twentieth of a whole
    object's, ranked by probability (--min-mass 0.05 --threshold 0). Precision and recall at the detector's default threshold
    come from the same runs. AUC is the area under the precision/recall curve over all frames of a scene, un-interpolated,
    mean over the objects in the scene and over the training runs; whiskers reach from the worst run to the best. Objects of
    which less than a tenth is visible do not count. The paper measured on camera pictures of the UW RGB-D datasets, on
    another machine: compare changes rather than levels."""
QUICK = """A quick run: one training run; every third frame of a scene, every sixth by gall and its variants, which are
    slow."""
LEFT_OUT = {
    "objects_20": "twenty objects",
    "real_gall": "gall on recorded pictures",
    "real_paper": "paper on recorded pictures",
    "linemod_no_check": "LINEMOD without depth check",
    "real_linemod_no_check": "the same on recorded pictures",
}

SECTIONS = {
    "features curves": (
        "Figure 1: precision and recall with each feature",
        """Each feature is added to the RGB features; the number beside an object is its AUC. The first training run is drawn
        strongly, the others faintly.""",
        """Without depth, coffee mug and soda can do decently, bowl and cereal box stay far below 0.5; with the final features
        precision stays above 0.9 up to a recall of 0.65 (coffee mug) or 0.8 (the others).""",
    ),
    "features": (
        "Figure 2: what each feature is worth",
        """AUC on table_small_1; the mark is the paper's value for the same feature, from the gain it states where it gives no
        AUC. All are trained as the original: tests compare two pixels (half of those on the depth value look at one); in
        the last row those on depth all look at one, as many do in paper and realtime.""",
        """Baseline 0.576; depth HoG helps most (+34 %), the depth value almost as much (+33 %); all three depth-map features
        together reach 0.834 (+46 %).""",
    ),
    "hough": (
        "Figure 3: Hough spaces of one frame",
        "The votes for each object's centre, before depth features and with them.",
        "The ambiguity between bowl and coffee mug almost disappears, and there is less clutter.",
    ),
    "normalisation": (
        "Figure 4: depth normalisation",
        "One search at each pixel's own scale, against five scales of the image and against one.",
        "The mean hardly suffers, desk_2 even gains 12 %, and 77 % of the time is saved.",
    ),
    "stride": (
        "Figure 5: stride",
        """Looking at every Nth pixel only: what remains of AUC and of the time for classification and voting, profile paper on
        table_small_1.""",
        "Stride 2 saves about 70 % of the time and costs 1 % of the AUC.",
    ),
    "final": (
        "Figure 6: final comparison",
        """Six scenes; LINEMOD is taught the distances at which objects stand there, and compares the scene's depth with that of
        the template that fits, or does not.""",
        """The enhanced Hough Forest outperforms both others by far; LINEMOD has a massive amount of false positives (shown as
        curves, without numbers).""",
    ),
    "time": (
        "Time",
        """Section 5: each saving alone, relative to the original with one thread and code written for reading; then the fast
        engine and the final versions.""",
        "53 s a frame for the original, 2 s for the final version (eight-core i7-3770, Titan Black GPU).",
    ),
    "twenty": (
        "More objects",
        "Twenty objects instead of four, on the same frames.",
        "Detection time grows less than linearly with the number of objects.",
    ),
    "real": (
        "Camera-recorded data",
        "Seven taught instances in a room (AUC of all pictures), and clutter in which none of them stands.",
        "",
    ),
    "reliability": (
        "Are the scores probabilities?",
        """Detections in ten bins of their score against the share that is true; bars are 95 % intervals, the dashed line is a
        perfect score. False detections of objects that are in no frame of a scene are not among them.""",
        "",
    ),
    "failures": ("Failures that remain", "The objects that the realtime profile finds worst.", ""),
}
