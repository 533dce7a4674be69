"""Faults of frames on their way, each of which is accounted for."""

import random
import time

from studies.soak.faults import HEARD, RESULTS, SENT, Faults, account, adds_up, said
from studies.soak.frames import FrameSender
from studies.soak.relay import Chances, Relay
from studies.soak.wire import Listener, rubbish

FRAME_US = 33_333
HOUR_US = 3_600_000_000


class FrameFaults(Faults):
    """Each function is one fault; it returns what it saw, with "good"."""

    def counted(self, name, chances, meanwhile=None, restarts=1):
        """Frames through the relay: those that were sent are those that are accounted for."""
        folder = self.folder(name)
        detector = self.worker(folder, "hs-detect")
        passed = {}
        try:
            for run in range(restarts):
                relay = Relay(SENT, HEARD, self.frames, chances, seed=run + 1)
                try:
                    capture = self.capture(folder, f"capture{run}", SENT)
                    if meanwhile:
                        meanwhile()
                    capture.wait(60 + self.frames)
                    time.sleep(0.5)
                finally:
                    relay.stop()
                passed = {key: passed.get(key, 0) + count for key, count in relay.counts.items()}
            detector.stop(5.0)
        finally:
            detector.kill()
        counts = account(detector)
        sent = restarts * self.frames + passed["forged"]
        return {"sent": sent, "relay": passed, **counts, "reported": said(detector, "ends:|refused"),
                "good": adds_up(sent, counts)}  # fmt: skip

    def forged(self):
        """Rubbish and messages that name themselves frames, among them statuses of processes that do not exist."""
        draw = random.Random(5)
        payloads = [draw.randbytes(200) for _ in range(100)]

        def send():
            rubbish(HEARD, "HOUGHSTREAM_STATUS", payloads)
            rubbish(HEARD, "OPENNI_FRAME", payloads)

        seen = self.counted("forged", Chances(), meanwhile=send)
        seen["sent"] += len(payloads)
        seen["good"] = seen["refused"] >= len(payloads) and adds_up(seen["sent"], seen)
        return seen

    def clock_jumps(self):
        """The camera's clock jumps an hour ahead and, later, back: results go on, each under its frame's own time."""
        folder = self.folder("clock_jumps")
        third = self.frames // 3
        first = int(time.time() * 1e6)
        times = [first + FRAME_US * number + (HOUR_US if third <= number < 2 * third else 0)
                 for number in range(self.frames)]  # fmt: skip
        detector, pose = self.worker(folder, "hs-detect"), self.worker(folder, "hs-pose")
        listener = Listener(HEARD, RESULTS.values())
        try:
            FrameSender(self.recording, HEARD).send(times)
            time.sleep(1.0)
            for process in (detector, pose):
                process.stop(5.0)
        finally:
            listener.stop()
            detector.kill()
            pose.kill()
        counts, of_poses = account(detector), account(pose)
        parts = [set(times[:third]), set(times[third : 2 * third]), set(times[2 * third :])]
        results = {name: [sum(one.utime in part for one in listener.heard[RESULTS[name]]) for part in parts]
                   for name in ("detect", "pose")}  # fmt: skip
        good = (adds_up(self.frames, counts) and adds_up(of_poses["received"], {**of_poses, "lost": 0})
                and min(results["detect"] + results["pose"]) > 0)  # fmt: skip
        return {"sent": self.frames, **counts, "results_before_between_after": results, "hs-pose": of_poses,
                "reported": said(detector, "ends:") + said(pose, "ends:"), "good": good}  # fmt: skip

    def equal_stamps(self):
        """Two cameras whose frames have equal stamps, and lose some: each result is of its own camera's frame."""
        folder = self.folder("equal_stamps")
        cameras = ("CAMERA_1", "CAMERA_2")
        first = int(time.time() * 1e6)
        detector = self.worker(folder, "hs-detect", "-c", "CAMERA_[12]")
        pose = self.worker(folder, "hs-pose", "-c", "CAMERA_[12]")
        listener = Listener(HEARD, [*RESULTS.values(), *cameras])
        relay = Relay(SENT, HEARD, self.frames, Chances(lose=0.05, swap=0.05))
        try:
            FrameSender(self.recording, SENT).send(
                [first + FRAME_US * number for number in range(self.frames)], cameras, rate=15.0)  # fmt: skip
            time.sleep(1.0)
            for process in (detector, pose):
                process.stop(5.0)
        finally:
            relay.stop()
            listener.stop()
            detector.kill()
            pose.kill()
        counts, of_poses = account(detector), account(pose)
        passed = {camera: {one.utime for one in listener.heard[camera]} for camera in cameras}
        results = {name: {camera: [one.utime for one in listener.heard[RESULTS[name]] if one.source == camera]
                          for camera in cameras} for name in ("detect", "pose")}  # fmt: skip
        strays = sum(utime not in passed[camera] for each in results.values() for camera, utimes in each.items() for utime in utimes)
        found = {name: {camera: len(utimes) for camera, utimes in each.items()} for name, each in results.items()}
        good = (adds_up(2 * self.frames, counts) and adds_up(of_poses["received"], {**of_poses, "lost": 0})
                and strays == 0 and all(min(each.values()) > 0 for each in found.values()))  # fmt: skip
        return {"sent": 2 * self.frames, "relay": relay.counts, **counts, "results": found, "of_frames_that_did_not_come": strays,
                "hs-pose": of_poses, "reported": said(detector, "ends:") + said(pose, "ends:"), "good": good}  # fmt: skip

    def reversed_start(self):
        """The camera first, then what comes last, then the detector, while frames go by."""
        folder = self.folder("reversed_start")
        capture = self.capture(folder, "capture", HEARD)
        started = []
        try:
            time.sleep(1.0)
            started.append(self.worker(folder, "hs-pose"))
            started.append(self.worker(folder, "hs-detect"))
            capture.wait(60 + self.frames)
            time.sleep(0.5)
            for process in started:
                process.stop(5.0)
        finally:
            capture.kill()
            for process in started:
                process.kill()
        of_poses, counts = map(account, started)
        good = (counts["lost"] == 0 and adds_up(counts["received"], counts) and of_poses["processed"] > 0
                and adds_up(of_poses["received"], {**of_poses, "lost": 0}))  # fmt: skip
        return {**counts, "hs-pose": of_poses, "reported": said(started[1], "ends:"), "good": good}

    def all(self):
        yield "nothing", lambda: self.counted("nothing", Chances())
        yield "5 % of the frames lost", lambda: self.counted("lost", Chances(lose=0.05))
        yield "10 % overtaken", lambda: self.counted("overtaken", Chances(swap=0.1))
        yield "10 % doubled", lambda: self.counted("doubled", Chances(double=0.1))
        yield "5 % with forged sequence numbers", lambda: self.counted("forged_numbers", Chances(forge=0.05))
        yield "all of it, and the camera started three times", lambda: self.counted(
            "mixed", Chances(lose=0.05, swap=0.1, double=0.1, forge=0.03), restarts=3)
        yield "rubbish and forged statuses", self.forged
        yield "the camera's clock jumps an hour ahead and back", self.clock_jumps
        yield "two cameras with equal stamps, 5 % lost, 5 % overtaken", self.equal_stamps
        yield "the camera before poses and detector", self.reversed_start
