"""The image of end_to_end_test.py's scene in which most is detected, as a scene of its own."""

from result_values import detections_by_utime
from houghstream.event_log import read_log
from studies.still_scene import make_still_scene


def fullest_image(made):
    """The number of the image in which most is detected."""
    found = detections_by_utime(read_log(made / "results.log"))
    counts = [sum(one.reported for one in found[utime]) for utime in sorted(found)]
    assert max(counts) > 0, counts
    return counts.index(max(counts))


def make_fullest_scene(made, folder):
    return make_still_scene(made / "scene", folder, fullest_image(made))
