"""What hs-log record writes beside what was sent, on a private network: all of it, by pattern, what is lost, and what becomes
of a log whose name is taken, whose recorder is killed or whose disk is full.

Usage: record_test.py --tools FOLDER --out FOLDER
"""

import argparse
import contextlib
import ctypes
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import sys
import time
import unittest

from houghstream.event_log import read_log
from houghstream.image_metadata_t import image_metadata_t
from scripted_stream import ToldStream, frame_message, status_message
from studies.stream import Process, enter_private_network

SECONDS = 60  # at most, for what takes a second where nothing else runs


class Bytes:
    """A message that is bytes already."""

    def __init__(self, data):
        self.data = data

    def encode(self):
        return self.data


def numbered_frame(number):
    message = frame_message(1000 * number + 1, number)
    entry = image_metadata_t()
    entry.key, entry.value = "houghstream.sequence", str(number).encode()
    entry.n = len(entry.value)
    message.images[0].metadata, message.images[0].nmetadata = [entry], 1
    return message


def wait_until(holds, what):
    end = time.monotonic() + SECONDS
    while not holds():
        assert time.monotonic() < end, what
        time.sleep(0.02)


def allow_small_files():
    """The kernel refuses larger ones, as a full disk does."""
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (200_000, 200_000))


@contextlib.contextmanager
def held_threads(pid):
    """Holds every thread of a process but its first, as a busy machine may do. Skips the test where that is refused."""
    attach, detach, wait_for_threads = 16, 17, 0x40000000  # <sys/ptrace.h>, <linux/wait.h>
    ptrace = ctypes.CDLL(None).ptrace
    ptrace.argtypes = [ctypes.c_long, ctypes.c_long, ctypes.c_void_p, ctypes.c_void_p]
    threads = [int(name) for name in os.listdir(f"/proc/{pid}/task") if int(name) != pid]
    held = [thread for thread in threads if ptrace(attach, thread, None, None) == 0]
    try:
        for thread in held:
            os.waitpid(thread, wait_for_threads)
        if held != threads:
            raise unittest.SkipTest("this machine lets no process hold another's threads")
        yield
    finally:
        for thread in held:
            ptrace(detach, thread, None, None)


