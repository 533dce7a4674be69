"""What the stand-ins for programs share (bop_fakes, household_fakes, reproduce_fakes, teach_fakes)."""

import json
import pathlib
import stat
import sys


def install(folder, names, file):
    """Makes a program of each name, which runs the Python file with the name before its words; quickly, without the site's
    packages and without leaving bytecode."""
    folder.mkdir(parents=True)
    for name in names:
        program = folder / name
        program.write_text(f'#!/bin/sh\nexec "{sys.executable}" -BESs "{pathlib.Path(file).resolve()}" {name} "$@"\n')
        program.chmod(program.stat().st_mode | stat.S_IXUSR)


def write_json(file, value):
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(json.dumps(value))


def value_of(words, option):
    return words[words.index(option) + 1]
