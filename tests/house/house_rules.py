"""Finds what a newcomer would trip over: folders without a README, strangers at the top level, commit hashes in prose, unfinished work, scratch
memory without an owner, Python functions of many parameters (those of C++ are clang-tidy's). It counts neither files nor lines.

Prints one line per fault and exits with 1 when there is any. Usage: house_rules.py REPOSITORY
"""

import ast
import pathlib
import re
import subprocess

import rule_command

MOST_PARAMETERS = 5  # as readability-function-size in .clang-tidy
FOLDERS_WITH_README = ("lcmtypes", "pipeline", "drivers", "detector", "pose", "tools", "tests", "tools/studies")
TOP = {"CMakeLists.txt", "README.md", "lcmtypes", "pipeline", "drivers", "detector", "pose", "tools", "tests"}
COMMIT_HASH = re.compile(r"\b(?=[0-9a-f]*[0-9])(?=[0-9a-f]*[a-f])[0-9a-f]{7}\b")
UNFINISHED = re.compile(r"\b(TO" r"DO|FIX" r"ME|X" r"XX)\b")


def tracked_files(root):
    """Paths below `root`, relative: what git tracks, or every file where there is no git."""
    listed = subprocess.run(["git", "-C", str(root), "ls-files", "-z"], capture_output=True, text=True, check=False)
    if listed.returncode == 0 and listed.stdout:
        return sorted(name for name in listed.stdout.split("\0") if name and (root / name).is_file())
    return sorted(p.relative_to(root).as_posix() for p in root.rglob("*") if p.is_file())


def folder_faults(files):
    for folder in FOLDERS_WITH_README:
        if f"{folder}/README.md" not in files:
            yield f"{folder}: no README.md that says what is where"
    for name in sorted({f.split("/")[0] for f in files} - TOP):
        if not name.startswith("."):
            yield f"{name}: does not belong to the top level"


def text_faults(root, files):
    for name in files:
        suffix = pathlib.PurePosixPath(name).suffix
        if suffix not in {".md", ".cpp", ".hpp", ".py", ".java"}:
            continue
        text = (root / name).read_text()
        for number, line in enumerate(text.split("\n"), 1):
            if suffix == ".md" and COMMIT_HASH.search(line):
                yield f"{name}:{number}: a commit hash in prose: {COMMIT_HASH.search(line).group()}"
            if suffix != ".md" and UNFINISHED.search(line):
                yield f"{name}:{number}: unfinished: {line.strip()[:80]}"
            if name.startswith(("detector/", "pose/")) and "static thread_local" in line:
                yield f"{name}:{number}: scratch memory that no workspace owns"


def parameters(function):
    """Names, but for that of the object or class itself."""
    found = function.args
    named = [*found.posonlyargs, *found.args, *found.kwonlyargs, *filter(None, (found.vararg, found.kwarg))]
    return [one.arg for one in named if one.arg not in ("self", "cls")]


def python_faults(root, files):
    for name in (name for name in files if name.endswith(".py")):
        for node in ast.walk(ast.parse((root / name).read_text(), name)):
            if not isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
                continue
            count = len(parameters(node))
            if count > MOST_PARAMETERS:
                yield f"{name}:{node.lineno}: {node.name} takes {count} parameters, expected at most {MOST_PARAMETERS}"


def find_faults(root):
    files = tracked_files(root)
    return [*folder_faults(files), *text_faults(root, files), *python_faults(root, files)]


if __name__ == "__main__":
    rule_command.run(find_faults, "the house is in order")
