"""A set as BOP publishes it: its scenes, targets and models, and what of it a store of objects knows."""

import dataclasses
import hashlib
import json
import pathlib
import re

from studies.bop.subset import FILES, BadSet, chosen_images, missing_image, read, read_targets

MODELS = ("models", "models_cad", "models_eval")  # as sets call them; the first that is there
TARGETS = "test_targets_bop19.json"
SAME_SIZE = 0.1  # diameters of one object in set and store differ by no more, a share


@dataclasses.dataclass(frozen=True)
class Dataset:
    name: str
    root: pathlib.Path
    scenes: tuple  # folders, by name
    targets: pathlib.Path | None

    @property
    def models(self):
        return models_folder(self.root)


def named_folder(text):
    """NAME=ROOT or ROOT, which is called as its folder is."""
    name, _, root = text.rpartition("=")
    root = pathlib.Path(root)
    name = name or root.resolve().name
    if not re.fullmatch(r"[A-Za-z0-9_.-]+", name):
        raise BadSet(f"--dataset {text}: the name is '{name}', expected letters, digits, _ . -")
    return name, root


def models_folder(root):
    found = [root / name for name in MODELS if (root / name / "models_info.json").is_file()]
    return found[0] if found else root / MODELS[0]


def scene_folders(root, split):
    """ROOT/SPLIT/00000N, or ROOT/00000N where there is no folder SPLIT."""
    parent = root / split if (root / split).is_dir() else root
    found = [
        path
        for path in parent.iterdir()
        if re.fullmatch(r"[0-9]+", path.name) and (path / "scene_camera.json").is_file()
    ]
    return sorted(found, key=lambda path: int(path.name))


def open_dataset(text, split, every, with_models=True):
    """`with_models`: its objects will be taught. Raises BadSet in one line."""
    name, root = named_folder(text)
    if not root.is_dir():
        raise BadSet(f"{root}: no such folder, expected a BOP set")
    if with_models and not (models_folder(root) / "models_info.json").is_file():
        raise BadSet(
            f"{root / 'models' / 'models_info.json'}: not there, expected the set's models, or --objects STORE"
        )
    scenes = scene_folders(root, split)
    if not scenes:
        raise BadSet(f"{root / split}: no scenes, expected folders 000001 and so on with scene_camera.json")
    file = root / TARGETS if (root / TARGETS).is_file() else None
    dataset = Dataset(name, root, tuple(scenes), file)
    if file:
        dataset = dataclasses.replace(dataset, scenes=targeted(dataset, read_targets(file)))
    for scene in dataset.scenes:
        check_scene(dataset, scene, every)
    return dataset


def targeted(dataset, targets):
    """Only the scenes that the targets name."""
    by_id = {int(scene.name): scene for scene in dataset.scenes}
    missing = sorted(set(targets) - set(by_id))
    if missing:
        raise BadSet(
            f"{dataset.targets}: scene {missing[0]} is not in {dataset.scenes[0].parent}, expected all {len(targets)}"
        )
    return tuple(by_id[key] for key in sorted(targets))


def images_of(dataset, scene, every):
    targets = read_targets(dataset.targets)[int(scene.name)] if dataset.targets else None
    return chosen_images(scene, targets, every)


def check_scene(dataset, scene, every):
    for file in FILES:
        if not (scene / file).is_file():
            raise BadSet(f"{scene / file}: not there, expected the scene's truth")
    missing = missing_image(scene, images_of(dataset, scene, every))
    if missing:
        raise BadSet(f"{missing}: not there, expected the picture of each chosen image")


def true_objects(dataset, every):
    """(scene's name, object id, entry of scene_gt.json, entry of scene_gt_info.json) of all that is in the chosen images."""
    for scene in dataset.scenes:
        gt, info = read(scene / "scene_gt.json"), read(scene / "scene_gt_info.json")
        for image in images_of(dataset, scene, every):
            for entry, seen in zip(gt.get(str(image), []), info.get(str(image), [])):
                yield scene.name, entry["obj_id"], entry, seen


def diameters(models):
    """Millimetres by id; empty where they are not told."""
    file = models / "models_info.json"
    info = read(file) if file.is_file() else {}
    return {int(key): entry["diameter"] for key, entry in info.items() if "diameter" in entry}


def read_store(store):
    """{id: name} of the objects that a store knows."""
    content = read(store / "store.json")
    if not isinstance(content, dict) or "houghstream_store" not in content:
        raise BadSet(f"{store / 'store.json'}: no object store, expected one by hs-teach")
    return {int(entry["id"]): entry["name"] for entry in content["objects"]}


def known_objects(dataset, store):
    """{id in the set: name in the store}: by name where the set has names.json, else by id. An object of another size
    than the store's of the same id is another one."""
    by_id = read_store(store)
    file = dataset.models / "names.json"
    if file.is_file():
        own = {int(key): name for key, name in read(file).items()}
        names = set(by_id.values())
        return {key: name for key, name in own.items() if name in names}
    theirs, ours = diameters(dataset.models), diameters(store / "models")

    def same(key):
        return key not in theirs or key not in ours or abs(theirs[key] / ours[key] - 1.0) <= SAME_SIZE

    return {key: name for key, name in by_id.items() if same(key)}


def folder_digest(folder):
    """Returns a digest of the contents of small files, and of name, size and time of images: enough to see that something
    changed."""
    lines = []
    for file in sorted(path for path in folder.rglob("*") if path.is_file()):
        if file.suffix in (".json", ".txt"):
            fact = hashlib.sha256(file.read_bytes()).hexdigest()
        else:
            stat = file.stat()
            fact = f"{stat.st_size} {stat.st_mtime_ns}"
        lines.append(f"{file.relative_to(folder)} {fact}")
    return hashlib.sha256(json.dumps(lines).encode()).hexdigest()
