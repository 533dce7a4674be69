"""Tests of the demo's report: accounting for frames, latencies, its page. Usage: PYTHONPATH=tools:build/python demo_test.py"""

import math
import os
import pathlib
import sys
import tempfile
import unittest
from unittest import mock

from houghstream import object_pose_t, object_poses_t, status_t, teaching_t
from houghstream.event_log import Event, write_event
from studies import command, time_left
from studies.demo import followed, live, pose_scatter, report, teach
from studies.demo.__main__ import parse, targets
from studies.demo.posed import fullest_image, poses_by_frame
from studies.records import write_json
from studies.unit_runner import Runner, Store, Units


def observed(received, processed, skipped, on_bus):
    detector = {"received": received, "processed": processed, "skipped": skipped}
    return {"processes": {"hs-detect": detector}, "frames_detected": on_bus, "frames_with_poses": on_bus}


class Words(unittest.TestCase):
    def test_images_are_of_the_rendered_scene_alone(self):
        for other in (("--live",), ("--teach",)):
            with self.assertRaisesRegex(SystemExit, "--pictures are of the rendered scene"):
                parse(["--pictures", "somewhere", *other])


    def test_the_rendered_scene_is_followed_unless_that_is_not_wanted(self):
        self.assertTrue(parse([]).follow)
        self.assertFalse(parse(["--no-follow"]).follow)
        self.assertFalse(parse(["--live"]).follow)
        for other in (("--live",), ("--teach",)):
            with self.assertRaisesRegex(SystemExit, "--no-follow is of the rendered scene"):
                parse(["--no-follow", *other])

    def test_only_what_is_run_is_built(self):
        self.assertIn("hs-track", targets(parse([])))
        self.assertNotIn("hs-spy", targets(parse([])))
        self.assertIn("hs-teach", targets(parse(["--teach"])))


class TimeLeft(unittest.TestCase):
    def test_steps_that_are_done_set_the_pace_of_the_others(self):
        now = [0.0]
        left = time_left.TimeLeft({"scene": 10, "forest": 20, "report": 4}, clock=lambda: now[0])
        left.begin("scene")
        self.assertEqual(left.seconds(), 34)
        now[0] = 20.0  # twice as long as expected
        left.begin("forest")
        self.assertEqual(left.seconds(), 48)
        now[0] = 30.0
        self.assertEqual(left.words(), "about 38 s left")
        now[0] = 300.0  # an estimate that was too small leaves what follows
        self.assertEqual(left.seconds(), 8)
        left.begin("report")
        with self.assertRaisesRegex(KeyError, "no step, expected one of scene, forest, report"):
            left.begin("scne")

    def test_a_unit_that_has_never_run_has_an_expected_time_and_says_how_far_it_is(self):
        units = Units()
        units.add("quick", "", "sh", "-c", "touch {out}", expected_s=1)
        units.add("slow", "", "sh", "-c", "echo 'views: 40 %, about 2 min 03 s left'; sleep 0.5; touch {out}", expected_s=50)
        said = []
        with tempfile.TemporaryDirectory() as folder, mock.patch("studies.unit_runner.SECONDS_APART", 0.2):
            programs = pathlib.Path(folder, "bin")
            programs.mkdir()
            (programs / "sh").symlink_to("/bin/sh")
            Runner(Store(folder, programs, units.all()), tell=said.append, after_s=9).run(units.all())
        self.assertRegex(said[0], r"^\[1/2, 0 s, about 1 min 00 s left\] quick$")
        self.assertRegex(said[1], r"^\[2/2, 0 s, (about \d+ s left|nearly done)\] slow$")
        self.assertRegex(said[2], r"^    views: 40 %, about 2 min 03 s left; all: about 2 min 0[3-6] s left$")

    def test_what_a_program_says_of_its_end_is_understood(self):
        for words, seconds in (("scene: 7 %, about 28 s left", 28), ("a: 1 %, about 1 h 02 min left", 3720), ("tree 2 of 15", 0),
                               ("a: 2 %, about 2 min 03 s left", 123)):  # fmt: skip
            self.assertEqual(time_left.seconds_said(words), seconds)


