"""A small house in a folder of its own, for the tests of the rules."""

import pathlib
import tempfile


def faults_of(files, find_faults):
    """Returns what `find_faults` says of a folder that holds `files` ({path: text})."""
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            file = pathlib.Path(folder, name)
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text)
        return find_faults(pathlib.Path(folder))
