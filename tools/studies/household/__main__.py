"""Options of tools/bench household. What they ask for is in plan.py, what comes of it in figures.py and report.py."""

import argparse
import pathlib

from studies import unit_runner
from studies.bop.dataset import read_store
from studies.command import Options, die, positive
from studies.records import read_json

MODELS = "../shared/realbop/ycb78/models"
TAUGHT = (*range(1, 22), *range(101, 140))  # sixty of the 78; the eighteen others are never taught
NUMBERS = (4, 7, 20, 40, 60)
QUICK_NUMBERS = (4, 7)
QUICK_STRANGERS = 5
TARGETS = ("hs-teach", "hs-evaluate", "hs-capture", "hs-detect", "hs-pose", "hs-study")


def numbers(text):
    """Between commas, each once and rising."""
    found = [positive(one) for one in text.split(",")]
    if sorted(set(found)) != found:
        raise argparse.ArgumentTypeError(f"'{text}', expected each number once, the smallest first")
    return tuple(found)


def parse(words):
    parser = Options("bench household", "Renders furnished rooms in which sixty scanned household objects that are taught and "
                                        "eighteen that never are stand together, teaches stores of 4, 7, 20, 40 and 60 objects "
                                        "in groups of at most seven, and measures how well, how fast and how surely each store "
                                        "finds its objects, beside the groups by themselves.")  # fmt: skip
    add = parser.add_argument
    add("--quick", action="store_true", help="two rooms of two frames, stores of 4 and 7 objects, five strangers, little practice")
    add("--models", type=pathlib.Path, default=MODELS, metavar="DIR", help=f"the meshes, a BOP models folder (default {MODELS})")
    add("--stores", metavar="PATHS", help="stores that hs-teach has taught before, or folders of them, between commas, instead of "
        "teaching: they are joined in this order, and --numbers takes what comes near to each")  # fmt: skip
    add("--joined", metavar="PATHS", help="stores of several of those, joined before: one that holds just the objects of a number's "
        "stores is taken instead of joining these")  # fmt: skip
    add("--numbers", type=numbers, metavar="N,N", help="of objects in a store (default 4,7,20,40,60)")
    add("--rooms", type=positive, metavar="N", help="rendered rooms (default 8)")
    add("--frames", type=positive, metavar="N", help="frames of each (default 5)")
    add("--seed", type=positive, default=1, metavar="N", help="of rooms and teaching (default 1)")
    add("--practice-rooms", type=positive, metavar="N", help="hs-teach's; default its own")
    add("--rounds", type=positive, metavar="N", help="in which times are measured, all stores in turn (default 3)")
    add("--no-add", dest="add", action="store_false", help="do not measure how long one more object takes")
    add("--scenes-only", action="store_true", help="end when the rooms are rendered")
    add("--out", type=pathlib.Path, default="out/household", metavar="DIR", help="default out/household")
    add("--fresh", action="store_true", help="render, teach and measure again even where nothing has changed")
    options = parser.parse_args(words)
    options.out = options.out.resolve()
    set_defaults(options)
    options.names = model_names(options.models)
    options.models = options.models.resolve()
    if options.joined is not None and options.stores is None:
        parser.error("--joined goes with --stores")
    options.stores = None if options.stores is None else apart(given_stores("--stores", options.stores))
    options.joined = [] if options.joined is None else given_stores("--joined", options.joined)
    choose_objects(options)
    return options


def set_defaults(options):
    quick = options.quick
    options.rooms = options.rooms or (2 if quick else 8)
    options.frames = options.frames or (2 if quick else 5)
    options.rounds = options.rounds or (1 if quick else 3)
    options.numbers = options.numbers or (QUICK_NUMBERS if quick else NUMBERS)
    options.practice_rooms = options.practice_rooms or (3 if quick else None)


def model_names(models):
    """{id: name} of the meshes."""
    if not (models / "models_info.json").is_file():
        die(f"{models}: no meshes there, expected a BOP models folder of the 78 objects; --models names another one")
    ids = sorted(map(int, read_json(models / "models_info.json")))
    file = models / "names.json"
    names = read_json(file) if file.is_file() else {}
    return {one: names.get(str(one), f"object_{one}") for one in ids}


def given_stores(option, text):
    """[(folder, {id: name})] in their order."""
    stores = []
    for path in map(pathlib.Path, text.split(",")):
        folders = [path] if (path / "store.json").is_file() else sorted(file.parent for file in path.glob("*/store.json"))
        if not folders:
            die(f"{option} {path}: no store there, expected one by hs-teach, or a folder of them")
        stores += [(folder.resolve(), read_store(folder)) for folder in folders if not folder.name.startswith(".")]
    return stores


def apart(stores):
    """These stores, of which no two hold the same object."""
    owners = {}
    for folder, known in stores:
        for name in known.values():
            if name in owners:
                die(f"--stores: {name} is in {owners[name]} and in {folder}, expected each object in one store")
            owners[name] = folder
    return stores


def choose_objects(options):
    """The ids of those that are taught, in their order, and of those that stand in the rooms."""
    if options.stores:
        known = {name for _, names in options.stores for name in names.values()}
        options.taught = [one for one, name in options.names.items() if name in known]
        if not options.taught:
            die(f"--stores: none of their objects is in {options.models}, expected some")
    else:
        options.taught = list(TAUGHT[: options.numbers[-1]])
        missing = [one for one in options.taught if one not in options.names]
        if missing:
            die(f"{options.models}: no object {missing[0]}, expected {len(options.taught)} that are taught")
        if options.numbers[-1] > len(TAUGHT):
            die(f"--numbers {options.numbers[-1]}: {len(TAUGHT)} objects are taught, expected at most as many")
    options.placed = list(options.names)
    if options.quick:
        strangers = [one for one in options.names if one not in options.taught and one not in TAUGHT]
        options.placed = sorted(options.taught + strangers[:QUICK_STRANGERS])
    least, most = (5, 10) if options.quick else (10, 25)
    options.in_a_room = (min(least, len(options.placed)), min(most, len(options.placed)))
    options.strangers = [one for one in options.placed if one not in options.taught and one not in TAUGHT]


if __name__ == "__main__":
    unit_runner.main(parse, lambda _: TARGETS, lambda _: None, "studies.household.report")
