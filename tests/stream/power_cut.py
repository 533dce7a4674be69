"""The files that a program leaves on a disk that loses power: every file as it was when it was last synced, and of the names
that were made, moved and removed since their folder was synced the first few, in order.

The program runs with disk_recorder.cpp preloaded, which writes down what it does to a folder.
"""

import copy
import os
import subprocess
from pathlib import Path


class Disk:
    """The names of a folder, and which file each leads to. Contents are kept apart: they are synced by themselves."""

    def __init__(self, folder):
        self.folder = Path(folder)
        self.files = {}  # numbers of files by path
        self.folders = {Path(folder)}
        self.contents = {}  # by number, as they were before the program ran
        for path in self.folder.rglob("*"):
            if path.is_dir() and not path.is_symlink():
                self.folders.add(path)
            else:
                number = path.lstat().st_ino
                self.files[path] = number
                self.contents[number] = os.readlink(path).encode() if path.is_symlink() else path.read_bytes()

    def names(self):
        """A copy that operations may be applied to."""
        names = copy.copy(self)
        names.files = dict(self.files)
        names.folders = set(self.folders)
        return names

    def apply(self, operation):
        what, *words = operation
        path = Path(words[0])
        if what == "create":
            self.files[path] = int(words[1])
        elif what == "folder":
            self.folders.add(path)
        elif what == "link":
            self.files[Path(words[1])] = self.files[path]
        elif what == "remove":
            self.files.pop(path, None)
            self.folders.discard(path)
        elif what == "rename":
            self.move({path: Path(words[1])})
        elif what == "exchange":
            self.move({path: Path(words[1]), Path(words[1]): path})

    def move(self, places):
        def moved(path):
            for here, there in places.items():
                if path == here or here in path.parents:
                    return there / path.relative_to(here)
            return path

        kept = {path: number for path, number in self.files.items() if moved(path) == path and path not in places.values()}
        self.files = kept | {moved(path): number for path, number in self.files.items() if moved(path) != path}
        self.folders = {moved(path) for path in self.folders}

    def below(self, folder, contents):
        """Returns the content of a folder, as bytes by path; None where it is not there."""
        if folder not in self.folders:
            return None
        return {str(path.relative_to(folder)): contents.get(number, b"") for path, number in self.files.items() if folder in path.parents}


def record(library, folder, command, exchange=True):
    """Runs the command, and returns the disk as it was before and what the command did to it."""
    record_folder = Path(f"{folder}.record")
    record_folder.mkdir()
    disk = Disk(folder)
    environment = {"LD_PRELOAD": str(library), "HOUGHSTREAM_DISK_FOLDER": str(folder), "HOUGHSTREAM_DISK_RECORD": str(record_folder)}
    environment |= {} if exchange else {"HOUGHSTREAM_DISK_NO_EXCHANGE": "1"}
    # The sanitizers want to be loaded first, and may be second all the same.
    environment["ASAN_OPTIONS"] = os.environ.get("ASAN_OPTIONS", "") + ":verify_asan_link_order=0"
    done = subprocess.run(list(map(str, command)), env=os.environ | environment, capture_output=True, text=True, check=False, timeout=120)
    assert done.returncode == 0, done
    lines = (record_folder / "operations").read_text().splitlines()
    synced = {}
    for number, line in enumerate(lines):
        if line.startswith("sync\t"):
            synced[number] = (record_folder / str(number)).read_bytes()
    return disk, [line.split("\t") for line in lines], synced


def folders_of(operation):
    """The folders whose names an operation on names changes."""
    what, *words = operation
    if what in ("sync", "sync_folder"):
        return set()
    paths = words if what in ("rename", "exchange") else words[1:] if what == "link" else words[:1]
    return {str(Path(path).parent) for path in paths if path}


def states_after_power_cut(disk, operations, synced):
    """Yields what may be on the disk after a cut behind each operation: how many operations were done, names, contents by number."""
    states = [disk.names()]
    for operation in operations:
        states.append(states[-1].names())
        states[-1].apply(operation)
    contents = dict(disk.contents)
    safe = 0  # so many operations have left their names for certain
    for done in range(len(operations) + 1):
        if done > 0:
            what, *words = operations[done - 1]
            if what == "sync":
                contents = contents | {int(words[1]): synced[done - 1]}
            elif what == "sync_folder":
                certain = [number for number in range(done - 1) if words[0] in folders_of(operations[number])]
                safe = max([safe, *(number + 1 for number in certain)])
        for kept in range(safe, done + 1):
            yield done, states[kept], contents
