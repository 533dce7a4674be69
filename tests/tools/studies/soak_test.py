"""Tests of what tools/soak sends and counts. Usage: PYTHONPATH=tools:build/python soak_test.py"""

import argparse
import contextlib
import io
import json
import math
import os
import pathlib
import random
import signal
import struct
import tempfile
import threading
import time
import types
import unittest
import unittest.mock

from studies.wire_patch import utime_of
from studies.soak import __main__ as soak
from studies.soak import faults, frames, long_account, long_run, page, player, relay, wire, work_budget
from studies.stream import ProcessFailed


def frame(sequence=b"12"):
    key = frames.SEQUENCE
    return (struct.pack(">qq", 7, 1000) + b"x" * 100_000 + struct.pack(">i", len(key) + 1) + key + b"\0"
            + struct.pack(">i", len(sequence)) + sequence + b"rest")  # fmt: skip


class Said:
    """A process that has said something."""

    def __init__(self, words):
        folder = tempfile.mkdtemp()
        self.log = pathlib.Path(folder, "log.txt")
        self.log.write_text(words)

    def fail(self, complaint):
        raise ProcessFailed(complaint)


class Wire(unittest.TestCase):
    def test_a_message_in_fragments_is_whole_again_in_any_order(self):
        payload = frame()
        parts = wire.datagrams(5, "CAMERA", payload)
        self.assertEqual(len(parts), 2)
        self.assertEqual(relay.content(parts[::-1]), ("CAMERA", payload))
        magic, number, size, start, index, count = wire.LONG_HEADER.unpack_from(parts[1])
        self.assertEqual((magic, number, size, index, count), (wire.LONG, 5, len(payload), 1, 2))
        self.assertEqual(parts[1][wire.LONG_HEADER.size :], payload[start:])

    def test_a_small_message_is_one(self):
        self.assertEqual(wire.datagrams(5, "A", b"xyz"), [struct.pack(">II", wire.SHORT, 5) + b"A\0xyz"])


class Frames(unittest.TestCase):
    def test_numbers_of_any_length(self):
        for number in frames.FORGED:
            forged = frames.with_number(frame(), number)
            self.assertEqual(utime_of(forged), 1001)
            self.assertTrue(forged.endswith(struct.pack(">i", len(str(number))) + str(number).encode() + b"rest"))


class Counts(unittest.TestCase):
    WORDS = "12:00:00.000 hs-detect: ends: 290 received, 200 processed, 80 skipped, 10 lost, 10 refused; 3 duplicates\n"

    def test_an_account_is_read_and_added_up(self):
        counts = faults.account(Said(self.WORDS))
        self.assertEqual(counts, {"received": 290, "processed": 200, "skipped": 80, "lost": 10, "refused": 10, "duplicates": 3})
        self.assertTrue(faults.adds_up(300, counts))
        self.assertFalse(faults.adds_up(301, counts))
        with self.assertRaises(ProcessFailed):
            faults.account(Said("nothing\n"))

    def test_what_was_said_is_told_once(self):
        self.assertEqual(faults.said(Said("12:00:00.000 a x\n12:00:01.000 a x\n12:00:01.000 b\n"), "x"), ["a x"])

    def test_the_page_names_each_fault(self):
        seen = {"good": True, "sent": 3, "processed": 2, "skipped": 0, "lost": 1, "refused": 0, "load": 0.1, "reported": ["words"],
                "about": {"commit": "first"}}  # fmt: skip
        kill = {"good": False, "failed": "why", "load": 2.0, "about": {"commit": "second"}}
        text = page.page({"faults": {"loss": seen, "kill": kill}, "long": {}})
        self.assertIn("| loss | good | 3 sent = 2 + 0 + 1 + 0 | – | 0.1 | first |", text)
        self.assertIn("| kill | **WRONG** |", text)
        self.assertIn("    words\n", text)
        self.assertIn("failed why", text)


