"""The result of `cmake --install`: programs that run from there, libraries and headers that the examples build with, and types
for Python. Arguments: the source folder, the build folder."""

import gzip
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

SOURCE, BUILD = (pathlib.Path(word) for word in sys.argv[1:3])
HOME = None  # where it is installed; a blank in its name
PRIVATE = ("unshare", "-rn", "sh", "-c", "ip link set lo up multicast on && ip route add 224.0.0.0/4 dev lo && exec \"$@\"", "sh")  # fmt: skip


def setUpModule():
    global HOME
    folder = tempfile.mkdtemp(prefix="houghstream install ")
    unittest.addModuleCleanup(shutil.rmtree, folder)
    HOME = pathlib.Path(folder) / "usr"
    run("cmake", "--install", BUILD, "--prefix", HOME)


def run(*words, status=0, **options):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, timeout=240, check=False, **options)
    if done.returncode != status:
        raise AssertionError(f"{words}: status {done.returncode}, expected {status}\n{done.stdout}\n{done.stderr}")
    return done.stdout + done.stderr


def public_headers():
    lines = (SOURCE / ".cmake" / "public_headers.txt").read_text().splitlines()
    return [line.split(" = ")[0] for line in lines if line and not line.startswith("#")]


def python_of_installation():
    return {**os.environ, "PYTHONPATH": str(HOME / "lib/python3/dist-packages"), "PYTHONDONTWRITEBYTECODE": "1",
            "LCM_DEFAULT_URL": "udpm://239.255.76.67:7667?ttl=0"}  # fmt: skip


class Headers(unittest.TestCase):
    def test_public_ones_include_public_ones_only(self):
        known = set(public_headers())
        for header in sorted(known):
            text = (HOME / "include/houghstream" / header).read_text()
            for included in re.findall(r'#include "(.+)"', text):
                self.assertIn(included, known, f"{header} includes it")


class Libraries(unittest.TestCase):
    def test_names_are_in_the_namespace(self):
        for library in sorted(HOME.glob("lib/**/lib*.a")):
            for line in run("nm", "--demangle", "--defined-only", "--extern-only", library).splitlines():
                found = re.match(r"[0-9a-f]+ ([TDBR]) (.+)", line)
                if found:
                    self.assertIn("houghstream::", found[2], f"{library.name} defines it")

    def test_a_shared_library_that_links_them_does_not_export_them(self):
        driver = next(HOME.glob("lib/**/libvirtual_camera.so.0"))
        exported = run("nm", "--dynamic", "--demangle", "--defined-only", driver)
        self.assertIn("oniDriverCreate", exported)
        self.assertNotIn("houghstream::", exported)

    def test_pkg_config_finds_them_where_they_are(self):
        folder = next(HOME.glob("lib/**/pkgconfig"))
        said = run("pkg-config", "--cflags", "--libs", "houghstream", env={**os.environ, "PKG_CONFIG_PATH": str(folder)})
        places = [pathlib.Path(place.replace("\\ ", " ")) for place in re.findall(r"-[IL]((?:[^ \\]|\\.)+)", said)]
        self.assertIn(HOME / "include/houghstream", [place.resolve() for place in places])
        self.assertTrue(any((place / "libhoughstream_finder.a").is_file() for place in places), said)


class Subproject(unittest.TestCase):
    """The sources as a folder of another project, by add_subdirectory or FetchContent."""

    def test_it_gives_the_targets_of_the_package(self):
        folder, examples = HOME.parent / "parent", SOURCE / "tools/examples/cpp"
        folder.mkdir()
        (folder / "CMakeLists.txt").write_text(f"""
cmake_minimum_required(VERSION 3.25)
project(parent LANGUAGES CXX)
find_package(Eigen3 REQUIRED NO_MODULE)
add_subdirectory("{SOURCE}" houghstream EXCLUDE_FROM_ALL)
foreach(library types pipeline pipeline_lcm drivers detector pose finder)
  if(NOT TARGET houghstream::${{library}})
    message(FATAL_ERROR "houghstream::${{library}} is no target")
  endif()
endforeach()
if(HOUGHSTREAM_TESTS OR CMAKE_BUILD_TYPE)
  message(FATAL_ERROR "the parent's settings are changed")
endif()
add_executable(poses_in_base "{examples}/poses_in_base.cpp")
target_link_libraries(poses_in_base houghstream::types Eigen3::Eigen)
add_executable(find_in_images EXCLUDE_FROM_ALL "{examples}/find_in_images.cpp")
target_link_libraries(find_in_images houghstream::finder)
""")
        run("cmake", "-S", folder, "-B", folder / "build", "-G", "Ninja")
        run("cmake", "--build", folder / "build")
        self.assertTrue((folder / "build/poses_in_base").is_file())


