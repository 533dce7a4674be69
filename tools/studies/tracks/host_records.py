"""The record of the third host of hosts.py on the two others: how often, how late, and what becomes of a lost one's objects."""

from houghstream import object_pose_t, object_poses_t, objects_t, tracked_object_t
from houghstream.event_log import read_log
from studies.wire_patch import utime_of
from studies.records import percentiles


class Record:
    """The messages that the third host received, with times in seconds."""

    def __init__(self, log):
        self.frames, self.poses = {}, []  # times by utime; (time, utime, names of valid poses)
        self.worlds = []  # (time, utime, {name: (state, probability)})
        for timestamp, channel, data in read_log(log):
            if channel == "OPENNI_FRAME":
                self.frames[utime_of(data)] = timestamp * 1e-6
            elif channel == "HOUGHSTREAM_POSES":
                poses = object_poses_t.decode(data).poses
                valid = {pose.class_name for pose in poses if pose.status == object_pose_t.VALID}
                self.poses.append((timestamp * 1e-6, utime_of(data), valid))
            elif channel == "HOUGHSTREAM_OBJECTS":
                world = objects_t.decode(data).objects
                objects = {one.class_name: (one.state, one.probability) for one in world}
                self.worlds.append((timestamp * 1e-6, utime_of(data), objects))


def figures(record, begin, end, parts):
    """Between two times: for each host's objects how often there were poses of them and how old the frame was by then, and
    the same of the world; and how many objects it held in the end."""

    def told(results):
        first = {}  # of several results of a frame the first one
        for when, utime, _ in results:
            if utime in record.frames and begin <= record.frames[utime] < end:
                first.setdefault(utime, when - record.frames[utime])
        return {
            "hz": round(len(first) / (end - begin), 2),
            **percentiles([1e3 * age for age in first.values()], (50, 99), "_ms"),
        }

    sent = sum(begin <= when < end for when in record.frames.values())
    out = {"sent_hz": round(sent / (end - begin), 2)}
    for host, objects in parts.items():
        out[host] = told([pose for pose in record.poses if pose[2] & set(objects)])
    out["world"] = told(record.worlds)
    last = world_at(record, end)
    for host, objects in parts.items():
        out[host]["objects"] = sum(state == tracked_object_t.VISIBLE for name, (state, _) in last.items() if name in objects)
    return out


def world_at(record, end):
    """The last one before a time."""
    before = [objects for when, _, objects in record.worlds if when < end]
    return before[-1] if before else {}


def seconds_until(record, begin, objects, reached):
    """Returns the time from `begin` until a world in which that is so of the objects' states, or None."""
    for when, _, world in record.worlds:
        if when >= begin and reached([world[name][0] for name in objects if name in world]):
            return round(when - begin, 2)
    return None


def lost_host(record, times, parts, said):
    """Returns what becomes of host b's objects from the pulling of its cable on, and when they are back."""
    cut, joined = times["cut"], times["joined"]
    objects = {name for name in world_at(record, cut) if name in parts["b"]}
    aged = [probability for name, (_, probability) in world_at(record, joined).items() if name in objects]
    back = next((when for when, _, names in record.poses if when >= joined and names & set(parts["b"])), None)
    visible = seconds_until(record, back, objects, lambda states: tracked_object_t.VISIBLE in states) if back else None
    return {
        "objects": len(objects),
        "said_s": said,
        "unseen_s": seconds_until(record, cut, objects, lambda states: tracked_object_t.VISIBLE not in states),
        "gone_s": seconds_until(record, cut, objects, lambda states: all(state == tracked_object_t.GONE for state in states)),
        "probability_in_the_end": round(min(aged), 3) if aged else None,
        "others": figures(record, cut, joined, parts)["a"],
        "back_s": round(back - joined, 2) if back else None,
        "visible_again_s": round(back - joined + visible, 2) if visible is not None else None,
    }
