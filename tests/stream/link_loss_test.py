"""A bus with ttl=1 whose link goes down, is taken out, or is not there yet: nobody ends, each process says it once, and results
go on soon after the link's return. The link is a veth pair in a network namespace. Uses what end_to_end_test.py has made.
"""

import re
import subprocess
import sys
import time

from folders import read_arguments
from studies.network import MULTICAST, ip
from studies.soak.wire import Listener
from studies.stream import Process
from two_hosts_test import enter_own_namespace

PORT = 7667
GONE, BACK = "waiting until the bus can be reached", "the bus can be reached again"
CHANNELS = ("OPENNI_FRAME", "HOUGHSTREAM_DETECTIONS", "HOUGHSTREAM_POSES", "HOUGHSTREAM_OBJECTS", "HOUGHSTREAM_PREVIEW",
            "HOUGHSTREAM_TEACHING", "HOUGHSTREAM_STATUS")  # fmt: skip
OUTAGE_S = 4.0  # longer than a take waits for a stream that is silent
BUSY_S = 30.0  # a machine that does other things too


def plug_in():
    ip("link", "add", "end_a", "type", "veth", "peer", "name", "end_b")
    ip("address", "add", "10.77.0.1/24", "dev", "end_a")
    ip("link", "set", "end_b", "up")
    bring_up()


def pull_out():
    ip("link", "del", "end_a")


def bring_up():
    ip("link", "set", "end_a", "up")
    ip("route", "add", MULTICAST, "dev", "end_a")


def take_down():
    ip("link", "set", "end_a", "down")


def wait_for(process, pattern, count, seconds=BUSY_S):
    end = time.monotonic() + seconds
    while len(re.findall(pattern, process.log.read_text())) < count:
        assert process.runs(), process.log.read_text()
        assert time.monotonic() < end, f"{process.name} has not said '{pattern}' {count} times:\n{process.log.read_text()}"
        time.sleep(0.02)


def wait_for_results():
    """Seconds until each channel has a message."""
    start = time.monotonic()
    listener = Listener(PORT, CHANNELS)
    try:
        took = {}
        for channel in CHANNELS:
            message = listener.wait_for(channel, lambda _: True, BUSY_S)
            assert message, f"nothing on {channel} within {BUSY_S} s"
            took[channel] = round(message.time - start, 2)
        return took
    finally:
        listener.stop()


def start_all(tools, made, folder):
    """Starts the stream and an observer, each with its number of processes that say what becomes of the bus."""
    models = made / "views" / "models"
    stream = Process(folder, tools / "hs-stream", "--source", f"bop:{made / 'scene'}", "--capture-options=--loop --rate 5", "--forest",
                     made / "small.forest", "--models", models, "--track", "--view-options=--preview", "--every", 1)
    observer = Process(folder, tools / "hs-observe", "--csv", folder / "observed.csv", "--out", folder / "observed.json")
    return {stream: 6, observer: 1}


def start_take(tools, folder):
    return Process(folder, tools / "hs-teach", "show", "--from-stream", "--name", "shown", "--no-teach", "--seconds", 300)


def main():
    enter_own_namespace()
    arguments = read_arguments(__doc__, made="what end_to_end_test.py has made")
    tools, made, folder = arguments.tools, arguments.made, arguments.out
    ip("link", "set", "lo", "up")
    processes = start_all(tools, made, folder)
    stream = next(iter(processes))
    try:
        for process in processes:
            wait_for(process, GONE, 1)
        assert "started, process" not in stream.log.read_text(), "without a bus hs-stream would not hear of them"
        plug_in()
        wait_for(stream, r"view [1-9][\d.]* Hz", 1, 90)
        processes[start_take(tools, folder)] = 1
        print(f"link there after the start: {wait_for_results()}")
        said = {process: len(re.findall(GONE, process.log.read_text())) for process in processes}
        for number, (name, away, back) in enumerate((("down", take_down, bring_up), ("pulled out", pull_out, plug_in)), 1):
            away()
            for process, voices in processes.items():
                wait_for(process, GONE, said[process] + number * voices)
            time.sleep(OUTAGE_S)
            back()
            print(f"link {name} and back: {wait_for_results()}")
            for process, voices in processes.items():
                wait_for(process, BACK, said[process] + number * voices)
        for process, voices in processes.items():
            log = process.log.read_text()
            assert len(re.findall(GONE, log)) == said[process] + 2 * voices, f"{process.name} says it more than once:\n{log}"
            assert "starts again" not in log, log
            assert re.search(r"messages were not sent", log), log
        for process in list(processes)[:2]:
            process.stop(30.0)
        assert re.search(r"ends: .*; [1-9]\d* messages not sent", stream.log.read_text()), stream.log.read_text()
    finally:
        for process in reversed(processes):
            process.kill()
        subprocess.run(["ip", "link", "del", "end_a"], check=False)


if __name__ == "__main__":
    sys.exit(main())
