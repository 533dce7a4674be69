"""One picture of a rendered scene as a scene of its own: what stands in it stays where it is, however long it is shown."""

import json
import shutil

from heard import detections_by_utime
from houghstream.event_log import read_log


def fullest_picture(made):
    """The number of the picture of end_to_end_test.py's scene in which most is detected."""
    found = detections_by_utime(read_log(made / "results.log"))
    counts = [sum(one.reported for one in found[utime]) for utime in sorted(found)]
    assert max(counts) > 0, counts
    return counts.index(max(counts))


def make_still_scene(made, folder):
    """Copies the fullest picture."""
    shutil.copytree(made / "scene", folder, ignore=shutil.ignore_patterns("*.png", "*.jpg"))
    number = fullest_picture(made)
    kept = None
    for file in sorted(folder.glob("*.json")):
        entries = json.loads(file.read_text())
        keys = sorted((key for key in entries if key.isdigit()), key=int)
        if not keys:
            continue
        kept = keys[number]
        file.write_text(json.dumps({"0": entries[kept]}))
    for file in sorted((made / "scene").rglob(f"{int(kept):06d}*.*")):
        target = folder / file.relative_to(made / "scene").parent / file.name.replace(f"{int(kept):06d}", "000000")
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(file, target)
    return folder
