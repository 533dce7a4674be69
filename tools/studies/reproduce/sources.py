"""The sources of views, background and scenes: each source adds the units that make them."""

import dataclasses
import pathlib

from studies.command import RECORDED_CAMERA as CAMERA
from studies.command import die, recorded_views
from studies.reproduce.variants import OTHER_SENSOR, OTHER_SENSOR_SCENES, SCENES, SCENES_20

RENDERED_DISTANCES = ("--min-distance", "0.75", "--max-distance", "2.1")
RECORDED_DISTANCES = ("--min-distance", "0.3", "--max-distance", "0.8")
TAUGHT_AT = ("--distance", "1")  # metres: about where UW's cameras stood from the turntable (Lai et al. 2011)
WAY, FRAMES = 300, 60  # frames along the camera's way, and those that are looked at


@dataclasses.dataclass(frozen=True)
class Source:
    training: tuple  # options of hs-train and hs-study linemod
    distances: tuple  # at which objects stand in the scenes, options of hs-study linemod
    scenes: dict  # "{NAME}" of the unit that makes it, by scene


def rendered_scenes(units, names, figure, sensor=None):
    """Frames are spread over the camera's whole way through each scene. `sensor`: another than the usual model."""
    way = ("--frames", WAY, "--every", WAY // FRAMES, *(("--sensor", sensor) if sensor else ()))
    folder = f"data/scene_{sensor}" if sensor else "data/scene"
    scenes = {}
    for scene in names:
        made = units.add(f"{folder}/{scene}", figure, "hs-render", "scene", scene, *way, "--out", "{out}")
        scenes[scene] = f"{{{made}}}"
    return scenes


def rendered(units):
    """Four objects."""
    views = units.add("data/training", "data", "hs-render", "training", *TAUGHT_AT, "--out", "{out}")
    rooms = units.add("data/background", "data", "hs-render", "background", "--count", "215", "--out", "{out}")
    training = ("--views", f"bop:{{{views}}}", "--background", f"bop:{{{rooms}}}")
    return Source(training, RENDERED_DISTANCES, rendered_scenes(units, SCENES, "data"))


def twenty(units, few):
    """The few objects and twenty, each with the scenes in which the twenty stand."""
    turntable = ("--objects", "all_20", *TAUGHT_AT)
    views = units.add("data/training_20", "objects", "hs-render", "training", *turntable, "--out", "{out}")
    scenes = rendered_scenes(units, SCENES_20, "objects")
    training = ("--views", f"bop:{{{views}}}", *few.training[2:])
    return dataclasses.replace(few, scenes=scenes), dataclasses.replace(few, training=training, scenes=scenes)


def other_sensor(units, usual):
    """Makes the same objects in scenes that another sensor saw than the one of the training views."""
    return dataclasses.replace(usual, scenes=rendered_scenes(units, OTHER_SENSOR_SCENES, "sensor", OTHER_SENSOR))


def located(folder, name):
    """The datasets' archives unpack into folders of their own, which lie in `folder` or are it."""
    places = [folder / name, *sorted(place / name for place in folder.iterdir() if place.is_dir())]
    for place in places:
        if place.is_dir():
            return place
    die(f"{folder}: no {name} in it, expected rgbd-dataset/ and rgbd-scenes/ of the UW datasets")


def uw(units, folder):
    """The UW RGB-D Object Dataset (rgbd-dataset/) and the RGB-D Scenes Dataset (rgbd-scenes/), as they unpack."""
    folder = pathlib.Path(folder)
    scenes = {}
    for scene in SCENES:
        video = located(folder, f"{scene.rpartition('_')[0]}/{scene}")
        command = ("hs-import", "uw-scene", "--camera", CAMERA, video, "{out}")
        scenes[scene] = "{" + units.add(f"data/scene/{scene}", "data", *command) + "}"
    objects = located(folder, "soda_can").parent
    views = units.add("data/uw/views", "data", "studies.reproduce.uw_views", objects, "{out}", *scenes.values())
    background = ("--background", f"images:{located(folder, 'background')}", "--camera", CAMERA)
    return Source(("--views", f"uw:{{{views}}}", *background), (), scenes)


def recorded(units, folder):
    """Images of a camera: DIR/objects, background, scenes (with boxes), clutter (without any taught object)."""
    clutter = ("hs-log", "export", "bop", f"uw:{folder}/clutter,{CAMERA}", "{out}")
    scenes = {
        "scenes": units.add("data/real/scenes", "real", "hs-import", "boxes", f"{folder}/scenes", "{out}"),
        "clutter": units.add("data/real/clutter", "real", *clutter),
    }
    training = (*recorded_views(folder), "--background", f"images:{folder}/background")
    made = {scene: "{" + name + "}" for scene, name in scenes.items()}
    return Source(training, RECORDED_DISTANCES, made)
