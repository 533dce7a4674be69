"""The objects of a store in single images, without LCM: the example find_in_images on a scene whose truth is known.

Forest, models and scene are those that end_to_end_test.py has made.
"""

import json
import math
import re
import subprocess

from folders import read_arguments
from store_change_test import make_store

CAMERA = "525,525,319.5,239.5"
NEAR_M = 0.02
EVERY = 3  # frames
LINE = re.compile(r"^soda_can +score [\d.]+, at (-?[\d.]+) (-?[\d.]+) (-?[\d.]+) m, quality [\d.]+$", re.MULTILINE)


def start(program, store, scene, image):
    files = [scene / kind / f"{image:06d}.png" for kind in ("rgb", "depth")]
    return subprocess.run([program, store, *files, CAMERA], capture_output=True, text=True, check=False, timeout=60)


def find(program, store, scene, image):
    """Returns where soda_cans are said to be in an image, metres."""
    done = start(program, store, scene, image)
    assert done.returncode == 0, done
    return [tuple(map(float, place)) for place in LINE.findall(done.stdout)]


def main():
    arguments = read_arguments(__doc__, tools="folder of find_in_images", made="what end_to_end_test.py has made")
    program, scene = arguments.tools / "find_in_images", arguments.made / "scene"
    store = arguments.out / "my store"
    make_store(arguments.made, store)
    names = json.loads((store / "models" / "names.json").read_text())
    number = next(int(number) for number, name in names.items() if name == "soda_can")
    truth = json.loads((scene / "scene_gt.json").read_text())
    looked_at = sorted(map(int, truth))[::EVERY]
    right = 0
    for image in looked_at:
        there = [[value / 1000 for value in entry["cam_t_m2c"]] for entry in truth[str(image)] if entry["obj_id"] == number]
        found = find(program, store, scene, image)
        right += any(math.dist(place, true) < NEAR_M for place in found for true in there)
    assert 2 * right >= len(looked_at), f"the soda can is where it is in {right} of {len(looked_at)} images"

    (store / "store.json").unlink()
    done = start(program, store, scene, looked_at[0])
    assert done.returncode == 1 and done.stderr.count("\n") == 1 and done.stderr.startswith("find_in_images: "), done
    print(f"found in {right} of {len(looked_at)} images")


if __name__ == "__main__":
    main()