class PythonPackage(unittest.TestCase):
    def test_it_lies_where_debians_python_looks(self):
        self.assertTrue((HOME / "lib/python3/dist-packages/houghstream/event_log.py").is_file())
        local = HOME.parent / "local"
        run("cmake", "--install", BUILD, "--prefix", local, "--component", "python")
        version = run("/usr/bin/python3", "-c", "import sys; print('python%d.%d' % sys.version_info[:2])").strip()
        self.assertTrue((local / "lib" / version / "dist-packages/houghstream/event_log.py").is_file())

    def test_it_has_the_finder_and_its_types(self):
        if not list((BUILD / "python/houghstream").glob("_native.*.so")):
            self.skipTest("built without pybind11")
        script = "import houghstream; print(houghstream.ObjectFinder.__module__, houghstream.listen.__module__)"
        said = run("/usr/bin/python3", "-c", script, cwd="/", env=python_of_installation())
        self.assertEqual(said, "houghstream.finder houghstream.listener\n")
        for file in ("py.typed", "_native.pyi"):
            self.assertTrue((HOME / "lib/python3/dist-packages/houghstream" / file).is_file(), file)


class Programs(unittest.TestCase):
    def test_they_run_from_where_they_are(self):
        programs = sorted(HOME.glob("bin/hs-*"))
        self.assertGreater(len(programs), 14)
        for program in programs:
            self.assertRegex(
                run(program, "--version", cwd="/", env={"PATH": "/usr/bin:/bin"}), rf"^{program.name} \d+\.\d+\.\d+\n$"
            )

    def test_their_version_and_the_packages_changelog_are_those_of_the_changelog(self):
        text = (SOURCE / "tools/CHANGELOG.md").read_text()
        version, newest = re.search(r"^## \[(\d+\.\d+\.\d+)\][^\n]*\n(.*?)(?=^## \[|\Z)", text, re.M | re.S).groups()
        self.assertEqual(run(HOME / "bin/hs-log", "--version"), f"hs-log {version}\n")
        log = gzip.decompress((HOME / "share/doc/houghstream/changelog.gz").read_bytes()).decode()
        self.assertTrue(log.startswith(f"houghstream ({version}) unstable; urgency=low\n\n  * "), log[:100])
        self.assertEqual(log.count("\n  * "), len(re.findall(r"^- ", newest, re.M)))

    @unittest.skipUnless(shutil.which("help2man"), "no manual pages without help2man")
    def test_they_have_manual_pages_with_the_options_of_their_jobs(self):
        pages = {page.name: gzip.decompress(page.read_bytes()).decode() for page in HOME.glob("share/man/man1/*.gz")}
        self.assertEqual(sorted(pages), sorted(f"{program.name}.1.gz" for program in HOME.glob("bin/*")))
        for page, words in (("hs-log", r'.SH "HS-LOG EXPORT BOP"'), ("hs-log", r"\-\-from\-channel"), ("hs-teach", r"\-\-no\-teach"),
                            ("hs-render", r"\-\-pitches"), ("hs-import", "hs-import boxes FRAMES SCENE"), ("hs-spy", r"\-\-heap"),
                            ("houghstream-demo", r"\-\-unplug"), ("houghstream-demo", ".SH \"HOUGHSTREAM-DEMO MEASURE\""), ("hs-detect", ".SH EXAMPLES")):  # fmt: skip
            self.assertIn(words, pages[f"{page}.1.gz"], page)

    def test_the_demo_has_the_name_that_it_is_started_by(self):
        self.assertTrue(run(HOME / "bin/houghstream-demo", "--help").startswith("usage: houghstream-demo "))
        self.assertIn("houghstream-demo: unrecognized", run(HOME / "bin/houghstream-demo", "--nonsense", status=1))
        said = run(HOME / "bin/houghstream-demo", "measure", "--help")
        self.assertTrue(said.startswith("usage: houghstream-demo measure "), said)

    def test_the_demo_says_where_samples_come_from(self):
        said = run(HOME / "bin/houghstream-demo", "--samples", "/nowhere", "--page", status=1)
        self.assertIn("/nowhere/forest: not there; install the package houghstream-samples", said)

    def test_nothing_names_the_source_folder(self):
        for file in HOME.rglob("*"):
            if file.is_file() and not file.is_symlink() and file.suffix != ".a":
                self.assertNotIn(str(SOURCE).encode(), file.read_bytes(), file)