class Record(unittest.TestCase):
    arguments = None

    def setUp(self):
        self.hs_log = self.arguments.tools / "hs-log"
        self.folder = self.arguments.out / self.id().rpartition(".")[2]
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir(parents=True)
        self.bus = ToldStream()
        self.addCleanup(self.bus.socket.close)

    def start(self, *words, name="hs-log"):
        process = Process(self.folder, self.hs_log, "record", *words, name=name)
        self.addCleanup(process.kill)
        process.wait_until_ready(SECONDS)
        return process

    def send(self, *messages):
        for channel, data in messages:
            self.bus.send(channel, Bytes(data))

    def recorded(self, name="take.lcmlog"):
        return [(event.channel, event.data) for event in read_log(self.folder / name)]

    def test_all_that_is_sent_until_ctrl_c(self):
        before = time.time()
        sent = [(f"CHANNEL_{number % 3}", bytes([number]) * (100 * number + 1)) for number in range(200)]
        process = self.start(self.folder / "take.lcmlog")
        self.send(*sent)
        asked = time.monotonic()
        process.stop(10)
        self.assertLess(time.monotonic() - asked, 5)
        recorded = self.recorded()
        self.assertEqual(len(recorded), len(sent))
        self.assertTrue(recorded == sent, "other messages, or in another order")
        for event in read_log(self.folder / "take.lcmlog"):
            self.assertTrue(before <= 1e-6 * event.timestamp <= time.time(), event.timestamp)
        words = process.log.read_text()
        self.assertIn(f"200 events on 3 channels, {1e-6 * sum(len(data) for _, data in sent):.1f} MB, in {self.folder}/take.lcmlog", words)
        self.assertIn("nothing was lost", words)

    def test_what_arrived_before_ctrl_c_is_taken_by_a_late_thread(self):
        process = self.start(self.folder / "take.lcmlog")
        with held_threads(process.process.pid):
            self.send(("A", b"x"))
            process.ask_to_end()
            time.sleep(0.3)  # ten times what the recorder waits for where the kernel holds nothing
        process.wait(10)
        self.assertEqual(self.recorded(), [("A", b"x")])

    def test_channels_by_pattern(self):
        process = self.start(self.folder / "take.lcmlog", "-c", "LEFT", "--channel", "B.*|C")
        for channel in ("LEFT", "LEFTOVER", "B", "BB", "AB", "C", "CC"):
            self.send((channel, b"x"))
        process.stop(10)
        self.assertEqual([channel for channel, _ in self.recorded()], ["LEFT", "B", "BB", "C"])

    def test_it_ends_by_itself(self):
        process = self.start(self.folder / "take.lcmlog", "--seconds", "0.5")
        self.send(("A", b"x"))
        process.wait(SECONDS)
        self.assertEqual(self.recorded(), [("A", b"x")])

    def test_a_taken_name(self):
        (self.folder / "take.lcmlog").write_bytes(b"mine")
        for words, name in (((), "take_2.lcmlog"), (("--replace",), "take.lcmlog")):
            process = self.start(self.folder / "take.lcmlog", *words)
            self.send(("A", name.encode()))
            process.stop(10)
            self.assertEqual(self.recorded(name), [("A", name.encode())])
            if not words:
                self.assertEqual((self.folder / "take.lcmlog").read_bytes(), b"mine")

    def test_a_killed_recorder_leaves_what_it_has(self):
        process = self.start(self.folder / "take.lcmlog")
        partial = self.folder / "take.lcmlog.partial"
        for number in range(100):
            self.send(("A", bytes([number]) * 10_000))
        wait_until(lambda: partial.stat().st_size > 500_000, "nothing reaches the disk")
        process.kill()
        again = self.start(self.folder / "take.lcmlog", name="again")
        self.send(("A", b"again"))
        again.stop(10)
        self.assertEqual(self.recorded(), [("A", b"again")])
        self.assertFalse(partial.exists())
        whole = self.folder / "whole.lcmlog"
        subprocess.run([self.hs_log, "filter", self.folder / "take.interrupted-1.lcmlog", whole], check=True, capture_output=True)
        events = [event.data for event in read_log(whole)]
        self.assertGreater(len(events), 40)
        self.assertEqual(events, [bytes([number]) * 10_000 for number in range(len(events))])

    def test_what_the_kernel_drops_is_counted(self):
        process = self.start(self.folder / "take.lcmlog")
        sent = 1000
        process.process.send_signal(signal.SIGSTOP)  # 60 MB, while 16 MB may wait at most
        for number in range(sent):
            self.send(("A", number.to_bytes(4, "big") * 15_000))
        process.process.send_signal(signal.SIGCONT)
        time.sleep(0.3)
        process.stop(10)
        dropped = re.search(r"the kernel dropped (\d+) datagrams of at most 64 kB; mend it with: sudo sysctl", process.log.read_text())
        self.assertTrue(dropped, process.log.read_text())
        self.assertGreater(int(dropped[1]), 0)
        self.assertEqual(len(self.recorded()) + int(dropped[1]), sent)

    def test_frames_that_are_missing_are_counted(self):
        process = self.start(self.folder / "take.lcmlog", "-c", "OPENNI_FRAME|.*STATUS")
        for number in (0, 1, 2, 5, 6):
            self.bus.send("OPENNI_FRAME", numbered_frame(number))
            self.bus.send("HOUGHSTREAM_STATUS", status_message(number))
        process.stop(10)
        self.assertEqual(len(self.recorded()), 10)
        self.assertIn("take.lcmlog: lost: 2 frames of OPENNI_FRAME are missing in its numbering", process.log.read_text())

    def test_nothing_is_no_log(self):
        done = subprocess.run([self.hs_log, "record", self.folder / "take.lcmlog", "--seconds", "0.2", "-c", "NOBODY"],
                              capture_output=True, text=True, timeout=SECONDS, check=False)  # fmt: skip
        self.assertEqual(done.returncode, 1)
        self.assertIn("no message on NOBODY at udpm://", done.stderr)
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_a_log_is_not_recorded(self):
        done = subprocess.run([self.hs_log, "record", self.folder / "take.lcmlog", "-l", f"file://{__file__}"],
                              capture_output=True, text=True, timeout=SECONDS, check=False)  # fmt: skip
        self.assertEqual(done.returncode, 1)
        self.assertIn("a log is copied by hs-log filter, expected a network URL", done.stderr)

    def test_a_full_disk_ends_it_and_keeps_what_is_there(self):
        words = self.folder / "words.txt"
        with open(words, "w", encoding="utf-8") as log:
            process = subprocess.Popen([self.hs_log, "record", self.folder / "take.lcmlog"], stderr=log, stdout=log, preexec_fn=allow_small_files)
        self.addCleanup(process.kill)
        wait_until(lambda: "ready" in words.read_text(), "it is not ready")
        for number in range(100):
            self.send(("A", bytes([number]) * 10_000))
        self.assertEqual(process.wait(SECONDS), 1)
        self.assertIn("File too large; what was recorded until then is in", words.read_text())
        self.assertEqual([file.name for file in self.folder.glob("take*")], ["take.lcmlog.partial"])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tools", type=pathlib.Path, required=True, help="folder of hs-log")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="folder for logs and words")
    Record.arguments = parser.parse_args()
    enter_private_network()
    unittest.main(argv=sys.argv[:1])


if __name__ == "__main__":
    main()
