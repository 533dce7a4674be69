"""A clock that is set, and frames that come out of their order, while known objects are followed: what is followed and
what has a number stays what it is."""

import time

from houghstream import object_pose_t, object_poses_t, objects_t
from studies.soak.faults import HEARD, RESULTS, SENT, Faults, account, adds_up, said
from studies.soak.frames import FrameSender
from studies.soak.relay import Chances, Relay
from studies.soak.wire import Listener

FRAME_US = 33_333
HOUR_US = 3_600_000_000
YEAR_US = 8760 * HOUR_US
BACK_WITHIN_S = 2.0
OBJECTS = "HOUGHSTREAM_OBJECTS"


def followed_in(heard):
    """Valid poses of what is followed; None for an answer to detections."""
    poses = object_poses_t.decode(heard.payload).poses
    if any(pose.detection_index >= 0 for pose in poses):
        return None
    return sum(pose.status == object_pose_t.VALID for pose in poses)


class ClockFaults(Faults):
    """Each function is one fault; it returns what it saw, with "good"."""

    def line(self, folder):
        """hs-detect that looks seldom, hs-pose that follows, hs-track; each ready."""
        processes = []
        try:
            processes.append(self.worker(folder, "hs-detect", "--looks-per-second", 5))
            processes.append(self.worker(folder, "hs-pose", "--follow"))
            processes.append(self.worker(folder, "hs-track"))
        except Exception:
            for process in processes:
                process.kill()
            raise
        return processes

    def through_line(self, name, send):
        """Returns what is received while `send` sends frames to the line, and the processes, which have ended."""
        processes = self.line(self.folder(name))
        listener = Listener(HEARD, [*RESULTS.values(), OBJECTS])
        try:
            send()
            time.sleep(1.0)
            for process in processes:
                process.stop(5.0)
        finally:
            listener.stop()
            for process in processes:
                process.kill()
        return listener.heard, processes

    def clock_set(self):
        """Set back by an hour, and forward again: results are there within two seconds, in one and the same world."""
        steps = (0, -HOUR_US, 0)
        first = int(time.time() * 1e6)
        times = [first + FRAME_US * number + steps[len(steps) * number // (2 * self.frames)]
                 for number in range(2 * self.frames)]  # fmt: skip
        part = 2 * self.frames // len(steps)
        heard, processes = self.through_line("clock_set", lambda: FrameSender(self.recording, HEARD).send(times))
        places = {utime: number for number, utime in enumerate(times)}
        useful = {
            "detections": [one.utime for one in heard[RESULTS["detect"]]],
            "poses": [one.utime for one in heard[RESULTS["pose"]] if one.payload and followed_in(one)],
            "objects": [one.utime for one in heard[OBJECTS]],
        }
        back_s = {}
        for kind, utimes in useful.items():
            numbers = sorted(places[utime] for utime in utimes if utime in places)
            after = [min((number - begin for number in numbers if number >= begin), default=2 * self.frames) for begin in (part, 2 * part)]
            back_s[kind] = [round(frames * FRAME_US * 1e-6, 2) for frames in after]
        worlds = sorted({objects_t.decode(one.payload).world_number for one in heard[OBJECTS] if one.payload})
        good = all(time_s <= BACK_WITHIN_S for each in back_s.values() for time_s in each) and worlds == [1]
        return {"back_after_s": back_s, "worlds": worlds, "reported": said(processes[2], "clock|world"), "good": good}

    def wrong_stamp(self):
        """One frame dated a year ahead, one a year ago: everybody's world goes on, and its numbers."""
        first = int(time.time() * 1e6)
        wrong = {self.frames // 2: YEAR_US, 3 * self.frames // 4: -YEAR_US}
        times = [first + FRAME_US * number + wrong.get(number, 0) for number in range(self.frames)]
        heard, processes = self.through_line("wrong_stamp", lambda: FrameSender(self.recording, HEARD).send(times))
        worlds = [objects_t.decode(one.payload) for one in heard[OBJECTS] if one.payload]
        numbers = {when: sorted({one.track_id for world in worlds for one in world.objects
                                 if is_of(world.utime - first)})
                   for when, is_of in (("before", lambda us: us < FRAME_US * self.frames // 2),
                                       ("after", lambda us: us > FRAME_US * self.frames // 2))}  # fmt: skip
        counted = sorted({world.world_number for world in worlds})
        last = worlds[-1].utime - first if worlds else 0
        good = counted == [1] and set(numbers["before"]) <= set(numbers["after"]) and last > FRAME_US * 0.9 * self.frames
        return {"worlds": counted, "numbers": numbers, "reported": said(processes[2], "clock|world"), "good": good}

    def overtaken(self):
        """Frames that are swapped cost the followed objects one frame each at most; the poses of the frames that were worked
        on are counted beside a run in which nothing is swapped."""
        shares, seen = {}, {}
        for name, chances in (("in order", Chances()), ("swapped", Chances(swap=0.1))):
            relay = Relay(SENT, HEARD, self.frames, chances)
            first = int(time.time() * 1e6)
            times = [first + FRAME_US * number for number in range(self.frames)]
            try:
                heard, processes = self.through_line(f"overtaken_{name.split()[0]}", lambda: FrameSender(self.recording, SENT).send(times))
            finally:
                relay.stop()
            late = set(times[self.frames // 3 :])  # by then something is followed
            counted = [followed_in(one) for one in heard[RESULTS["pose"]] if one.payload and one.utime in late]
            followed = [count for count in counted if count is not None]
            shares[name] = round(sum(followed) / max(1, len(followed)), 3)
            seen[name] = {"relay": dict(relay.counts), "hs-pose": account(processes[1])}
        least = 0.8  # of them: a swapped frame leaves a gap, and a busy machine passes over others
        good = (shares["in order"] > 0 and shares["swapped"] >= least * shares["in order"]
                and all(adds_up(one["hs-pose"]["received"], {**one["hs-pose"], "lost": 0}) for one in seen.values()))  # fmt: skip
        return {"valid_poses_a_frame": shares, **seen, "good": good}

    def all(self):
        yield "the clock set back an hour and forward, objects followed", self.clock_set
        yield "one frame dated a year ahead, one a year ago, objects followed", self.wrong_stamp
        yield "10 % overtaken, objects followed", self.overtaken
