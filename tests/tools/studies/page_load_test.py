"""Tests of what is measured of a viewer of hs-view's page. Usage: PYTHONPATH=tools:build/python page_load_test.py"""

import http.server
import threading
import time
import unittest

from studies import page_load
from studies.stream import Usage

FRAMES = 5


class Page(http.server.BaseHTTPRequestHandler):
    """Serves the page as hs-view does: chunks of events, of which some are no frames, and images on a connection that is
    kept."""

    protocol_version = "HTTP/1.1"

    def do_GET(self):
        self.server.asked.append(self.path)
        self.send_response(200)
        if self.path != "/events":
            self.send_header("Content-Length", "1000")
            self.end_headers()
            self.wfile.write(bytes(1000))
            return
        self.send_header("Transfer-Encoding", "chunked")
        self.end_headers()
        events = [b"event: frame\ndata: {}\n\n"] * FRAMES + [b"event: stream\ndata: {}\n\n", b": still here\n\n"]
        for event in events:
            self.wfile.write(b"%x\r\n%s\r\n" % (len(event), event))
        self.server.leave.wait(20)
        self.wfile.write(b"0\r\n\r\n")

    def log_message(self, *_):
        pass


class Viewer(unittest.TestCase):
    def test_he_asks_for_the_images_of_each_frame_and_leaves(self):
        server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Page)
        server.asked, server.leave = [], threading.Event()
        threading.Thread(target=server.serve_forever, daemon=True).start()
        viewer = page_load.Viewer(server.server_address[1])
        end = time.monotonic() + 20
        while viewer.bytes < 2000 * FRAMES and time.monotonic() < end:
            time.sleep(0.01)
        server.leave.set()
        viewer.leave()
        server.shutdown()
        server.server_close()
        self.assertFalse(viewer.is_alive())
        self.assertEqual((viewer.frames, viewer.bytes), (FRAMES, 2000 * FRAMES))
        self.assertEqual(server.asked, ["/events", *["/picture/colour.jpg", "/picture/depth.jpg"] * FRAMES])


class Figures(unittest.TestCase):
    def test_of_a_replay(self):
        observed = {
            "latency_ms": {"total": {"p50": 25.0, "p99": 48.0}},
            "processes": {"hs-pose": {"received": 1798, "skipped": 3, "lost": 0}},
        }
        self.assertEqual(
            page_load.figures(observed, 1800, 3.0, 60),
            {"p50_ms": 25.0, "p99_ms": 48.0, "lost": 2, "skipped": 3, "page_cores": 0.05},
        )

    def test_what_hs_view_took_is_what_its_clock_went_on(self):
        usage = Usage()
        for now, cpu in ((0.0, 2.0), (1.0, 2.5), (9.0, 5.0)):
            usage.add(now, cpu, 100.0)
        self.assertEqual(page_load.cpu_seconds(usage), 3.0)

    def test_differences_are_of_pairs(self):
        pairs = [
            {"alone": {"p50_ms": alone, "p99_ms": 40.0}, "viewed": {"p50_ms": alone + more, "p99_ms": 41.0}}
            for alone, more in ((20.0, 1.0), (30.0, -1.0), (25.0, 0.5))
        ]
        found = page_load.compare(pairs)
        self.assertEqual(found["alone"]["p50_ms"], 25.0)
        self.assertEqual(found["difference"]["p50_ms"], {"median": 0.5, "least": -1.0, "greatest": 1.0})
        self.assertEqual(found["difference"]["p99_ms"]["median"], 1.0)


if __name__ == "__main__":
    unittest.main()
