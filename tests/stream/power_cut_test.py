"""A power cut at any moment while something is replaced leaves the old one or the new one, whole, and everybody's files: stores by
hs-teach, logs and tables by hs-log.

Forest, models and scene are those that end_to_end_test.py has made.
"""

import shutil
import sys

from folders import read_arguments
from power_cut import record, states_after_power_cut
from store_change_test import make_store

NOTES = {"NOTES.txt": b"the handle faces left", "recordings/monday.lcmlog": b"events", "models/mug.blend": b"source"}


def put_notes(store):
    for name, content in NOTES.items():
        (store / name).parent.mkdir(exist_ok=True)
        (store / name).write_bytes(content)


def files_of(folder):
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def is_whole(found, old, new):
    return found is not None and all(found.get(name) == content for name, content in NOTES.items()) and found in (old, new)


def check_store(arguments, name, words, exchange=True):
    """A command of hs-teach; where two folders cannot be exchanged, the old store may lie beside its place for a moment."""
    folder = arguments.out / name
    store = folder / "my.store"
    make_store(arguments.made, store)
    put_notes(store)
    old = files_of(store)
    disk, operations, synced = record(arguments.recorder, folder, [arguments.tools / "hs-teach", words[0], store, *words[1:]], exchange)
    new = files_of(store)
    assert new != old and sorted(path.name for path in folder.iterdir()) == ["my.store"], operations
    states = seen_old = seen_new = 0
    for done, names, contents in states_after_power_cut(disk, operations, synced):
        found = names.below(store, contents)
        if found is None and not exchange:
            found = names.below(folder / ".my.store.before", contents)
        assert is_whole(found, old, new), (name, done, operations[:done], differences(found, old, new))
        states += 1
        seen_old += found == old
        seen_new += found == new
    assert seen_old and seen_new, "expected that some cuts are before the exchange, and some behind it"
    check_order(operations, store)
    unsynced = [operation for operation in operations if not operation[0].startswith("sync")]
    assert any(not is_whole(names.below(store, contents), old, new) for _, names, contents in states_after_power_cut(disk, unsynced, {})), (
        "expected that a program that syncs nothing leaves a torn store")
    print(f"{name}: {len(operations)} operations, {states} states after a power cut: {seen_old} old, {seen_new} new, none torn")


def differences(found, old, new):
    if found is None:
        return "there is no store"
    return {name: {which: None if of.get(name) is None else len(of[name]) for which, of in (("found", found), ("old", old), ("new", new))}
            for name in found.keys() | old.keys() | new.keys() if not found.get(name) == old.get(name) == new.get(name)}  # fmt: skip


def check_order(operations, store):
    """Files, their folders, the exchange, the folder above, and only then is anything removed."""
    what = [operation[0] for operation in operations]
    step = next(i for i, operation in enumerate(operations)
                if operation[0] in ("exchange", "rename") and str(store) in operation[1:])  # fmt: skip
    made = {operation[1] for operation in operations[:step] if operation[0] == "sync"}
    for part in ("store.json", "forest", "models/models_info.json", "models/names.json"):
        assert any(path.endswith(f"/{part}") for path in made), (part, made)
    assert ["sync_folder", str(store.parent)] in operations[step:], operations[step:]
    above = operations.index(["sync_folder", str(store.parent)], step)
    assert "remove" not in what[step:above], operations[step:above]


def check_file(arguments, name, make, command):
    """A command that replaces a file."""
    folder = arguments.out / name
    folder.mkdir(parents=True)
    file = folder / "output"
    make(file)
    old = file.read_bytes()
    disk, operations, synced = record(arguments.recorder, folder, [*command, file])
    new = file.read_bytes()
    assert new != old, name
    states = 0
    for done, names, contents in states_after_power_cut(disk, operations, synced):
        found = names.below(folder, contents).get("output")
        good = (new,) if done == len(operations) else (old, new)  # it is on the disk when the program has ended
        assert found in good, (name, done, operations[:done], found if found is None else len(found))
        states += 1
    print(f"{name}: {len(operations)} operations, {states} states after a power cut, each the old or the new one")


def main():
    arguments = read_arguments(__doc__, made="what end_to_end_test.py has made", recorder="disk_recorder")
    check_store(arguments, "rename", ("rename", "bowl", "dish"))
    check_store(arguments, "remove", ("remove", "bowl"))
    check_store(arguments, "rename_without_exchange", ("rename", "bowl", "dish"), exchange=False)
    hs_log = arguments.tools / "hs-log"
    scene = arguments.made / "scene.log"
    check_file(arguments, "log", lambda file: shutil.copy(scene, file), [hs_log, "filter", "--replace", "-e", "0.1", scene])
    check_file(arguments, "table", lambda file: file.write_text("old"), [hs_log, "export", "csv", "--replace", arguments.made / "results.log"])


if __name__ == "__main__":
    sys.exit(main())
