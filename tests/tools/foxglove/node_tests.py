"""Programs for node and the npm packages that they need, which tools/setup installs into the build folder."""

import os
import pathlib
import shutil
import subprocess
import sys

SKIPPED = 77
HERE = pathlib.Path(__file__).resolve().parent


def require_packages(packages):
    """Ends this program as skipped, with a line that says what is missing, unless node and the packages are there."""
    if shutil.which("node") is None:
        print("skipped: no node here; sudo apt-get install nodejs")
        sys.exit(SKIPPED)
    installed = packages / "package-lock.json"
    if not (packages / "node_modules").is_dir() or installed.read_bytes() != (HERE / "package-lock.json").read_bytes():
        print(f"skipped: {packages} has not the npm packages of {HERE / 'package-lock.json'}; tools/setup installs them")
        sys.exit(SKIPPED)


def node_command(packages, script, *arguments):
    """The words that start a script of this folder, and the environment that it needs."""
    return ["node", str(HERE / script), *map(str, arguments)], {**os.environ, "NODE_PATH": str(packages / "node_modules")}


def run_node(packages, script, *arguments):
    """What a script of this folder prints."""
    command, environment = node_command(packages, script, *arguments)
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, f"{' '.join(command)}: {done.stderr}"
    return done.stdout
