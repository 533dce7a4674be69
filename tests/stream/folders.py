"""The folders that a test of the stream is given."""

import argparse
import pathlib
import shutil


def read_arguments(description, **folders):
    """--tools, --out and the further `folders` (option=what it holds) as whole paths; the folder --out is made anew."""
    parser = argparse.ArgumentParser(description=description)
    folders = {"tools": "folder of the executables", **folders, "out": "folder for what the test makes"}
    for name, what in folders.items():
        parser.add_argument(f"--{name}", type=pathlib.Path, required=True, help=what)
    paths = {name: path.resolve() for name, path in vars(parser.parse_args()).items()}
    shutil.rmtree(paths["out"], ignore_errors=True)
    paths["out"].mkdir(parents=True)
    return argparse.Namespace(**paths)
