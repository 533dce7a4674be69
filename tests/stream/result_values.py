"""Results as values that can be compared; times of stages are left out, they differ from run to run."""

from typing import NamedTuple

from houghstream import detections_t, object_poses_t
from studies.wire_patch import utime_of


class FoundObject(NamedTuple):
    name: str
    class_id: int
    score: float
    box: tuple  # x, y, width, height in pixels
    centre: tuple  # metres
    encoded: bytes  # all that was said of it
    reported: bool


class FoundPose(NamedTuple):
    name: str
    detection_index: int
    status: int  # of object_pose_t
    translation: tuple  # metres


def detections_of(data):
    return [
        FoundObject(
            one.class_name,
            one.class_id,
            one.score,
            (one.box_x, one.box_y, one.box_width, one.box_height),
            tuple(one.centre_camera),
            one.encode(),
            bool(one.reported),
        )
        for one in detections_t.decode(data).detections
    ]


def poses_of(data):
    return [
        FoundPose(one.class_name, one.detection_index, one.status, tuple(one.trans))
        for one in object_poses_t.decode(data).poses
    ]


def detections_by_utime(events):
    """{utime: detections} of those among the (timestamp, channel, data)."""
    return {utime_of(data): detections_of(data) for _, channel, data in events if channel == "HOUGHSTREAM_DETECTIONS"}
