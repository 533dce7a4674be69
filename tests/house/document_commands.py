"""Finds commands in documents that no program understands: programs that are none, and options that their --help does not list.

Reads the indented lines and the spans between backticks of each Markdown file that begin with a program of ours (`hs-detect --forest F`). What
commands do is for other tests: the front page's run in tools/demo and, from packages, in tests/tools/install/bare_root_test.py.

Prints one line per fault; status 1 where there is any. Usage: document_commands.py REPOSITORY BIN (the folder that holds hs-detect)
"""

import pathlib
import re
import subprocess
import sys

COMMAND = re.compile(r"(?:[\w$./-]*/)?(hs-[a-z-]+)\s+(\S.*)")
SPAN = re.compile(r"`([^`\n]+)`")
OPTION = re.compile(r"(?<![\w-])--[a-z][a-z-]+")
WITH_SUBCOMMANDS = ("hs-teach", "hs-log", "hs-render", "hs-import", "hs-study")
WITH_JOBS = ("export",)  # subcommands that have subcommands
NO_HELP = ("hs-spy",)  # a script of Java's, whose options are lcm-spy's
MADE = ("out", "build")


def commands_in(text):
    """(line, program, the rest) of each command of ours."""
    for number, line in enumerate(text.split("\n"), 1):
        for command in [line] if line.startswith("    ") else SPAN.findall(line):
            for part in re.split(r"[|;&]", command.split("  #")[0]):
                found = COMMAND.match(part.strip())
                if found:
                    yield number, found.group(1), found.group(2)


def subcommand_of(program, rest):
    """Its words: "info", "export csv"; "" where there is none."""
    words = []
    for word in rest.split() if program in WITH_SUBCOMMANDS else []:
        if not re.match(r"[a-z][a-z-]*$", word) or (words and words[0] not in WITH_JOBS):
            break
        words.append(word)
    return " ".join(words[:2])


def find_faults(root, help_of):
    """`help_of(program, subcommand)` is what its --help prints; None where there is no such program."""
    for document in sorted(root.rglob("*.md")):
        name = document.relative_to(root)
        if name.parts[0].startswith(".") or name.parts[0] in MADE or name.name == "CHANGELOG.md":
            continue
        for number, program, rest in commands_in(document.read_text()):
            if program in NO_HELP:
                continue
            known = help_of(program, subcommand_of(program, rest))
            if known is None:
                yield f"{name}:{number}: {program} is no program"
                continue
            for option in sorted(set(OPTION.findall(rest)) - set(OPTION.findall(known))):
                yield f"{name}:{number}: {program} has no {option}"


class Programs:
    """The help of the programs in a folder, each asked once."""

    def __init__(self, folder):
        self.folder, self.said = folder, {}

    def help_of(self, program, subcommand):
        if (program, subcommand) not in self.said:
            self.said[program, subcommand] = self.ask(self.folder / program, subcommand)
        return self.said[program, subcommand]

    @staticmethod
    def ask(program, subcommand):
        if not program.is_file():
            return None
        words = [program, *subcommand.split(), "--help"]
        return subprocess.run(words, capture_output=True, text=True, check=False).stdout


def main():
    if len(sys.argv) != 3 or not pathlib.Path(sys.argv[2], "hs-detect").is_file():
        sys.exit("usage: document_commands.py REPOSITORY BIN (the folder that holds hs-detect)")
    faults = list(find_faults(pathlib.Path(sys.argv[1]), Programs(pathlib.Path(sys.argv[2])).help_of))
    print("\n".join(faults) if faults else "the commands of documents are understood")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