def sampled(minutes, mb=lambda _: 50.0, descriptors=lambda _: 12):
    """Every five seconds; both functions are of the minute."""
    return [{"s": s, "mb": mb(s / 60), "descriptors": descriptors(s / 60), "threads": 4, "cpu_s": 0.5 * s}
            for s in range(0, 60 * minutes + 1, 5)]  # fmt: skip


class LongAccount(unittest.TestCase):
    def test_what_is_taken_before_minute_two_is_no_growth(self):
        taken = long_account.cost(sampled(60, lambda minute: 40.0 if minute < 2 else 50.0))
        self.assertEqual((taken["memory_mb"], taken["cores"], taken["growing"]), (50.0, 0.5, []))
        self.assertEqual([taken[key] for key in ("growth_per_hour", "rise", "swing")], [0.0] * 3)

    def judged(self, mb, minutes=60, seed=1):
        """What is said of memory that is so, but for what it varies by from one sample to the next."""
        noise = random.Random(seed)
        taken = long_account.cost(sampled(minutes, lambda minute: mb(minute) * noise.gauss(1.0, 0.002)))
        return list(long_account.wrong_of_process("pose", taken))

    def test_memory_may_swing(self):
        for period in (0.5, 3, 10, 20, 40):
            for phase in range(8):
                angle = lambda minute: 2 * math.pi * (minute / period + phase / 8)  # noqa: E731
                self.assertEqual(self.judged(lambda minute: 50 + 2 * math.sin(angle(minute))), [], (period, phase))
        self.assertEqual(self.judged(lambda minute: 55.0 if 30 <= minute < 31 else 50.0), [], "a minute of 10 % more")
        for seed in range(20):
            jumps = random.Random(seed)
            levels = [50 * jumps.uniform(0.96, 1.04) for _ in range(61)]
            self.assertEqual(self.judged(lambda minute: levels[int(minute)]), [], seed)

    def test_memory_may_settle_late(self):
        for minute_of_step in (3, 5, 10):
            self.assertEqual(self.judged(lambda minute: 40.0 if minute < minute_of_step else 50.0), [], minute_of_step)

    def test_memory_may_not_grow(self):
        for seed in range(20):
            said = self.judged(lambda minute: 50 * (1 + 0.01 * minute / 60), seed=seed)
            self.assertEqual(len(said), 1)
            self.assertRegex(said[0], "^hs-pose: memory grows by (0.9|1.0|1.1)% an hour, surely by (0.[89]|1.0)%, expected at most 0.5%$")
        swinging = self.judged(lambda minute: 50 * (1 + 0.1 * minute / 60) + 2 * math.sin(2 * math.pi * minute / 10))
        self.assertRegex(swinging[0], "memory grows by (9|10|11).[0-9]% an hour")
        self.assertRegex(self.judged(lambda minute: 50 + minute // 10)[0], "memory grows by")
        self.assertEqual(self.judged(lambda minute: 50 * (1 - 0.1 * minute / 60)), [], "it may shrink")

    def test_memory_may_not_rise_and_stay_there(self):
        self.assertRegex(self.judged(lambda minute: 50.0 if minute < 30 else 52.0)[0], "memory (has risen|grows) by")
        self.assertEqual(self.judged(lambda minute: 50.0 if minute < 3 else 52.0), [])
        self.assertRegex(self.judged(lambda minute: 50.0 + minute, minutes=8)[0], "memory (has risen|grows) by")

    def test_a_run_that_is_too_short_says_nothing_of_growth(self):
        for minutes in (0, 1, 2):
            self.assertEqual(self.judged(lambda _: 50.0, minutes=minutes), [])

    def test_a_descriptor_that_stays_open_grows_one_that_comes_and_goes_does_not(self):
        now_and_then = long_account.cost(sampled(10, descriptors=lambda minute: 13 if minute % 1 < 0.5 else 12))
        self.assertEqual((now_and_then["descriptors"], now_and_then["growing"]), ([12, 13], []))
        kept = long_account.cost(sampled(10, descriptors=lambda minute: 13 if minute > 6 else 12))
        self.assertEqual(kept["growing"], ["descriptors"])

    def test_a_short_run_is_looked_at_in_quarters_of_its_second_half(self):
        windows = long_account.windows(sampled(2))
        self.assertEqual([window[0]["s"] for window in windows], [60, 75, 90, 105])
        self.assertEqual(len(long_account.windows(sampled(0))), 1)

    def test_frames_are_accounted_for_from_process_to_process(self):
        self.assertEqual(long_account.captured("1:2 hs-capture: 100 frames of 9.5 kB to F, 3.3 s, 30.0 Hz\n"), (100, 30.0))
        self.assertIsNone(long_account.captured("hs-capture: no camera\n"))
        names = ("received", "processed", "skipped", "lost", "refused")
        counts = {name: dict(zip(names, each)) for name, each in
                  (("detect", (99, 97, 2, 1, 0)), ("pose", (97, 97, 0, 0, 0)), ("track", (96, 96, 0, 0, 0)))}  # fmt: skip
        told = long_account.accounts(100, counts)
        self.assertEqual([one["missing"] for one in told.values()], [1, 0, 1])
        self.assertEqual(told["detect"]["passed_over"], 0.0202)
        self.assertIsNone(long_account.looks_of("hs-pose: ends: 97 received"))
        looks = long_account.looks_of("hs-pose: looks: 95 came, 91 answered, 4 passed over for newer ones\n")
        self.assertEqual(looks, {"came": 95, "answered": 91, "passed_over": 4})
        twice = counts["track"] | {"received": 96 + 91, "skipped": 91}  # an answer is a second result of its frame
        followed = long_account.accounts(100, counts | {"pose": counts["pose"] | {"received": 100}, "track": twice}, looks)
        self.assertEqual([one["missing"] for one in followed.values()], [1, 2, 1], "two looks did not come to hs-pose")
        self.assertEqual(followed["track"]["passed_over"], 0.0)
        self.assertNotIn("passed_over", followed["detect"], "hs-detect looks at some frames only")
        calm = {"growth_per_hour": 0.0, "growth_surely": 0.0, "rise": 0.0, "growing": []}
        wrong = long_account.wrong({"rate_hz": 30, "sent_hz": 20.0, "processes": {name: one | calm for name, one in told.items()},
                                    "latency_ms": {"poses": {"frames": 0}, "objects": {"frames": 1}}})  # fmt: skip
        self.assertEqual(wrong, ["hs-capture: 20.0 Hz, expected 30", "hs-detect: 1 lost", "hs-detect: 1 missing",
                                 "hs-detect: 2.02% passed over, expected at most 1%", "hs-track: 1 missing",
                                 "no poses have come"])  # fmt: skip

    def test_latency_is_told_of_the_whole_run_and_of_each_minute(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "times.csv")
            file.write_text("utime,channel,t_frame,t_detections,t_poses,t_objects\n1,F,0.0,,0.5,0.75\n2,F,59.0,,59.25,\n"
                            "3,F,61.0,,62.0,\n4,F,62.0,,,\n5,F,,,63.0,\n")  # fmt: skip
            found = long_account.latencies(file)
        self.assertEqual(found["poses"], {"frames": 3, "p50": 500.0, "p99": 1000.0,
                                          "minutes": [{"minute": 0, "p50": 500.0, "p99": 500.0},
                                                      {"minute": 1, "p50": 1000.0, "p99": 1000.0}]})  # fmt: skip
        self.assertEqual((found["objects"]["frames"], found["objects"]["p50"]), (1, 750.0))


class Kept(unittest.TestCase):
    def test_what_is_not_measured_now_stays_with_its_commit(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "summary.json")
            loss = {"good": True, "load": 0.1, "about": {"commit": "older"}}
            file.write_text(json.dumps({"faults": {"loss": loss, "kill": loss}, "long": {"minutes": 60, "good": True}}))
            record = page.Record(pathlib.Path(folder))
            record.note("faults", "kill", {"good": False, "load": 0.2}, "tools/soak --faults-only")
            self.assertFalse(record.good)
            summary = json.loads(file.read_text())
            self.assertEqual(summary["faults"]["loss"], loss)
            self.assertEqual(summary["faults"]["kill"]["about"]["command"], "tools/soak --faults-only")
            self.assertEqual(summary["long"], {}, "it does not say of which commit it is")
            self.assertIn("| 0.1 | older |", pathlib.Path(folder, "report.md").read_text())

    def test_another_file_of_that_name_is_refused_in_a_line(self):
        for text in ("[]x", "[1]", '{"faults": 3}'):
            with tempfile.TemporaryDirectory() as folder:
                pathlib.Path(folder, "summary.json").write_text(text)
                with self.assertRaisesRegex(SystemExit, "summary.json: [^\n]+, expected the JSON that this has written[^\n]*$"):
                    page.Record(pathlib.Path(folder))

    def test_rates_are_numbers_each_once(self):
        self.assertEqual(soak.rates("30,60"), [30, 60])
        for text in ("", "30,", "30,30", "0", "x"):
            with self.assertRaises(argparse.ArgumentTypeError, msg=text):
                soak.rates(text)


class Time(unittest.TestCase):
    def test_what_is_left_is_known_from_the_last_time(self):
        at = [0.0]
        clock = work_budget.WorkBudget(["a", "b", "c"], {"a": 60.0, "b": 120.0, "gone": 1e6}, 600.0, now=lambda: at[0])
        self.assertEqual(clock.words(), "3 left, about 4 min", "c takes as long as the others do")
        clock.begin()
        at[0] = 400.0
        self.assertEqual(clock.done("a"), 400.0)
        self.assertEqual(clock.words(), "2 left, about 6 min; more than the 10 min that it may take")
        clock.pass_over("b")
        self.assertFalse(clock.is_over())
        at[0] = 600.0
        self.assertTrue(clock.is_over())
        clock.pass_over("c")
        self.assertEqual(clock.words(), "none left")

    def test_the_first_time_only_the_limit_is_known(self):
        self.assertEqual(work_budget.WorkBudget(["a"], {}, 2400.0).words(), "1 left, at most 40 min")

    def test_faults_end_in_time_and_what_was_not_run_is_told(self):
        ran = []

        def fault(name, good):
            return name, lambda: ran.append(name) or {"good": good}

        def broken():
            raise ProcessFailed("died")

        earlier = {"first": {"seconds": 30.0}, "second": {"good": True}}
        with contextlib.redirect_stdout(io.StringIO()) as words:
            seen = dict(soak.run_faults([fault("first", True), ("second", broken)], earlier))
        self.assertEqual((ran, seen["first"]["good"], seen["second"]["failed"]), (["first"], True, "died"))
        self.assertIn("2 left, about 1 min", words.getvalue())
        self.assertIn("none left", words.getvalue())
        with unittest.mock.patch.object(soak, "FAULTS_S", 0), contextlib.redirect_stdout(io.StringIO()):
            seen = dict(soak.run_faults([fault("third", True)], {}))
        self.assertEqual(ran, ["first"])
        self.assertRegex(seen["third"]["failed"], "^not run")
        self.assertNotIn("seconds", seen["third"], "it says nothing of the next time")


class Player(unittest.TestCase):
    def test_each_frame_has_the_present_time_and_its_own_number(self):
        payload = struct.pack(">qq", 1, 2) + struct.pack(">i", len(frames.SEQUENCE) + 1) + frames.SEQUENCE + b"\0"
        payloads = [payload + struct.pack(">i", 1) + b"7" + place for place in (b"first", b"second", b"third")]
        sent = []
        sender = types.SimpleNamespace(send=lambda channel, message: sent.append((channel, message)))
        before = time.time_ns() // 1000
        self.assertEqual(player.play(payloads, sender, 200.0, lambda: len(sent) == 5), 5)
        times = [utime_of(message) for _, message in sent]
        self.assertEqual({channel for channel, _ in sent}, {frames.FRAME})
        self.assertEqual(times, sorted(set(times)), "no two frames of a camera have one time")
        self.assertLessEqual(before, times[0])
        self.assertGreaterEqual(times[-1] - times[0], 4 * 4_000)
        for number, place in enumerate((b"first", b"second", b"third", b"second", b"first")):
            entry = frames.SEQUENCE + b"\0" + struct.pack(">i", 1) + b"%d" % number
            self.assertTrue(sent[number][1].endswith(entry + place), "forwards, then backwards")


# Says that it is ready, and in the end what the program in whose place it is says.
STAND_IN = """#!/usr/bin/python3
import os, signal, sys, time
name = os.path.basename(sys.argv[0])
def end(*_):
    if name == "hs-capture":
        print("1:2 hs-capture: 100 frames of 9.5 kB to F, 3.3 s, 30.0 Hz", flush=True)
    elif name == "hs-observe":
        with open(sys.argv[sys.argv.index("--csv") + 1], "w") as csv:
            csv.write("utime,channel,t_frame,t_detections,t_poses,t_objects\\n1,F,0.0,0.01,0.02,0.03\\n")
    else:
        print(f"1:2 {name}: ends: 100 received, 100 processed, 0 skipped, 0 lost, 0 refused", flush=True)
    sys.exit()
signal.signal(signal.SIGINT, end)
print("ready", *sys.argv, flush=True)
time.sleep(60)
"""


class Long(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.folder = pathlib.Path(place.name)
        for name in ("hs-capture", "hs-detect", "hs-pose", "hs-track", "hs-observe"):
            (self.folder / name).write_text(STAND_IN)
            (self.folder / name).chmod(0o755)
        self.options = types.SimpleNamespace(programs=self.folder, data=self.folder / "data", minutes=1, rate=[30, 60],
                                             together=True, follow=False, play=False)  # fmt: skip

    def end_when_all_run(self, how):
        """From a thread, once both cameras are ready."""

        def wait_and_end():
            logs = [self.folder / f"long_{rate}" / "capture.txt" for rate in (30, 60)]
            while not all(log.exists() and "ready" in log.read_text() for log in logs):
                time.sleep(0.02)
            how()

        threading.Thread(target=wait_and_end, daemon=True).start()

    def test_a_run_that_is_ended_keeps_what_it_has(self):
        self.end_when_all_run(lambda: os.kill(os.getpid(), signal.SIGTERM))
        seen = dict(long_run.long_runs(self.options, self.folder))
        self.assertEqual(set(seen), {30, 60})
        for rate, one in seen.items():
            self.assertNotIn("failed", one)
            self.assertEqual((one["of_minutes"], one["beside_hz"], one["sent"]), (1, [90 - rate], 100))
            self.assertLess(one["minutes"], 1.0)
            self.assertEqual(one["latency_ms"]["objects"], {"frames": 1, "p50": 30.0, "p99": 30.0})
            self.assertEqual(one["processes"]["track"]["received"], 100)
            kept = json.loads((self.folder / f"long_run_{rate}.json").read_text())
            self.assertEqual(set(kept["samples"]), set(long_account.CHAIN))
            self.assertTrue((self.folder / f"long_run_{rate}.png").read_bytes().startswith(b"\x89PNG"))
        self.assertEqual(seen[60]["wrong"][0], "hs-capture: 30.0 Hz, expected 60")
        buses = {(self.folder / f"long_{rate}" / "track.txt").read_text().split(":")[2].split("?")[0] for rate in seen}
        self.assertEqual(buses, {"7668", "7669"})

    def test_a_process_that_dies_is_told_and_its_run_is_written(self):
        (self.folder / "hs-pose").write_text(STAND_IN.replace("time.sleep(60)", 'time.sleep(0.5)\nsys.exit("out of memory")'))
        self.options.rate, self.options.together = [30], False
        _, seen = next(iter(long_run.long_runs(self.options, self.folder)))
        self.assertFalse(seen["good"])
        self.assertRegex(seen["failed"], "(?s)pose ended.*out of memory")
        self.assertEqual(seen["latency_ms"]["poses"]["frames"], 1, "others have ended as they do")
        self.assertTrue((self.folder / "long_run_30.json").exists())


if __name__ == "__main__":
    unittest.main()
