"""The scatter: how far the poses in a stream of the virtual camera are from one another, seen from the true object: a taught
model has a frame of its own on the object, so that only this can be told.

Transforms: rotation as three rows, translation in metres."""

import bisect
import math
import statistics

from studies.demo.live import HALF_PERIOD_US
from studies.records import read_json


def rotation_of(quaternion):
    w, x, y, z = quaternion
    return ((1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
            (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
            (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)))  # fmt: skip


def product(a, b):
    return tuple(tuple(sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)) for i in range(3))


def turned(rotation, vector):
    return tuple(sum(rotation[i][k] * vector[k] for k in range(3)) for i in range(3))


def transposed(rotation):
    return tuple(zip(*rotation))


def seen_from_truth(true, found):
    """The found pose in the frame of the true object: the same in each frame, where poses are right."""
    back = transposed(true[0])
    return product(back, found[0]), turned(back, [f - t for f, t in zip(found[1], true[1])])


def degrees_between(a, b):
    trace = sum(product(transposed(a), b)[i][i] for i in range(3))
    return math.degrees(math.acos(max(-1.0, min(1.0, (trace - 1) / 2))))


def scatter(relative):
    """Returns how far the poses are, in the frame of the true object, from the one that is nearest to all others: median and 95
    %."""
    if not relative:
        return {}
    middle = [statistics.median(axis) for axis in zip(*(where for _, where in relative))]
    off_mm = sorted(1e3 * math.dist(where, middle) for _, where in relative)
    some = relative[:: max(1, len(relative) // 60)]
    centre = min(some, key=lambda one: sum(degrees_between(one[0], other[0]) for other in some))[0]
    off_deg = sorted(degrees_between(centre, rotation) for rotation, _ in relative)
    return {f"{name}_{p}": round(values[min(len(values) - 1, p * len(values) // 100)], 2)
            for name, values in (("mm", off_mm), ("deg", off_deg)) for p in (50, 95)}  # fmt: skip


def true_poses(scene):
    """The object's pose in each image of the take."""
    truth = read_json(scene / "scene_gt.json")
    poses = []
    for image in sorted(truth, key=int):
        entry = truth[image][0]
        r = entry["cam_R_m2c"]
        poses.append(((r[0:3], r[3:6], r[6:9]), [1e-3 * t for t in entry["cam_t_m2c"]]))
    return poses


def images_taken(file):
    """(utime, number) of each shutter, by time. The camera plays its scene forwards, then backwards."""
    return sorted((int(words[2]), int(words[0])) for words in map(str.split, file.read_text().splitlines()))


def image_at(taken, utime, count):
    """Returns which of the scene's images was taken then; None where none was."""
    place = bisect.bisect_left(taken, (utime, 0))
    nearest = min(taken[max(place - 1, 0) : place + 1], key=lambda shutter: abs(shutter[0] - utime), default=None)
    if nearest is None or abs(nearest[0] - utime) > HALF_PERIOD_US:
        return None
    index = nearest[1] % (2 * count)
    return index if index < count else 2 * count - 1 - index


def pose_figures(posed, scene, shutter):
    truth, taken = true_poses(scene), images_taken(shutter)
    relative = []
    for utime, detection in posed:
        image = image_at(taken, utime, len(truth))
        pose = detection["pose"]
        if image is not None:
            relative.append(seen_from_truth(truth[image], (rotation_of(pose["quat"]), pose["trans"])))
    return scatter(relative)
