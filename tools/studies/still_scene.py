"""One image of a rendered scene as a scene of its own: what stands in it stays where it is, however long it is shown."""

import json
import shutil


def make_still_scene(scene, folder, number=0):
    """Copies the image of this number, counted from 0, of a BOP scene folder to a new one. Returns the new folder."""
    shutil.copytree(scene, folder, ignore=shutil.ignore_patterns("*.png", "*.jpg"))
    kept = None
    for file in sorted(folder.glob("*.json")):
        entries = json.loads(file.read_text())
        keys = sorted((key for key in entries if key.isdigit()), key=int)
        if not keys:
            continue
        kept = keys[number]
        file.write_text(json.dumps({"0": entries[kept]}))
    for file in sorted(scene.rglob(f"{int(kept):06d}*.*")):
        target = folder / file.relative_to(scene).parent / file.name.replace(f"{int(kept):06d}", "000000")
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(file, target)
    return folder
