"""Tests of the demo's report: counting frames, accounting for them, drawing charts. Usage: demo_test.py REPOSITORY"""

import io
import pathlib
import struct
import sys
import unittest
import xml.etree.ElementTree

tools = pathlib.Path(sys.argv.pop(1), "tools")
sys.path[:0] = [str(tools / "demo.d"), str(tools / "report_kit")]

import charts
import count_events
import live_report
import page
import report


def event(channel, data, sync=0xEDA1DA01):
    return struct.pack(">Iqqii", sync, 1, 2, len(channel), len(data)) + channel + data


class CountEvents(unittest.TestCase):
    def test_only_events_of_the_channel_count(self):
        log = event(b"A", b"xyz") + event(b"AB", b"") + event(b"A", b"")
        self.assertEqual(count_events.count_events(io.BytesIO(log), "A"), 2)

    def test_cut_and_damaged_logs_are_refused(self):
        for log in (event(b"A", b"xyz")[:-1], event(b"A", b"xyz")[:10], event(b"A", b"xyz", sync=7)):
            with self.assertRaises(ValueError):
                count_events.count_events(io.BytesIO(log), "A")


def observed(received, processed, skipped, on_bus):
    detector = {"received": received, "processed": processed, "skipped": skipped}
    return {"processes": {"hs-detect": detector}, "frames_detected": on_bus}


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
        self.assertEqual(live_report.nearest(self.SHUTTERS, 1_034_000), 1_033_333)
        self.assertEqual(live_report.nearest(self.SHUTTERS, 1_066_667), 1_066_667)
        self.assertIsNone(live_report.nearest(self.SHUTTERS, 1_200_000))
        self.assertIsNone(live_report.nearest([], 1_000_000))

    def test_latency_is_from_the_shutter(self):
        rows = [{"utime": "1000500", "t_poses": "0.080"}, {"utime": "1033400", "t_poses": ""}]
        self.assertEqual(live_report.latencies_ms(rows, "t_poses", self.SHUTTERS, 1_020_000), [100.0])
        with self.assertRaises(SystemExit):
            live_report.latencies_ms([{"utime": "5", "t_poses": "1"}], "t_poses", self.SHUTTERS, 0)

    def test_an_unplugged_camera_leaves_a_gap(self):
        rows = [{"t_frame": "1.0", "t_poses": "1.1"}, {"t_frame": "4.5", "t_poses": ""}, {"t_frame": "4.6", "t_poses": "4.7"}]
        gap = live_report.unplugging(rows, 1_000_000, 5_000_000)
        self.assertEqual(gap, {"gap_s": 3.5, "frames_back_ms": 500, "poses_back_ms": 700})
        for replugged in (1_500_000, 5_650_000):
            with self.assertRaises(SystemExit):
                live_report.unplugging(rows, 1_000_000, replugged)

    def test_percentiles_of_a_hundred(self):
        self.assertEqual(live_report.percentiles(range(1, 101)), {"p50": 51, "p95": 96, "p99": 100})
        self.assertEqual(live_report.percentiles([])["p99"], None)


class Charts(unittest.TestCase):
    def test_axes_have_few_round_ticks(self):
        self.assertEqual(charts.nice_step(1.0), 0.2)
        self.assertEqual(charts.nice_step(47.0), 10)
        self.assertAlmostEqual(charts.nice_step(0.003), 0.0005)

    def test_points_stand_where_they_should_and_the_svg_is_whole(self):
        chart = charts.Chart("x <unit>", "y", 1.0, 1.0)
        chart.line("a & b", [(0, 0), (1, 1)])
        root = xml.etree.ElementTree.fromstring(chart.svg())
        points = root.find(".//polyline").get("points")
        right, top = charts.WIDTH - charts.RIGHT, charts.TOP
        self.assertEqual(points, f"{charts.LEFT}.0,{charts.HEIGHT - charts.BOTTOM}.0 {right}.0,{top}.0")

    def test_latency_is_drawn_for_frames_that_have_results(self):
        times = [
            {"t_frame": "0.0", "t_detections": "0.02", "t_poses": "0.03"},
            {"t_frame": "0.1", "t_detections": "", "t_poses": ""},
        ]
        root = xml.etree.ElementTree.fromstring(page.latency_chart(times))
        self.assertEqual(len(root.findall(".//circle")), 2)
        xml.etree.ElementTree.fromstring(page.latency_chart([]))


if __name__ == "__main__":
    unittest.main()
