"""Finds state that nobody hands in: variables of a namespace or of a class, and static ones of functions, that are not constant. A global
that another library sets changes what a function does behind its caller's back; who wants another way hands it in as an argument.

Reads the C++ files of pipeline, drivers, detector, pose and tools, but for tools/studies. It is no compiler: it counts braces and looks at
what stands before each. ALLOWED names the few that a process has by its nature, each with its reason.

Prints one line per fault; status 1 where there is any. Usage: global_state.py REPOSITORY
"""

import pathlib
import re

import rule_command
from named_fields import closing_of, code_of

TOP = ("pipeline", "drivers", "detector", "pose", "tools")
ALLOWED = {
    "pipeline/base/stop_signal.cpp": "a signal handler has no arguments",
    "pipeline/base/parallel.cpp": "the process' idle threads",
    "drivers/openni/persistent_thread.cpp": "OpenNI2 is one a process, and its thread outlives every source",
}
NAMESPACE = re.compile(r"(?:inline\s+)?namespace(?:\s+[\w:]+)?$")
CONSTANT = re.compile(r"\b(?:const|constexpr)\b")
NO_VARIABLE = re.compile(r"(?:using|typedef|template|class|struct|enum|union|static_assert|friend|extern|namespace|HWY_\w+)\b")
BODY = re.compile(r"\)\s*(?:const|noexcept|override|->[\w:<>&*\s]+|:[^;]*)*\{\}$")
STATIC = re.compile(r"^[ \t]+(?:inline\s+)?static\s+(?:thread_local\s+)?(?!constexpr\b|const\b|_)([^;(){}=]*?)(\w+)\s*([={;])", re.MULTILINE)


def without_template_arguments(text):
    shorter = re.sub(r"<[^<>]*>", "", text)
    return shorter if shorter == text else without_template_arguments(shorter)


def namespace_variables(code):
    """(place, text) of the variables that a namespace holds and that are not constant."""
    place, part = 0, ""
    while place < len(code):
        letter = code[place]
        if letter == "{" and NAMESPACE.match(part.strip()):
            part = ""
        elif letter == "{":
            place = closing_of(code, place)
            part += "{}"
            if BODY.search(part.strip()):
                part = ""
        elif letter == "}":
            part = ""
        elif letter == ";":
            text = re.sub(r"\s+", " ", part).strip()
            declared = without_template_arguments(re.split(r"[={]", text)[0])
            if text and not NO_VARIABLE.match(text) and not CONSTANT.search(text) and "(" not in declared:
                yield place, text
            part = ""
        else:
            part += letter
        place += 1


def faults_of(code):
    yield from namespace_variables(code)
    for found in STATIC.finditer(code):
        if found.group(1).strip() and not CONSTANT.search(found.group(1)):
            yield found.start(), re.sub(r"\s+", " ", found.group(1) + found.group(2)).strip()


def find_faults(root):
    for top in TOP:
        for file in sorted((root / top).rglob("*")):
            name = file.relative_to(root).as_posix()
            if file.suffix not in {".cpp", ".hpp"} or name in ALLOWED or name.startswith("tools/studies/"):
                continue
            code = code_of(file.read_text())
            for place, text in faults_of(code):
                yield f"{name}:{code.count(chr(10), 0, place) + 1}: state that nobody hands in: {text}"


if __name__ == "__main__":
    rule_command.run(lambda root: find_faults(pathlib.Path(root)), "no state that nobody hands in")
