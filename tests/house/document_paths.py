"""Finds paths in documents where nothing lies: a README that names a file which has moved sends its reader into the void.

In each Markdown file, what stands between backticks or in the brackets of a link and begins with a folder that exists, beside the document
or at the top, is a path: a file, with or without its ending, or a folder. Words with capitals (NAME.ply), wildcards and options are none.
What stands below out/ or build/ is made.

Prints one line per fault; status 1 where there is any. Usage: document_paths.py REPOSITORY
"""

import pathlib
import re

import rule_command

SPAN = re.compile(r"`([^`\n]+)`|\]\(([^)#\s]+)[^)]*\)")
PATH = re.compile(r"[\w.-]+(?:/[\w.-]+)*/?$")
MADE = ("out", "build")
ENDINGS = ("", ".hpp", ".cpp", ".py", ".md", ".lcm", ".txt")


def lies(place):
    return any(pathlib.Path(f"{place}{ending}").exists() for ending in ENDINGS)


def begins(folder, first):
    return (folder / first).is_dir() and first not in MADE


def paths_in(text):
    """(line, path) of what a document names."""
    for number, line in enumerate(text.split("\n"), 1):
        for span, link in SPAN.findall(line):
            name = link or span
            if "://" in name or (not link and "/" not in name) or re.search(r"[A-Z]{3}", name.split("/")[0]) or not PATH.match(name):
                continue
            yield number, name.rstrip("/")


def find_faults(root):
    for document in sorted(root.rglob("*.md")):
        parts = document.relative_to(root).parts
        if parts[0].startswith(".") or parts[0] in MADE:
            continue
        for number, name in paths_in(document.read_text()):
            first = name.split("/")[0]
            bases = [base for base in (document.parent, root) if first in (".", "..") or begins(base, first)]
            if re.search(r"(^|/)[A-Z_]{3,}(\.|$)", name) and not any(lies(base / name) for base in bases):
                continue  # NAME.ply stands for any name
            if bases and not any(lies(base / name) for base in bases):
                yield f"{document.relative_to(root)}:{number}: names {name}, where nothing lies"


if __name__ == "__main__":
    rule_command.run(find_faults, "what documents name lies where they say")
