"""Tests of the report on time of tools/bench: its keys, fits, what was not measured. Usage: PYTHONPATH=tools bench_speed_test.py"""

import json
import os
import pathlib
import subprocess
import tempfile
import unittest

from studies.bench import parts, speed
from studies.records import REPOSITORY
from studies.stream import Usage, cpu_seconds, resident_mb

PROMISED = {
    "detect_ms", "linemod_ms", "speedup_over_gall_same_engine", "speedup_over_gall_whole_system", "latency_ms", "frames",
    "cpu_cores", "rss_mb", "objects", "threads", "simd",
}  # fmt: skip


def contender(ms):
    return {
        "ms": {"p10": ms / 2, "p50": ms, "p90": ms * 2},
        "frames": 3,
        "stage_ms": {"detect.resize": 0.5, "detect.leaves": ms / 2},
    }


def write(file, value):
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(json.dumps(value))


def measured(out):
    names = {"realtime": 12, "realtime_one_thread": 20, "paper": 40, "gall": 60000, "gall_engine": 2000, "serial": 900,
             "linemod": 30, "threads_1": 19, "threads_2": 10, "set_SSE4": 30, "set_AVX2": 22, "set_AVX3": 19}  # fmt: skip
    write(out / "speed" / "times.json", {name: contender(ms) for name, ms in names.items()})
    write(out / "speed" / "realtime" / "summary.json", {"auc": {"mean": 0.9}})
    at_default = {"required": {"bowl": 10, "mug": 0}, "recall": {"bowl": 0.8, "mug": None}, "false_detections": 2}
    write(out / "speed" / "default" / "summary.json", {"auc": {"mean": 0.7}, **at_default})
    write(
        out / "speed" / "about.json",
        {"cpu": "<other>", "commit": "0ther", "date": "2020-01-02", "command": "tools/bench speed"},
    )
    write(out / "speed" / "linemod" / "table" / "summary.json", {"auc": {"mean": 0.6}})
    runs = [
        {"run_name": "jpeg", "aggregate_name": name, "cpu_time": ms} for name, ms in (("mean", 9.0), ("median", 1.25))
    ]
    write(out / "speed" / "kernels.json", {"benchmarks": runs})
    growth = {"objects_4": 10, "objects_20": 14, "trees_5": 5, "trees_10": 10, "scale_0.5": 3, "scale_1": 12}
    write(out / "growth" / "times.json", {name: contender(ms) for name, ms in growth.items()})
    latency = {"p50": 18.0, "p95": 25.0, "p99": 30.0}
    account = {"sent": 1800, "lost": 0, "skipped": 3, "detected": 1797}
    write(
        out / "stream_compressed" / "observe.json",
        {"latency_ms": {"total": latency}, "account": account, "frames_with_poses": 1797},
    )
    memory = {"early": 100.0, "end": 101.0, "most": 102.0}
    write(
        out / "stream_compressed" / "usage.json",
        {"cpu_cores": 1.2, "cores": {"detect": 1.0}, "rss_mb": {"detect": memory}},
    )


