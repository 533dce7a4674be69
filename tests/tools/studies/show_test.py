"""Tests of what houghstream-demo shows: its words, its page's socket, and what the samples are made of. Usage:
PYTHONPATH=tools:build/python show_test.py"""

import json
import os
import pathlib
import socket
import tempfile
import threading
import unittest
from unittest import mock

from studies.demo import samples, show
from studies.records import write_json


class Case(unittest.TestCase):
    def setUp(self):
        place = tempfile.TemporaryDirectory()
        self.addCleanup(place.cleanup)
        self.folder = pathlib.Path(place.name)


class Words(Case):
    def parse(self, *words, display):
        screen = {"DISPLAY": ":0"} if display else {}
        with mock.patch.dict(os.environ, screen):
            for name in () if display else ("DISPLAY", "WAYLAND_DISPLAY"):
                os.environ.pop(name, None)
            return show.parse(words)

    def test_without_a_display_an_image_is_written(self):
        self.assertEqual(self.parse(display=False).picture.name, "houghstream.png")
        self.assertIsNone(self.parse(display=True).picture)
        self.assertIsNone(self.parse("--page", display=False).picture)
        self.assertEqual(self.parse("--picture", "found.jpg", display=True).picture.name, "found.jpg")

    def test_an_image_that_is_there_stays(self):
        for name in ("found.jpg", "found_2.jpg"):
            (self.folder / name).touch()
        self.assertEqual(self.parse("--picture", str(self.folder / "found.jpg"), display=True).picture, self.folder / "found_3.jpg")

    def test_what_cannot_be_done_is_one_line(self):
        for words, complaint in ((("--picture", "x.bmp"), "--picture x.bmp: expected a .png or .jpg"),
                                 (("--picture", "/nowhere/x.png"), "there is no folder /nowhere"),
                                 (("--picture", "x.png", "--page"), "expected one of them"), (("--port", "0"), "from 1")):  # fmt: skip
            with self.assertRaisesRegex(SystemExit, f"^houghstream-demo: [^\n]*{complaint}[^\n]*$"):
                self.parse(*words, display=True)

    def test_missing_samples_are_named_with_what_brings_them(self):
        options = self.parse("--samples", str(self.folder), display=True)
        (self.folder / "forest").touch()
        with self.assertRaisesRegex(SystemExit, "models/names.json: not there; install the package houghstream-samples"):
            show.find_samples(options, self.folder)


class Page(Case):
    def test_its_port_is_a_free_one_where_the_wanted_one_is_taken(self):
        with show.listen(0) as first, show.listen(first.getsockname()[1]) as second:
            self.assertNotEqual(first.getsockname()[1], second.getsockname()[1])
            self.assertEqual(second.getsockname()[0], "127.0.0.1")

    def test_what_comes_at_its_socket_is_handed_over_both_ways(self):
        # The far side listens on another address of the loopback, as it does in a network of its own.
        page = show.listen(0)
        self.addCleanup(page.close)
        port = page.getsockname()[1]
        far = socket.create_server(("127.0.0.2", port))
        self.addCleanup(far.close)

        def echo():
            connection, _ = far.accept()
            with connection:
                connection.sendall(b"heard " + connection.recv(100))

        threading.Thread(target=echo, daemon=True).start()
        connect = socket.create_connection
        with mock.patch.object(show.socket, "create_connection", lambda _: connect(("127.0.0.2", port))):
            show.Relay(page)
            with connect(("127.0.0.1", port), timeout=10) as near:
                near.sendall(b"a request")
                self.assertEqual(near.makefile("rb").read(), b"heard a request")


class Samples(Case):
    def scene(self, images):
        scene = self.folder / "scene"
        for kind in ("rgb", "depth"):
            (scene / kind).mkdir(parents=True)
        for file in ("scene_camera.json", "scene_gt.json", "scene_gt_info.json"):
            write_json(scene / file, {str(image): [file] for image in range(images)})
        for image in range(images):
            for kind in ("rgb", "depth"):
                (scene / kind / f"{image:06d}.png").write_text(f"{kind} {image}")
        return scene

    def test_they_have_every_second_image_of_the_scene(self):
        thinned = self.folder / "thinned"
        self.assertEqual(samples.thin(self.scene(12), thinned, 2, 5), 5)
        for file in ("scene_camera.json", "scene_gt.json", "scene_gt_info.json"):
            self.assertEqual(list(json.loads((thinned / file).read_text())), ["0", "2", "4", "6", "8"])
        self.assertEqual((thinned / "depth/000008.png").read_text(), "depth 8")
        self.assertEqual(len(list((thinned / "rgb").iterdir())), 5)

    def test_data_that_are_not_there_are_named(self):
        with self.assertRaisesRegex(SystemExit, "data/forest: not there, expected what tools/demo makes"):
            samples.pack(self.folder, self.folder / "data", self.folder / "samples")
        self.assertFalse((self.folder / "samples").exists())


if __name__ == "__main__":
    unittest.main()