class Messages(unittest.TestCase):
    def test_they_are_those_that_were_installed_beside_the_programs(self):
        with tempfile.TemporaryDirectory() as folder, mock.patch.object(sys, "path", sys.path[:]), mock.patch.dict(os.environ):
            package = pathlib.Path(folder, "lib/python3.99/dist-packages")
            (package / "houghstream").mkdir(parents=True)
            (package / "houghstream/__init__.py").touch()
            programs = pathlib.Path(folder, "bin")
            programs.mkdir()
            command.know_messages(str(programs))
            self.assertEqual(sys.path[0], os.path.realpath(package))


class Account(unittest.TestCase):
    def test_every_frame_is_accounted_for(self):
        counts = report.account(10, observed(received=9, processed=6, skipped=3, on_bus=6))
        self.assertEqual((counts["frames_lost"], counts["frames_detected"], counts["frames_skipped"]), (1, 6, 3))

    def test_a_hole_in_the_account_ends_the_report(self):
        for wrong in (
            observed(received=9, processed=6, skipped=2, on_bus=6),
            observed(received=9, processed=6, skipped=3, on_bus=5),
            {"processes": {}, "frames_detected": 0},
        ):
            with self.assertRaises(SystemExit):
                report.account(10, wrong)


class LiveReport(unittest.TestCase):
    SHUTTERS = [1_000_000, 1_033_333, 1_066_667]

    def test_a_frame_belongs_to_the_nearest_shutter(self):
        self.assertEqual(live.nearest(self.SHUTTERS, 1_034_000), 1_033_333)
        self.assertEqual(live.nearest(self.SHUTTERS, 1_066_667), 1_066_667)
        self.assertIsNone(live.nearest(self.SHUTTERS, 1_200_000))
        self.assertIsNone(live.nearest([], 1_000_000))

    def test_latency_is_from_the_shutter(self):
        rows = [{"utime": "1000500", "t_poses": "0.080"}, {"utime": "1033400", "t_poses": ""}]
        self.assertEqual(live.latencies_ms(rows, "t_poses", self.SHUTTERS, 1_020_000), [100.0])
        with self.assertRaises(SystemExit):
            live.latencies_ms([{"utime": "5", "t_poses": "1"}], "t_poses", self.SHUTTERS, 0)

    def test_an_unplugged_camera_leaves_a_gap(self):
        rows = [
            {"t_frame": "1.0", "t_poses": "1.1"},
            {"t_frame": "4.5", "t_poses": ""},
            {"t_frame": "4.6", "t_poses": "4.7"},
        ]
        gap = live.unplugging(rows, 1_000_000, 5_000_000)
        self.assertEqual(gap, {"gap_s": 3.5, "frames_back_ms": 500, "poses_back_ms": 700})
        for replugged in (1_500_000, 5_650_000):
            with self.assertRaises(SystemExit):
                live.unplugging(rows, 1_000_000, replugged)

    def test_percentiles_of_a_hundred(self):
        self.assertEqual(live.percentiles(range(1, 101)), {"p50": 51, "p95": 96, "p99": 100})
        self.assertEqual(live.percentiles([])["p99"], None)


def evaluation(auc, recall):
    figures = {
        "auc": {"<bowl>": auc, "mean": auc, "weighted": auc},
        "precision": {"<bowl>": 1.0},
        "recall": {"<bowl>": recall},
    }
    figures |= {"required": {"<bowl>": 10}, "pose_recall_add_s_10": {"<bowl>": recall, "mean": recall}}
    figures |= {"mssd_recall": {"<bowl>": recall / 2, "mean": recall / 2}}
    return figures | {
        "false_detections": 0,
        "rules": {},
        "stage_ms_median": {"detect.leaves": 2.5},
        "bop19": {"ar": {"all": 0.6}},
    }


