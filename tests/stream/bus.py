"""Processes on an LCM bus of their own: a private network namespace, so that nothing else is heard or disturbed."""

import argparse
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time


def read_arguments(description, **folders):
    """--tools, --out and the further `folders` (option=what it holds) as whole paths; the folder --out is made anew."""
    parser = argparse.ArgumentParser(description=description)
    folders = {"tools": "folder of the executables", **folders, "out": "folder for what the test makes"}
    for name, what in folders.items():
        parser.add_argument(f"--{name}", type=pathlib.Path, required=True, help=what)
    paths = {name: path.resolve() for name, path in vars(parser.parse_args()).items()}
    shutil.rmtree(paths["out"], ignore_errors=True)
    paths["out"].mkdir(parents=True)
    return argparse.Namespace(**paths)


def enter_private_network():
    """Starts this script again inside a network namespace; where that is not allowed, goes on in the machine's."""
    if os.environ.get("HOUGHSTREAM_PRIVATE_NETWORK"):
        return
    environment = dict(os.environ, HOUGHSTREAM_PRIVATE_NETWORK="1", LCM_DEFAULT_URL="udpm://239.255.76.67:7667?ttl=0")
    set_up = 'ip link set lo up multicast on && ip route add 224.0.0.0/4 dev lo && exec "$@"'
    inside = ["unshare", "-rn", "sh", "-c", set_up, "sh", sys.executable, *sys.argv]
    if subprocess.run(["unshare", "-rn", "true"], capture_output=True, check=False).returncode == 0:
        sys.exit(subprocess.run(inside, env=environment, check=False).returncode)
    print("no private network namespace here (unshare -rn): using the machine's own network", flush=True)
    os.environ["LCM_DEFAULT_URL"] = f"udpm://239.255.76.67:{20000 + os.getpid() % 20000}?ttl=0"


class Process:
    """A Houghstream process in the background, its log in a file."""

    def __init__(self, folder, *command):
        self.name = os.path.basename(command[0])
        self.log = folder / f"{self.name}.err"
        with open(self.log, "w", encoding="utf-8") as log:
            self.process = subprocess.Popen([str(part) for part in command], stderr=log, stdout=subprocess.DEVNULL)

    def wait_until_ready(self, seconds=20):
        end = time.monotonic() + seconds
        while "ready" not in self.log.read_text():
            assert self.process.poll() is None, f"{self.name} ended: {self.log.read_text()}"
            assert time.monotonic() < end, f"{self.name} is not ready after {seconds} s"
            time.sleep(0.02)

    def wait(self, seconds):
        assert self.process.wait(seconds) == 0, f"{self.name}: {self.log.read_text()}"

    def stop(self):
        """Ends it as a user does; it has one second, and here two more because tests share the processor."""
        start = time.monotonic()
        self.process.send_signal(signal.SIGINT)
        self.wait(10)
        took = time.monotonic() - start
        assert took < 3.0, f"{self.name} took {took:.2f} s to end"

    def kill(self):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
