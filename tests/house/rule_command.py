"""The frame of the checks of the house when they are commands: the repository, one line a fault, status 1 where there is
any."""

import pathlib
import sys


def run(find_faults, holds):
    """`find_faults(root)` gives the faults, one line each; `holds` is said where there is none."""
    if len(sys.argv) != 2 or not pathlib.Path(sys.argv[1], "pipeline", "CMakeLists.txt").is_file():
        sys.exit(f"usage: {pathlib.Path(sys.argv[0]).name} REPOSITORY (the folder that holds pipeline/)")
    faults = list(find_faults(pathlib.Path(sys.argv[1])))
    print("\n".join(faults) if faults else holds)
    sys.exit(1 if faults else 0)