class Options:
    command, network, real, scene = "tools/demo", "private", None, "desk_1"

    def __init__(self, out, follow=False):
        self.out, self.follow = out, follow


class OneUnit:
    """A replacement of the store: the forest alone."""

    def __init__(self, folder):
        self.folder, self.units = folder, {"forest": "forest"}

    def log(self, unit):
        file = self.folder / "words.txt"
        file.write_text("train_seconds 51.5\n")
        return file

    def record(self, unit):
        return {"command": "hs-train"}


class Report(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.out = pathlib.Path(place.name)
        stream = self.out / "stream"
        latency = {"p50": 20.0, "p95": 25.0, "p99": 31.0}
        counts = {**observed(received=10, processed=8, skipped=2, on_bus=8), "frames_with_poses": 7}
        write_json(stream / "observe.json", {**counts, "detection_rate_hz": 29.0, "latency_ms": {"total": latency}})
        write_json(stream / "evaluation" / "summary.json", evaluation(0.72, 0.7))
        write_json(stream / "evaluation_processed" / "summary.json", evaluation(0.9, 0.875))
        (stream / "evaluation" / "curves.csv").write_text("object,score,precision,recall\n<bowl>,0.9,1.0,0.5\n")
        (stream / "frame_times.csv").write_text("utime,t_frame,t_detections,t_poses\n1,0.0,0.02,0.03\n2,0.1,,\n")
        (self.out / "overlay.png").write_bytes(b"picture")
        self.summary = report.summarise(Options(self.out), OneUnit(self.out), 10)

    def test_recalls_are_over_all_frames_and_again_over_the_processed_ones(self):
        self.assertEqual((self.summary["auc"]["<bowl>"], self.summary["recall"]["<bowl>"]), (0.72, 0.7))
        processed = self.summary["processed"]
        self.assertEqual((processed["auc"]["<bowl>"], processed["recall"]["<bowl>"]), (0.9, 0.875))
        self.assertEqual((self.summary["frames_with_poses"], self.summary["train_seconds"]), (7, 51.5))
        for key in ("cpu", "commit", "date", "command", "latency_ms", "rate_hz", "settings", "bop19_ar"):
            self.assertIn(key, self.summary)

    def test_the_page_holds_everything_and_needs_no_network(self):
        page = report.page(self.out, self.summary)
        for words in (
            "&lt;bowl&gt;",
            "<td>0.720</td>",
            "<td>0.900</td>",
            "<td>detect.leaves</td><td>2.50</td>",
            "rendered scene desk_1",
        ):
            self.assertIn(words, page)
        self.assertNotIn("http", page)

    def follow(self):
        """What hs-observe and hs-evaluate say of a stream that follows."""
        stream = self.out / "stream"
        latency = {"p50": 4.0, "p95": 5.0, "p99": 6.0}
        pose = {"received": 9, "processed": 8, "skipped": 1}
        counts = observed(received=10, processed=2, skipped=8, on_bus=2)
        counts["processes"]["hs-pose"] = pose
        write_json(stream / "observe.json", {**counts, "detection_rate_hz": 5.0, "latency_ms": {"total": latency},
                                             "objects_latency_ms": latency})  # fmt: skip
        by_object = {"published": 16, "required": 20, "right_fraction": 0.875, "right_up_to_shape_fraction": 1.0, "recall": 0.7,
                     "recall_up_to_shape": 0.8}  # fmt: skip
        figures = {key: {"<bowl>": value, "all": value} for key, value in by_object.items()}
        write_json(stream / "evaluation" / "summary.json", {**evaluation(0.15, 0.14), "followed": figures})
        return report.summarise(Options(self.out, follow=True), OneUnit(self.out), 10)

    def test_poses_of_followed_objects_stand_first_and_what_was_passed_over_beside_them(self):
        summary = self.follow()
        self.assertEqual(next(iter(summary)), "followed")
        found = summary["followed"]
        self.assertEqual((found["frames_followed"], found["frames_passed_over"], found["frames_lost"]), (8, 1, 1))
        self.assertEqual((found["looks"], found["recall"]["<bowl>"], summary["auc"]["<bowl>"]), (2, 0.7, 0.15))
        page = report.page(self.out, summary)
        self.assertLess(page.index("<td>0.875</td>"), page.index("<td>0.900</td>"))
        self.assertIn("<td>passed over for newer ones</td><td>1</td>", page)
        self.assertIn("<td>not inspected, as meant</td><td>8</td>", page)
        self.assertNotIn("http", page)
        self.assertIn("<bowl>                  16   0.875     1.000             20       0.700     0.800", followed.words(found, 10))

    def test_a_hole_in_the_account_of_what_was_followed_ends_the_report(self):
        pose = {"received": 9, "processed": 7, "skipped": 1}
        for processes in ({"hs-pose": pose}, {}):
            with self.assertRaises(SystemExit):
                followed.account(10, {"processes": processes})

    def test_the_image_on_top_shows_most_objects_and_most_of_them(self):
        log, folder = self.out / "results.lcmlog", self.out / "pictures"
        folder.mkdir()
        with open(log, "wb") as out:
            for utime, poses in ((1, [("can", 0.9), ("mug", 0.3)]), (2, [("can", 0.8), ("mug", 0.9)]), (3, [("can", 1.0)]), (6, [("can", 1.0), ("mug", 1.0), ("mug", 1.0)]),
                                 (4, [("can", 0.9), ("mug", 0.9), ("bowl", 0.9)])):  # fmt: skip
                message = object_poses_t()
                message.utime, message.n_poses = utime, len(poses)
                for name, visible in poses:
                    pose = object_pose_t()
                    pose.class_name, pose.visible_fraction, pose.status = name, visible, object_pose_t.VALID
                    pose.detection_index = -1
                    message.poses.append(pose)
                write_event(out, utime, Event(utime, "HOUGHSTREAM_POSES", message.encode()))
            late = object_poses_t()  # of detections: hs-view has drawn the frame by then
            late.utime, late.n_poses, late.poses = 3, 4, [object_pose_t() for _ in range(4)]
            for number, pose in enumerate(late.poses):
                pose.class_name, pose.visible_fraction, pose.status = f"late {number}", 1.0, object_pose_t.VALID
            write_event(out, 9, Event(9, "HOUGHSTREAM_POSES", late.encode()))
        for utime in (1, 2, 3, 5, 6):  # hs-view draws a few of the frames
            (folder / f"{utime}.jpg").touch()
        self.assertEqual(fullest_image(poses_by_frame(log), folder).name, "2.jpg")
        (folder / "2.jpg").unlink()
        self.assertEqual(fullest_image(poses_by_frame(log), folder).name, "1.jpg")
        for utime in (1, 3, 6):
            (folder / f"{utime}.jpg").unlink()
        with self.assertRaisesRegex(SystemExit, "no image of a frame with published poses"):
            fullest_image(poses_by_frame(log), folder)

    def test_latency_is_of_frames_that_have_results(self):
        times = [{"t_frame": "0.1", "t_poses": "0.13"}, {"t_frame": "0.2", "t_poses": ""}]
        self.assertEqual([(x, round(y, 6)) for x, y in report.latency_points(times, "t_poses")], [(0.1, 30.0)])


class Teach(unittest.TestCase):
    def test_what_hs_teach_says_tells_how_far_it_is(self):
        said = ["hs-teach: tracking: 12 of 60 directions", "hs-teach: fusing: the model is made",
                "hs-teach: training: the model is taught", "tree 3 of 15: 900 leaves",
                "hs-teach: training: mug is known, and what its detections are worth is learnt in more rooms"]  # fmt: skip
        phases = [teach.phase_of("\n".join(said[:count])) for count in range(len(said) + 1)]
        self.assertEqual(phases, ["take", "take", "fusing", "training", "training", "practise"])
        self.assertTrue(set(phases) <= set(teach.STEPS_S))

    def test_the_camera_plays_its_scene_forwards_then_backwards(self):
        taken = [(1_000_000 + 66_667 * number, number) for number in range(9)]
        seen = [pose_scatter.image_at(taken, utime + 500, 4) for utime, _ in taken]
        self.assertEqual(seen, [0, 1, 2, 3, 3, 2, 1, 0, 0])
        self.assertIsNone(pose_scatter.image_at(taken, 5_000_000, 4))
        self.assertIsNone(pose_scatter.image_at([], 5_000_000, 4))

    def test_poses_of_another_frame_on_the_object_scatter_by_their_errors_alone(self):
        def about_z(degrees):
            return pose_scatter.rotation_of((math.cos(math.radians(degrees) / 2), 0, 0, math.sin(math.radians(degrees) / 2)))

        relative = []
        for i in range(20):
            true = (about_z(18 * i), (0.1, 0.01 * i, 0.7))
            off = 0.003 if i == 0 else 0.0  # one is 3 mm and 5 degrees off
            turn = 95 if i == 0 else 90
            moved = [a + b for a, b in zip(pose_scatter.turned(true[0], (0.0, 0.0, 0.05 + off)), true[1])]
            relative.append(pose_scatter.seen_from_truth(true, (pose_scatter.product(true[0], about_z(turn)), moved)))
        found = pose_scatter.scatter(relative)
        self.assertEqual((found["mm_50"], found["deg_50"]), (0.0, 0.0))
        self.assertAlmostEqual(found["mm_95"], 3.0, places=1)
        self.assertAlmostEqual(found["deg_95"], 5.0, places=1)
        self.assertEqual(pose_scatter.scatter([]), {})

    def test_what_is_found_may_have_a_pose_a_reason_or_nothing(self):
        def mug(pose):
            return {"class_name": "mug", "pose": pose}

        frames = [{"utime": 1, "detections": []}, {"utime": 2, "detections": [mug(None), {"class_name": "bowl", "pose": None}]},
                  {"utime": 3, "detections": [mug({"status": "no model"})]},
                  {"utime": 4, "detections": [mug({"status": "valid"})]}]  # fmt: skip
        found = teach.found_in(frames)
        self.assertEqual([utime for utime, _ in found], [2, 3, 4])
        self.assertEqual([utime for utime, _ in teach.posed_in(found)], [4])
        shares = teach.shares(frames, found + found[:1], teach.posed_in(found), 2)
        self.assertEqual(shares, {"frames": 2, "found": 1.0, "posed": 0.5})

    def test_what_was_lost_is_told_apart_around_the_change_of_the_store(self):
        def status(received, skipped, lost):
            message = status_t()
            message.process, message.frames_received = "hs-detect", received
            message.frames_skipped, message.frames_lost = skipped, lost
            return message

        class Told:
            known_us = 10_000_000
            of_process = staticmethod(lambda _: [
                (1_000_000 * second, status(30 * second, second // 5, 1 if second > 11 else 0))
                for second in range(1, 20)
            ])  # fmt: skip

        figures = teach.stream_figures(Told)
        self.assertEqual((figures["frames"], figures["lost"], figures["skipped"]), (570, 1, 3))
        self.assertEqual((figures["lost_at_change"], figures["skipped_at_change"]), (1, 1))

    def test_a_state_that_was_never_told_ends_the_demo(self):
        story = teach.Story.__new__(teach.Story)
        said = teaching_t()
        said.state = teaching_t.TRACKING
        story.teaching = [(5, said)]
        self.assertEqual(story.begin(teaching_t.TRACKING)[0], 5)
        with self.assertRaisesRegex(SystemExit, "no word of FUSING"):
            story.begin(teaching_t.FUSING)


if __name__ == "__main__":
    unittest.main()
