"""Where units leave what they made, and the stamps by which it is known to be current."""

import hashlib
import json
import os
import pathlib
import shutil
import sys

from units import INPUT

HERE = pathlib.Path(__file__).resolve().parent


def write_atomically(file, text):
    file.parent.mkdir(parents=True, exist_ok=True)
    part = file.with_name(file.name + ".part")
    part.write_text(text)
    os.replace(part, file)


def sha256_of_file(file):
    digest = hashlib.sha256()
    with open(file, "rb") as data:
        while block := data.read(1 << 20):
            digest.update(block)
    return digest.hexdigest()


def sha256_of_folder(folder):
    """Of names and contents."""
    files = sorted(file for file in folder.rglob("*") if file.is_file())
    lines = [f"{file.relative_to(folder)} {sha256_of_file(file)}" for file in files]
    return hashlib.sha256("\n".join(lines).encode()).hexdigest()


def sha256_of(path):
    return sha256_of_folder(path) if path.is_dir() else sha256_of_file(path)


def remove(path):
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path)
    else:
        path.unlink(missing_ok=True)


class Store:
    """OUT/files/NAME is what a unit made, OUT/stamps/NAME.json from what, OUT/logs/NAME.txt what it said."""

    def __init__(self, out, binaries, units):
        self.out, self.binaries = pathlib.Path(out).resolve(), pathlib.Path(binaries).resolve()
        self.units = {unit.name: unit for unit in units}
        self.executables = {}

    def file(self, unit):
        return self.out / "files" / unit.name

    def part(self, unit):
        """Keeps the file's ending: programs choose a picture's format by it."""
        return self.out / "part" / self.file(unit).name

    def log(self, unit):
        return self.out / "logs" / (unit.name + ".txt")

    def _stamp(self, unit):
        return self.out / "stamps" / (unit.name + ".json")

    def executable(self, unit):
        """The words that start the unit's command."""
        name = unit.command[0]
        return [sys.executable, str(HERE / name)] if name.endswith(".py") else [str(self.binaries / name)]

    def command(self, unit):
        def path(match):
            return str(self.part(unit) if match[1] == "out" else self.file(self.units[match[1]]))

        return self.executable(unit) + [INPUT.sub(path, word) for word in unit.command[1:]]

    def _executable_digest(self, unit):
        file = self.executable(unit)[-1]
        if file not in self.executables:
            self.executables[file] = sha256_of_file(file)
        return self.executables[file]

    def digest(self, unit):
        """Of the command, its executable and what the inputs contain: a program that was built again but makes the same
        as before does not make all after it run again."""
        inputs = [self.record(self.units[name]).get("made") for name in unit.inputs]
        text = json.dumps([unit.command, self._executable_digest(unit), inputs])
        return hashlib.sha256(text.encode()).hexdigest()

    def record(self, unit):
        """What is known of the last time that the unit ran; empty if it never did."""
        try:
            return json.loads(self._stamp(unit).read_text())
        except FileNotFoundError:
            return {}

    def is_current(self, unit):
        if not all(self.is_current(self.units[name]) for name in unit.inputs):
            return False
        return self.record(unit).get("digest") == self.digest(unit) and self.file(unit).exists()

    def begin(self, unit):
        """The record of an earlier time stays until the new one: it tells how long the unit takes."""
        remove(self.file(unit))
        remove(self.out / "part")
        for path in (self.part(unit), self.file(unit), self.log(unit)):
            path.parent.mkdir(parents=True, exist_ok=True)

    def finish(self, unit, seconds):
        os.replace(self.part(unit), self.file(unit))
        record = {"digest": self.digest(unit), "made": sha256_of(self.file(unit))}
        record |= {"seconds": round(seconds, 2), "command": " ".join(unit.command)}
        write_atomically(self._stamp(unit), json.dumps(record, indent=2) + "\n")

    def forget(self, unit):
        self._stamp(unit).unlink(missing_ok=True)
        remove(self.file(unit))