class Summary(unittest.TestCase):
    def summarise(self, prepare):
        with tempfile.TemporaryDirectory() as folder:
            prepare(pathlib.Path(folder))
            return {
                **speed.summarise(pathlib.Path(folder)),
                "cpu": "a processor",
                "commit": "abc",
                "date": "2020-02-20",
                "command": "tools/bench",
            }

    def test_each_figure_is_that_of_its_contender(self):
        summary = self.summarise(measured)
        self.assertLessEqual(PROMISED, set(summary))
        self.assertEqual((summary["detect_ms"]["realtime"], summary["detect_ms"]["gall"]), (12, 60000))
        self.assertEqual(summary["at_default"], {"ms": 10, "precision": 0.8, "recall": 0.8})
        self.assertEqual(summary["kernel_ms"], {"jpeg": 1.25})
        self.assertEqual(summary["auc_over_linemod"], 1.5)
        self.assertEqual(summary["threads"], [[1, 19], [2, 10]])
        self.assertEqual(summary["simd"], {"sse4": 30, "avx2": 22, "avx512": 19})
        self.assertEqual(summary["objects"], [[4, 10], [20, 14]])
        self.assertEqual(summary["objects_20_over_4"], 1.4)
        self.assertEqual(summary["latency_ms"]["p99"], 30.0)
        self.assertEqual(summary["frames"], {"sent": 1800, "lost": 0, "skipped": 3})

    def test_the_gain_is_told_for_the_same_engine_and_for_whole_systems(self):
        summary = self.summarise(measured)
        self.assertEqual(summary["speedup_over_gall_same_engine"], 2000 / 20)  # fast engine, one thread each
        self.assertEqual(summary["speedup_over_gall_whole_system"], 60000 / 12)

    def test_exponents_are_slopes_of_logarithms(self):
        self.assertAlmostEqual(speed.exponent([[1, 3], [2, 12], [4, 48]]), 2.0)
        self.assertIsNone(speed.exponent([[1, 3]]))
        self.assertEqual(self.summarise(measured)["exponents"]["pixels"], 1.0)

    def test_what_was_not_measured_is_null(self):
        summary = self.summarise(lambda out: None)
        self.assertLessEqual(PROMISED, set(summary))
        self.assertIsNone(summary["detect_ms"]["gall"])
        self.assertIsNone(summary["latency_ms"])
        self.assertIn("–", speed.page(summary, []))
        self.assertEqual(summary["parts"], {"speed": None, "stream": None, "growth": None})

    def test_the_page_shows_the_stream_and_earlier_releases(self):
        release = {"date": "2020-01-01", "commit": "0ld", "cpu": "<old>", "realtime_ms": 77.0, "paper_ms": None,
                   "linemod_ms": 31.0, "latency_p50_ms": None}  # fmt: skip
        page = speed.page(self.summarise(measured), [release])
        page = " ".join(page.split())
        for words in ("<td>1800</td>", "detect 102", "0ld", "&lt;old&gt;", "<td>77.00</td>", "1.40 times", "<th>leaves</th>",
                      "speed is of commit 0ther, 2020-01-02, &lt;other&gt;", "100 times as fast"):  # fmt: skip
            self.assertIn(words, page)


class Contenders(unittest.TestCase):
    def test_what_stands_beside_an_auc_is_timed_with_the_same_settings(self):
        listed, parts.instruction_sets = parts.instruction_sets, lambda _: ["AVX2"]
        self.addCleanup(setattr, parts, "instruction_sets", listed)
        path = dict.fromkeys(("forest", "paper_forest", "gall_forest"), "FOREST")
        contenders = {text.split("=")[0]: text for text in parts.speed_contenders(None, path)}
        for name, (_, settings) in speed.WORDS.items():
            if settings == speed.RANKED:
                self.assertTrue(contenders[name].endswith(",min-mass=0.05,threshold=0"), name)
        self.assertNotIn("threshold", contenders["threads_1"] + contenders["set_AVX2"])


class UsageOfProcesses(unittest.TestCase):
    def test_cores_and_memory_come_from_the_samples(self):
        usage = Usage()
        for i in range(8):
            usage.add(float(i), 0.5 * i, 100.0 + i)
        self.assertAlmostEqual(usage.cores(), 0.5)
        self.assertEqual(usage.memory(), {"early": 102.0, "end": 107.0, "most": 107.0})

    def test_this_process_has_memory_and_time(self):
        self.assertGreater(resident_mb(os.getpid()), 1.0)
        self.assertGreaterEqual(cpu_seconds(os.getpid()), 0.0)


class Options(unittest.TestCase):
    def test_wrong_ones_are_refused_in_one_line(self):
        for options, words in ((["fast"], "unknown benchmark fast"), (["--every", "0"], "expected a number from 1")):
            done = subprocess.run([REPOSITORY / "tools" / "bench", *options], capture_output=True, text=True)
            self.assertEqual(done.returncode, 1)
            self.assertIn(words, done.stderr)


if __name__ == "__main__":
    unittest.main()
