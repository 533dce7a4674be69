"""Python's ObjectFinder and listen(): the same poses as hs-detect and hs-pose give, bit for bit, arrays of all kinds, wrong ones,
threads, logs, a bus, Ctrl-C.

Forest, models, scene and log are those that end_to_end_test.py has made.
"""

import contextlib
import json
import math
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import threading
import time
import unittest

import houghstream
import numpy
from folders import read_arguments
from houghstream import Camera, FoundPoses, InputError, ObjectFinder, WorldObjects, detections_t, listen
from houghstream import object_poses_t, objects_t, pose_probabilities_t
from houghstream.event_log import read_log
from houghstream.frames import decode_frame
from PIL import Image
from store_change_test import make_store
from studies.stream import enter_private_network

EXAMPLE = pathlib.Path(__file__).parents[2] / "tools" / "examples" / "python" / "find_in_images.py"
PACKAGE = pathlib.Path(houghstream.__file__).parent
CAMERA = Camera(525, 525, 319.5, 239.5)
INTERRUPTED_S = 0.2  # Ctrl-C ends a listener within


def run(*words):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done
    return done.stdout


def messages_of(log, channel, message_type):
    return [message_type.decode(event.data) for event in read_log(log) if event.channel == channel]


def rotation_of(quaternion):
    w, x, y, z = quaternion
    return numpy.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])  # fmt: skip


def as_values(poses):
    """All numbers of poses, for comparisons."""
    return [(pose.name, pose.matrix.tobytes(), pose.covariance.tobytes(), pose.score, pose.quality, pose.shape_quality, pose.box)
            for pose in poses]  # fmt: skip


def publish_poses(frames, *objects):
    """Logs of so many frames of the scene, of their detections, and of their poses; the last one with all of it."""
    logs = [FOLDERS.out / f"{frames}_{name}.lcmlog" for name in ("frames", "detections", "poses")]
    run(FOLDERS.tools / "hs-capture", "--source", f"bop:{FOLDERS.made / 'scene'}", "--frames", frames, "--raw-colour", "--log", logs[0])
    for program, log, out in (("hs-detect", *logs[:2]), ("hs-pose", *logs[1:])):
        run(FOLDERS.tools / program, *objects, "-l", f"file://{log}", "--keep-frames", "--output-log", out)
    return logs


