"""The parts that all commands of a person share: options, lines of progress, installing and building."""

import argparse
import glob
import os
import re
import subprocess
import sys
import time

from studies.records import REPOSITORY, commit_name

START = float(os.environ.setdefault("HOUGHSTREAM_START", str(time.time())))  # stays when a command starts itself again
TEST_SCENES = ("table_small_1", "table_small_2", "desk_1", "desk_2", "kitchen_small_1", "meeting_small_1")
RECORDED_CAMERA = "640x480,525,525,319.5,239.5"
RECORDED_INSTANCES = "ornament_3,ornament_1,koaramarch_1,pack_2,bottle_2,can_1,can_2"
RECORDED_NAMES = "can_1=can,can_2=can"


def recorded_views(folder):
    """Options of hs-train and its like for the camera-recorded training views in FOLDER/objects."""
    return ("--views", f"uw:{folder}/objects", "--camera", RECORDED_CAMERA, "--rename", RECORDED_NAMES,
            "--instances", RECORDED_INSTANCES)  # fmt: skip


def step(words):
    """A line of progress with the seconds since the start."""
    print(f"[{time.time() - START:4.0f} s] {words}", flush=True)


def die(words):
    sys.exit(f"{os.environ.get('HOUGHSTREAM_COMMAND', 'studies')}: {words}")


def positive(text):
    if not re.fullmatch(r"[1-9][0-9]*", text):
        raise argparse.ArgumentTypeError(f"'{text}', expected a number from 1")
    return int(text)


def some_of(known, what):
    """The type of an option that names some of the known, separated by commas; their order is the known one's."""

    def parse(text):
        names = text.split(",")
        for name in names:
            if name not in known:
                raise argparse.ArgumentTypeError(f"unknown {what} {name}, expected {', '.join(known)}")
        return tuple(name for name in known if name in names)

    return parse


class Options(argparse.ArgumentParser):
    """Wrong options end the command with one line. --bin names programs that are there already: none are built. A launcher
    that is installed under another name says so in $HOUGHSTREAM_CALLED."""

    def __init__(self, name, description):
        called = os.environ.get("HOUGHSTREAM_CALLED", f"tools/{name}")
        os.environ["HOUGHSTREAM_COMMAND"] = os.path.basename(called)
        super().__init__(prog=called, description=description, allow_abbrev=False)
        self.add_argument("--bin", metavar="DIR", help="programs that are there already; installs and builds nothing")

    def error(self, message):
        die(f"{message}; --help names the options")


def recorded_folder(given, part):
    """Camera-recorded data: DIR, or None for "". Not given, ../shared/realdata where it is there."""
    found = given
    if given is None:
        found = "../shared/realdata" if os.path.isdir(f"../shared/realdata/{part}") else ""
    if found and not os.path.isdir(f"{found}/{part}"):
        die(f"{found}: no folder {part}/ in it, expected camera-recorded data")
    return os.path.realpath(found) if found else None


def prepare(options, targets):
    """Installs what is missing, by tools/setup with the words `options.setup`, and builds the targets. Returns the folder of
    the programs."""
    commit_name()  # figures are of what is built, whatever is checked out meanwhile
    if options.bin:
        return know_messages(os.path.realpath(options.bin))
    if "HOUGHSTREAM_PRIVATE_NETWORK" not in os.environ:  # else this has been done before the command started itself again
        if subprocess.run(["tools/setup", *getattr(options, "setup", ())], cwd=REPOSITORY, check=False).returncode != 0:
            die("tools/setup failed")
        step("build")
        build = [
            "bash",
            "-c",
            'source tools/common.sh && configure_and_build build Release -- "$@"',
            "build",
            "houghstream_python",
            *targets,
        ]
        if subprocess.run(build, cwd=REPOSITORY, check=False).returncode != 0:
            die("the build failed")
    return know_messages(str(REPOSITORY / "build" / "bin"))


def know_messages(programs):
    """The Python package houghstream that was built or installed with the programs is the one that is imported, by what is
    started from here too. Returns `programs`."""
    installed = sorted(glob.glob(os.path.join(glob.escape(programs), "../lib/python3*/dist-packages")))
    for package in (os.path.join(programs, "../python"), *installed):
        folder = os.path.realpath(package)
        if os.path.isfile(os.path.join(folder, "houghstream", "__init__.py")):
            sys.path.insert(0, folder)
            os.environ["PYTHONPATH"] = ":".join([folder, *filter(None, [os.environ.get("PYTHONPATH")])])
            break
    return programs


def call(*words, into=None):
    """Runs a program to its end, its output in a file; one line where it fails."""
    words = [str(word) for word in words]
    if into:
        into.parent.mkdir(parents=True, exist_ok=True)
    with open(into, "w") if into else open(os.devnull, "w") as output:
        status = subprocess.run(words, stdout=output, check=False).returncode
    if status != 0:
        die(f"{os.path.basename(words[0])} failed with status {status}: {' '.join(words)}")
