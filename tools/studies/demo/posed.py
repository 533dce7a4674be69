"""Published poses by frame, and hs-view's image of the frame that shows most of them."""

from houghstream import object_pose_t, object_poses_t
from houghstream.event_log import DamagedLog, read_log
from studies.command import die

PUBLISHED = (object_pose_t.VALID, object_pose_t.VALID_UP_TO_SYMMETRY)


def poses_by_frame(log, is_growing=False):
    """{utime: published poses}: those of objects that are followed, where any are, since they come at once and hs-view draws them; else
    those of detections. Of a log that is being written, what is whole of it."""
    followed, detected = {}, {}
    try:
        for _, channel, data in read_log(log):
            if channel == "HOUGHSTREAM_POSES":
                message = object_poses_t.decode(data)
                for pose in message.poses:
                    if pose.status in PUBLISHED:
                        found = followed if pose.detection_index < 0 else detected
                        found.setdefault(message.utime, []).append(pose)
    except (DamagedLog, FileNotFoundError):
        if not is_growing:
            raise
    return followed or detected


def fullness(poses):
    """How many objects have a pose, less those that have one twice, and the sum of their visible fractions."""
    visible = {}
    for pose in poses:
        visible[pose.class_name] = max(pose.visible_fraction, visible.get(pose.class_name, 0.0))
    return len(visible), len(visible) - len(poses), sum(visible.values())


def fullest_of(found, folder):
    """hs-view's image of the frame in which most objects have a published pose, and how many have; of several one in which none has
    two, then the one in which most is visible of them, then the first. (None, 0) without any."""
    images = {int(file.stem): file for file in folder.glob("*.jpg")}
    drawn = [utime for utime in images if found.get(utime)]
    if not drawn:
        return None, 0
    best = max(drawn, key=lambda utime: (*fullness(found[utime]), -utime))
    return images[best], fullness(found[best])[0]


def fullest_image(found, folder):
    """The image alone. Ends the command where there is none."""
    image, _ = fullest_of(found, folder)
    if image is None:
        die(f"{folder}: no image of a frame with published poses, expected some")
    return image