class Examples(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = HOME.parent / "examples"
        cls.source = HOME / "share/doc/libhoughstream-dev/examples"
        run("cmake", "-S", cls.source / "cpp", "-B", cls.folder, "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={HOME}",
            f"-Drealsense2_DIR={SOURCE}/tests/tools/install/realsense",
            "-DCMAKE_BUILD_TYPE=Debug", f"-DCMAKE_EXE_LINKER_FLAGS={os.environ.get('EXAMPLE_LINK_FLAGS', '')}")  # fmt: skip
        run("cmake", "--build", cls.folder)
        cls.log = cls.folder / "poses.lcmlog"
        script = """
import struct, sys
from houghstream import object_pose_t, object_poses_t
log = open(sys.argv[1], "wb")
for number in range(100):
    pose = object_pose_t()
    pose.class_name, pose.status, pose.trans, pose.quat, pose.quality = "mug", object_pose_t.VALID, [0.1, 0.2, 1.5], [1, 0, 0, 0], 0.9
    lost = object_pose_t()
    lost.class_name, lost.status = "can", object_pose_t.REJECTED_BY_DEPTH
    message = object_poses_t()
    message.utime, message.source_channel, message.n_poses, message.poses = 10**15 + 20000 * number, "OPENNI_FRAME", 2, [pose, lost]
    data, channel = message.encode(), b"HOUGHSTREAM_POSES"
    log.write(struct.pack(">Iqqii", 0xEDA1DA01, number, message.utime, len(channel), len(data)) + channel + data)
"""
        run("/usr/bin/python3", "-c", script, cls.log, env=python_of_installation())

    def listen(self, *words):
        """Returns what a program prints while the log of poses is played in a private network, again until it prints something;
        it has a second to end its line."""
        play = (
            'stdbuf -oL "$@" > "$SAID" 2>&1 & '
            'for again in $(seq 20); do sleep 1; lcm-logplayer "$LOG" > /dev/null 2>&1; grep -q mug "$SAID" && break; done; '
            'sleep 1; kill %1; wait; cat "$SAID"'
        )
        said = self.folder / "said.txt"
        return run(*PRIVATE, "bash", "-c", play, "bash", *words,
                   env={**python_of_installation(), "LOG": str(self.log), "SAID": str(said)})  # fmt: skip

    def test_each_is_a_page(self):
        pages = [page for page in self.source.rglob("*") if page.is_file()]
        self.assertGreater(len(pages), 6)
        for page in pages:
            self.assertLessEqual(len(page.read_text().splitlines()), 60, page)

    def test_find_in_images_says_what_is_wrong(self):
        self.assertIn("find_in_images: expected STORE COLOUR DEPTH", run(self.folder / "find_in_images", status=1))

    def test_poses_in_base_turns_them_into_the_frame_of_the_base(self):
        self.assertIn(
            "mug                  at 1.100 1.500 -0.200 m",
            self.listen(self.folder / "poses_in_base", "1", "0", "0", "-90", "0", "0"),
        )

    def test_the_log_is_read_by_python(self):
        plot = self.folder / "plot.png"
        said = run(self.source / "python/read_log.py", self.log, plot, env=python_of_installation())
        self.assertEqual(said.count("mug                  at 0.100 0.200 1.500 m, quality 0.90"), 100)
        self.assertNotIn("can", said)
        self.assertEqual(plot.read_bytes()[:4], b"\x89PNG")

    def test_python_says_in_a_line_why_a_log_is_not_read(self):
        cut = self.folder / "cut.lcmlog"
        cut.write_bytes(self.log.read_bytes()[:-10])
        for words, part in (((), "expected LOG"), (("/nowhere",), "/nowhere"), ((cut,), f"{cut}: cut within event 99")):
            said = run(self.source / "python/read_log.py", *words, status=1, env=python_of_installation())
            self.assertIn(part, said.splitlines()[-1])
            self.assertNotIn("Traceback", said)

    def test_without_the_lcm_module_python_says_so(self):
        try:
            import lcm  # noqa: F401
        except ImportError:
            said = run("/usr/bin/python3", self.source / "python/subscribe.py", status=1, env=python_of_installation())
            self.assertIn("no Python module 'lcm': ", said)
            self.assertIn("pip install lcm", said)

    def test_python_listens_to_poses_and_reads_them_of_a_log(self):
        if not list((BUILD / "python/houghstream").glob("_native.*.so")):
            self.skipTest("built without pybind11")
        example = self.source / "python/listen.py"
        line = "mug                  at 0.100 0.200 1.500 m in camera"
        self.assertIn(line, self.listen("/usr/bin/python3", example))
        said = run("/usr/bin/python3", example, f"file://{self.log}", env=python_of_installation())
        self.assertEqual(said.count(line), 100)
        self.assertEqual(run("/usr/bin/python3", example, "file:///nowhere", status=1, env=python_of_installation()).count("\n"), 1)

    def test_java_prints_poses(self):
        jars = [HOME / "share/java/houghstream_types.jar", pathlib.Path("/usr/share/java/lcm.jar")]
        if not shutil.which("java") or not all(jar.is_file() for jar in jars):
            self.skipTest("no Java")
        said = self.listen(
            "java", "-Djava.net.preferIPv4Stack=true", "-cp", ":".join(map(str, jars)), self.source / "java/PrintPoses.java"
        )
        self.assertIn("mug at 0.100 0.200 1.500 m, quality 0.90", said)

    def frames_of(self, *words):
        """Returns what a program that sends frames has sent: channel, shapes, first and middle depth, first pixel and fx of
        each."""
        log = self.folder / "frames.lcmlog"
        log.unlink(missing_ok=True)
        start = 'lcm-logger -f "$LOG" > /dev/null 2>&1 & sleep 1; "$@"; sleep 1; kill -INT %1; wait; true'
        run(*PRIVATE, "bash", "-c", start, "bash", *words, env={**python_of_installation(), "LOG": str(log)})
        script = """
import sys
from houghstream.event_log import read_log
from houghstream.frames import decode_frame
for event in read_log(sys.argv[1]):
    if event.channel != "OPENNI_FRAME":
        continue  # lcm-logger also keeps a test of its own connection, where that had to be sent twice
    frame = decode_frame(event.data)
    middle = frame.depth[frame.depth.shape[0] // 2, frame.depth.shape[1] // 2]
    print(event.channel, frame.colour.shape, frame.colour.dtype, round(float(frame.depth[0, 0]), 3), round(float(middle), 3),
          [int(value > 200) for value in frame.colour[0, 0]], frame.camera.fx)
"""
        return run("/usr/bin/python3", "-c", script, log, env=python_of_installation()).splitlines()

    def test_frames_of_ones_own_camera_arrive_and_are_numpy_arrays(self):
        lines = self.frames_of(self.folder / "own_camera", "10")
        self.assertGreaterEqual(len(lines), 8)
        self.assertRegex(lines[-1], r"^OPENNI_FRAME \(480, 640, 3\) uint8 1.0 0.89\d? \[0, 0, 0\] 525.0$")

    def test_frames_of_an_sdk_arrive_from_its_camera_and_from_its_recording(self):
        for words in ((), ("taken.bag",)):
            lines = self.frames_of(self.folder / "realsense_camera", *words)
            self.assertGreaterEqual(len(lines), 8)
            self.assertEqual(lines[-1], "OPENNI_FRAME (48, 64, 3) uint8 nan 0.9 [1, 0, 0] 58.0")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
