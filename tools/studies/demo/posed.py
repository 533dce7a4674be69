"""Published poses by frame, and hs-view's image of the frame that shows most of them."""

from houghstream import object_pose_t, object_poses_t
from houghstream.event_log import DamagedLog, read_log
from studies.command import die

PUBLISHED = (object_pose_t.VALID, object_pose_t.VALID_UP_TO_SYMMETRY)


def poses_by_frame(log, is_growing=False):
    """{utime: published poses, of objects that are followed and of detections}. Of a log that is being written, what is whole of it."""
    found = {}
    try:
        for _, channel, data in read_log(log):
            if channel == "HOUGHSTREAM_POSES":
                message = object_poses_t.decode(data)
                found.setdefault(message.utime, []).extend(pose for pose in message.poses if pose.status in PUBLISHED)
    except (DamagedLog, FileNotFoundError):
        if not is_growing:
            raise
    return found


def fullness(poses):
    """How many objects have a pose, and the sum of their visible fractions."""
    visible = {}
    for pose in poses:
        visible[pose.class_name] = max(pose.visible_fraction, visible.get(pose.class_name, 0.0))
    return len(visible), sum(visible.values())


def fullest_image(found, folder):
    """hs-view's image of the frame in which most objects have a published pose; of several the one in which most is visible of
    them, then the first."""
    images = {int(file.stem): file for file in folder.glob("*.jpg")}
    drawn = [utime for utime in images if found.get(utime)]
    if not drawn:
        die(f"{folder}: no image of a frame with published poses, expected some")
    return images[max(drawn, key=lambda utime: (*fullness(found[utime]), -utime))]
