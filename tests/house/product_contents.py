"""Looks into the product's programs for what exists for comparisons only: nm's names of functions, ldd's libraries.

Prints one line per fault and exits with 1 when there is any. Usage: product_contents.py BIN
"""

import pathlib
import re
import subprocess
import sys

ON_THE_ROBOT = ("hs-capture", "hs-detect", "hs-pose", "hs-track", "hs-view", "hs-stream", "hs-log", "hs-doctor")
TEACHING = ("hs-train", "hs-evaluate", "hs-fuse", "hs-import", "hs-observe")
RENDERING = ("hs-teach",)  # which holds the rendered world, and no other study
COMPARING = ("hs-study",)  # whose names are found, else none would be found anywhere
STUDIES = re.compile(r"houghstream::(\w+::)*(baseline|world|studies)::|scale_space|honv|curvature_planes|pfh_planes|register_pcl"
                     r"|houghstream::(\w+::)*(\w*([Gg]all|ScaleSpace|StudyDetector)\w*|reference_\w+)|make_named_scene|light_world")
WORLD = re.compile(r"houghstream::(\w+::)*world::|make_named_scene|light_world")
PCL = re.compile(r"\blibpcl_\w+|\blibvtk\w*")


def output_of(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def studies_in(program):
    return sorted({m.group() for m in map(STUDIES.search, output_of("nm", "-C", str(program)).split("\n")) if m})


def faults_of(program):
    names = studies_in(program)
    if program.name in RENDERING:
        names = [name for name in names if not WORLD.fullmatch(name)]
    libraries = sorted(set(PCL.findall(output_of("ldd", str(program)))))
    return [f"{program.name}: holds {found}" for found in [*names, *libraries]]


def main():
    if len(sys.argv) != 2 or not pathlib.Path(sys.argv[1], "hs-detect").is_file():
        sys.exit("usage: product_contents.py BIN (the folder that holds hs-detect)")
    folder = pathlib.Path(sys.argv[1])
    faults = [fault for name in (*ON_THE_ROBOT, *TEACHING, *RENDERING) for fault in faults_of(folder / name)]
    faults += [f"{name}: no name of a study found, expected some" for name in COMPARING if not studies_in(folder / name)]
    print("\n".join(faults) if faults else "the product holds no study")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