class WithAFinder(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.store = FOLDERS.out / "my store"
        if not cls.store.exists():
            make_store(FOLDERS.made, cls.store)
        cls.finder = ObjectFinder(cls.store)
        files = [FOLDERS.made / "scene" / kind / "000000.png" for kind in ("rgb", "depth")]
        cls.colour, depth = (numpy.asarray(Image.open(file)) for file in files)
        cls.depth = depth.astype(numpy.uint16)
        cls.poses = cls.finder.find(cls.colour, cls.depth, CAMERA)


class SamePoses(WithAFinder):
    def test_they_are_those_of_hs_detect_and_hs_pose_bit_for_bit(self):
        frame, detections, poses = publish_poses(1, "--objects", self.store)
        (published,) = messages_of(poses, "HOUGHSTREAM_POSES", object_poses_t)
        (probable,) = messages_of(poses, "HOUGHSTREAM_POSE_PROBABILITIES", pose_probabilities_t)
        (found,) = messages_of(detections, "HOUGHSTREAM_DETECTIONS", detections_t)
        expected = [(pose, both) for pose, both in zip(published.poses, probable.right_up_to_symmetry) if not math.isnan(pose.trans[0])]
        self.assertGreater(len(expected), 0)
        decoded = decode_frame(next(read_log(frame)).data)
        for result in (self.poses, self.finder.find(decoded.colour, decoded.depth, decoded.camera)):
            self.assertEqual(len(result), len(expected))
            for pose, (message, up_to_symmetry) in zip(result, expected):
                self.assertEqual(pose.name, message.class_name)
                self.assertEqual(pose.position.tolist(), list(message.trans))
                numpy.testing.assert_allclose(pose.rotation, rotation_of(message.quat), rtol=0, atol=1e-14)
                self.assertEqual((pose.quality, pose.score), (message.quality, message.detection_score))
                self.assertEqual(pose.shape_quality, up_to_symmetry)
                self.assertEqual((pose.inliers, pose.residual), (message.n_inliers, message.residual_m))
                detection = found.detections[message.detection_index]
                self.assertEqual(tuple(pose.box), (detection.box_x, detection.box_y, detection.box_width, detection.box_height))

    def test_the_example_prints_what_that_in_cpp_does(self):
        files = [FOLDERS.made / "scene" / kind / "000000.png" for kind in ("rgb", "depth")]
        arguments = (self.store, *files, ",".join(map(str, CAMERA)))
        printed = [line for line in run(FOLDERS.examples / "find_in_images", *arguments).splitlines() if ", at " in line]
        said = run(sys.executable, EXAMPLE, *arguments).splitlines()
        self.assertEqual([line for line in said if ", at " in line], printed)
        self.assertEqual(len(printed), len(self.poses))
        refused = subprocess.run([sys.executable, EXAMPLE, "/nowhere", *files, "1,1,1,1"], capture_output=True, text=True, check=False)
        self.assertEqual((refused.returncode, refused.stderr.count("\n")), (1, 1))

    def test_a_pose_comes_with_what_is_known_of_its_object(self):
        for pose in self.poses:
            self.assertEqual(pose.covariance.shape, (6, 6))
            self.assertTrue((numpy.linalg.eigvalsh(pose.covariance) > 0).all())
            self.assertTrue((pose.extents > 0.01).all() and (pose.extents < 0.5).all(), pose.extents)
            self.assertEqual(pose.corners.shape, (8, 3))
            middle = pose.corners.mean(axis=0)
            shown = [CAMERA.fx * middle[0] / middle[2] + CAMERA.cx, CAMERA.fy * middle[1] / middle[2] + CAMERA.cy]
            self.assertTrue(pose.box.x < shown[0] < pose.box.x + pose.box.width, (shown, pose.box))
            self.assertTrue(pose.box.y < shown[1] < pose.box.y + pose.box.height, (shown, pose.box))
            self.assertIn(f"Pose({pose.name} at ", repr(pose))
        self.assertEqual(self.finder.names, sorted(self.finder.names))
        self.assertEqual(repr(self.finder), f"ObjectFinder({str(self.store)!r}): {', '.join(self.finder.names)}")
        self.assertEqual(self.poses[0].rotation.shape, (3, 3))
        with self.assertRaises(IndexError):
            self.poses[len(self.poses)]

    def test_what_has_no_pose_says_why(self):
        strict = ObjectFinder(self.store, min_quality=1.0)
        result = strict.find(self.colour, self.depth, CAMERA)
        self.assertEqual(len(result), 0)
        self.assertGreaterEqual(len(result.without_pose), 1)
        for entry in result.without_pose:
            self.assertNotIn(entry.status, ("valid", ""))


class Arrays(WithAFinder):
    def test_blue_first_metres_strides_and_other_cameras_give_the_same(self):
        wide = numpy.zeros((self.depth.shape[0], 2 * self.depth.shape[1]), numpy.uint16)
        wide[:, ::2] = self.depth
        blue_first = numpy.ascontiguousarray(self.colour[:, :, ::-1])
        metres = self.depth.astype(numpy.float32) * numpy.float32(0.001)
        expected = as_values(self.poses)
        self.assertEqual(as_values(self.finder.find(self.colour, wide[:, ::2], CAMERA)), expected)
        self.assertEqual(as_values(self.finder.find(blue_first[:, :, ::-1], self.depth, CAMERA)), expected)
        self.assertEqual(as_values(self.finder.find(blue_first, self.depth, CAMERA, colour_order="bgr")), expected)
        self.assertEqual(as_values(self.finder.find(numpy.asfortranarray(self.colour), self.depth, tuple(CAMERA))), expected)
        self.assertEqual(as_values(self.finder.find(self.colour, metres, CAMERA)), expected)
        self.assertEqual(as_values(self.finder.find(self.colour, metres.astype(float), CAMERA)), expected)
        matrix = [[CAMERA.fx, 0, CAMERA.cx], [0, CAMERA.fy, CAMERA.cy], [0, 0, 1]]
        self.assertEqual(as_values(self.finder.find(self.colour, self.depth, Camera.from_matrix(matrix))), expected)
        read_only = self.colour.copy()
        read_only.flags.writeable = False
        self.assertEqual(as_values(self.finder.find(read_only, self.depth, CAMERA)), expected)

    def test_depth_that_is_none_in_metres_is_none(self):
        for none in (0.0, -1.0, math.nan, math.inf):
            depth = numpy.full(self.depth.shape, none, numpy.float32)
            self.assertEqual(len(self.finder.find(self.colour, depth, CAMERA)), 0, none)

    def test_wrong_ones_are_refused_in_one_line(self):
        large = numpy.zeros((1, 20000, 3), numpy.uint8)
        for error, part, colour, depth, camera in (
            (TypeError, "colour: found list, expected a numpy array", [[0]], self.depth, CAMERA),
            (TypeError, "colour: found float64, expected uint8", self.colour / 255, self.depth, CAMERA),
            (TypeError, "depth: found int32, expected uint16", self.colour, self.depth.astype(numpy.int32), CAMERA),
            (InputError, r"colour: found shape \(480, 640\), expected", self.colour[:, :, 0], self.depth, CAMERA),
            (InputError, r"depth: found shape \(640, 480\), expected \(480, 640\)", self.colour, self.depth.T, CAMERA),
            (InputError, "expected float32 metres", self.colour, self.depth.astype(numpy.float32), CAMERA),
            (TypeError, "camera: found 525, expected Camera", self.colour, self.depth, 525),
            (TypeError, "camera: found .*, expected Camera", self.colour, self.depth, (525, 525)),
            (TypeError, r"found an array of shape \(3, 3\), expected .* Camera.from_matrix\(K\)", self.colour, self.depth, numpy.eye(3)),
            (InputError, "camera: ", self.colour, self.depth, (0, 525, 319.5, 239.5)),
            (InputError, "camera: ", self.colour, self.depth, (math.nan, 525, 319.5, 239.5)),
            (InputError, "camera", large, numpy.zeros((1, 20000), numpy.uint16), CAMERA),
        ):
            with self.subTest(part), self.assertRaisesRegex(error, part) as caught:
                self.finder.find(colour, depth, camera)
            self.assertEqual(len(str(caught.exception).splitlines()), 1)
        with self.assertRaisesRegex(InputError, "colour_order: found 'RGB'"):
            self.finder.find(self.colour, self.depth, CAMERA, colour_order="RGB")
        self.assertTrue(issubclass(InputError, ValueError))

    def test_a_store_that_is_none_and_numbers_out_of_their_range_are_refused(self):
        with self.assertRaisesRegex(InputError, "/nowhere") as caught:
            ObjectFinder("/nowhere")
        self.assertEqual(len(str(caught.exception).splitlines()), 1)
        wrong = (("threads", 0), ("threads", 65), ("threshold", -0.1), ("min_quality", 1.1), ("threshold", math.nan))
        for option, value in (*wrong, ("precision", 1), ("precision", math.nan)):
            with self.assertRaisesRegex(InputError, f"{option}: found {value}, expected"):
                ObjectFinder(self.store, **{option: value})
        with self.assertRaisesRegex(TypeError, "threads: found '2', expected a number"):
            ObjectFinder(self.store, threads="2")
        with self.assertRaisesRegex(InputError, "precision: found a threshold or min_quality beside it"):
            ObjectFinder(self.store, precision=0.9, threshold=0.5)


class Threads(WithAFinder):
    def test_others_go_on_while_it_works(self):
        counts, ended = [0], threading.Event()

        def count():
            while not ended.is_set():
                counts[0] += 1
                time.sleep(0.001)

        counter = threading.Thread(target=count)
        counter.start()
        try:
            before, begin, calls = counts[0], time.monotonic(), 0
            while time.monotonic() - begin < 0.5:
                self.finder.find(self.colour, self.depth, CAMERA)
                calls += 1
            counted = counts[0] - before
        finally:
            ended.set()
            counter.join()
        self.assertGreater(counted, 3 * calls, "a thread that waits for the lock takes one step between two calls")

    def test_several_share_a_finder_or_have_one_each(self):
        own = ObjectFinder(self.store, threads=1)
        results = {}

        def work(number, finder):
            results[number] = [as_values(finder.find(self.colour, self.depth, CAMERA)) for _ in range(2)]

        workers = [threading.Thread(target=work, args=pair) for pair in enumerate((self.finder, self.finder, own))]
        for worker in workers:
            worker.start()
        for worker in workers:
            worker.join()
        self.assertEqual(results, {number: 2 * [as_values(self.poses)] for number in range(3)})


class Listening(WithAFinder):
    def test_a_log_gives_each_of_its_results(self):
        log = FOLDERS.made / "live_results.log"
        published = messages_of(log, "HOUGHSTREAM_POSES", object_poses_t)
        results = list(listen(f"file://{log}"))
        self.assertEqual([result.utime for result in results], [message.utime for message in published])
        self.assertGreater(sum(map(len, results)), 0)
        for result, message in zip(results, published):
            self.assertIsInstance(result, FoundPoses)
            self.assertEqual(result.camera, message.source_channel)
            posed = [pose for pose in message.poses if not math.isnan(pose.trans[0])]
            self.assertEqual([pose.position.tolist() for pose in result], [list(pose.trans) for pose in posed])
            for pose in result:
                self.assertIsNotNone(pose.box)
                self.assertIsNone(pose.covariance)
        self.assertEqual(list(listen(f"file://{log}", poses=False)), [])
        self.assertEqual(list(listen(f"file://{log}", cameras="NOBODY")), [])

    def test_the_objects_of_the_world(self):
        log = FOLDERS.out / "objects.lcmlog"
        *_, results = publish_poses(10, "--objects", self.store)
        run(FOLDERS.tools / "hs-teach", "frame", self.store, "soda_can", "lid", "--at", "-0.01,0,0.06,0,0,1,0")
        listed = json.loads(run(FOLDERS.tools / "hs-teach", "list", self.store, "--json"))
        self.assertIn({"lid": {"translation_m": [-0.01, 0, 0.06], "rotation": [0, 0, 1, 0]}}, [entry["frames"] for entry in listed["objects"]])
        run(FOLDERS.tools / "hs-track", "--objects", self.store, "-l", f"file://{results}", "--output-log", log)
        published = [message for message in messages_of(log, "HOUGHSTREAM_OBJECTS", objects_t)]
        worlds = [result for result in listen(f"file://{log}") if isinstance(result, WorldObjects)]
        self.assertEqual(len(worlds), len(published))
        self.assertGreater(sum(map(len, worlds)), 0)
        for world, message in zip(worlds, published):
            self.assertEqual((world.utime, world.world, world.world_number), (message.utime, message.world, message.world_number))
            for entry, expected in zip(world, message.objects):
                self.assertEqual((entry.number, entry.name), (expected.track_id, expected.class_name))
                self.assertEqual(entry.position.tolist(), list(expected.trans))
                numpy.testing.assert_array_equal(entry.covariance, expected.covariance)
                self.check_box_and_frames(entry)

    def check_box_and_frames(self, entry):
        """The object lies in its box, and named frames move with it."""
        self.assertTrue((entry.extents > 0.01).all() and (entry.extents < 0.5).all(), entry.extents)
        numpy.testing.assert_allclose(entry.box_matrix[:3, :3], entry.matrix[:3, :3], rtol=0, atol=1e-12)
        self.assertLess(numpy.linalg.norm(entry.corners.mean(axis=0) - entry.box_matrix[:3, 3]), 1e-9)
        inside = numpy.linalg.inv(entry.box_matrix) @ (*entry.position, 1)
        self.assertTrue((numpy.abs(inside[:3]) <= 0.51 * entry.extents).all(), inside)
        if entry.name == "soda_can":
            lid = numpy.linalg.inv(entry.matrix) @ entry.frames["lid"]
            expected = [[-1, 0, 0, -0.01], [0, 1, 0, 0], [0, 0, -1, 0.06], [0, 0, 0, 1]]
            numpy.testing.assert_allclose(lid, expected, rtol=0, atol=1e-9)

    def test_urls_and_logs_that_are_none_are_refused(self):
        for url, part in (("http://here", "http://here"), ("file:///nowhere", "/nowhere")):
            with self.assertRaisesRegex(InputError, part) as caught:
                listen(url)
            self.assertEqual(len(str(caught.exception).splitlines()), 1)
        cut = FOLDERS.out / "cut.lcmlog"
        cut.write_bytes((FOLDERS.made / "live_results.log").read_bytes()[:-5])
        with self.assertRaisesRegex(InputError, "cut.lcmlog"):
            list(listen(f"file://{cut}"))

    def test_a_bus_gives_the_newest_to_who_is_slow(self):
        log = FOLDERS.made / "live_results.log"
        results = listen()
        player = subprocess.Popen(["lcm-logplayer", log], stdout=subprocess.DEVNULL)
        with contextlib.closing(results):
            first = next(results)
            player.wait()
            time.sleep(0.3)
            newest = next(results)
        utimes = [message.utime for message in messages_of(log, "HOUGHSTREAM_POSES", object_poses_t)]
        self.assertIn(first.utime, utimes)
        self.assertEqual(newest.utime, utimes[-1])

    def test_ctrl_c_ends_it(self):
        main = threading.get_ident()
        interrupted = []

        def interrupt():
            time.sleep(0.3)
            interrupted.append(time.monotonic())
            signal.pthread_kill(main, signal.SIGINT)

        threading.Thread(target=interrupt).start()
        with self.assertRaises(KeyboardInterrupt):
            next(listen("memq://"))
        self.assertLess(time.monotonic() - interrupted[0], INTERRUPTED_S)


class Package(unittest.TestCase):
    @unittest.skipUnless(shutil.which("mypy"), "types are checked by mypy")
    def test_types_hold_for_whoever_checks_them(self):
        program = FOLDERS.out / "program.py"
        program.write_text("""import numpy
from houghstream import Camera, FoundPoses, ObjectFinder, images_t, listen
images = numpy.zeros((4, 4, 3), numpy.uint8), numpy.zeros((4, 4), numpy.uint16)
for pose in ObjectFinder("my.store").find(*images, Camera(525, 525, 319.5, 239.5)):
    print(pose.name.upper(), pose.matrix @ pose.matrix, pose.quality + 1)
for result in listen():
    print(result.utime + 1, [entry.position for entry in result], isinstance(result, FoundPoses))
ObjectFinder("my.store").find(*images, 5)
""")
        modules = [str(PACKAGE / f"{name}.py") for name in ("finder", "listener", "results")]
        done = subprocess.run(["mypy", "--strict", "--follow-imports=silent", "--cache-dir=/dev/null", program, *modules], text=True,
                              capture_output=True, check=False, env={**os.environ, "MYPYPATH": str(PACKAGE.parent)})  # fmt: skip
        self.assertEqual([line.split(":")[1] for line in done.stdout.splitlines() if ": error:" in line], ["8"], done.stdout)

    def test_messages_need_no_compiled_module(self):
        script = "import sys, houghstream; houghstream.images_t(); sys.exit('houghstream._native' in sys.modules)"
        self.assertEqual(subprocess.run([sys.executable, "-c", script], check=False).returncode, 0)

    def test_a_name_that_is_none_is_an_attribute_error(self):
        script = "import houghstream\ntry:\n  houghstream.nonsense\nexcept AttributeError as error:\n  print(error)"
        self.assertIn("nonsense", run(sys.executable, "-c", script))


if __name__ == "__main__":
    enter_private_network()
    FOLDERS = read_arguments(__doc__, tools="folder of the programs", made="what end_to_end_test.py has made",
                             examples="folder of find_in_images")  # fmt: skip
    os.chdir(FOLDERS.out)
    unittest.main(argv=sys.argv[:1])
