"""Finds classes, structs and enums that are defined twice in one namespace: linked into one program, two of them become one.

Reads pipeline, drivers, detector, pose and tools, header and source files alike. Names in anonymous namespaces and in
functions are their file's own; nested ones count with the class around them. It is no compiler: it counts braces and
looks at what stands before each, so it does not expand macros, takes both sides of an #if, and passes over
specialisations of templates.

Prints one line per fault and exits with 1 when there is any. Usage: unique_names.py REPOSITORY
"""

import collections
import re

import rule_command

FOLDERS = ("pipeline", "drivers", "detector", "pose", "tools")
# Comments, raw strings, strings, characters (not the ' within a number), preprocessor lines with their continuations.
NOT_CODE = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<!\w)\'(?:\\.|[^\'\\\n])+\'|^[ \t]*#(?:\\\n|[^\n])*',
    re.DOTALL | re.MULTILINE)
NAMESPACE = re.compile(r"^(?:inline\s+)?namespace(?:\s+([\w:]+))?$")
TYPE = re.compile(r"^(?:template\s*<.*>\s*)?(?:class|struct|union|enum(?:\s+(?:class|struct))?)\s+"
                  r"(?:(?:alignas\([^)]*\)|\[\[.*?\]\])\s*)*([\w:]+)(?:\s+final)?\s*(?::[^()=]*)?$", re.DOTALL)


def defined_types(text):
    """Qualified names of the types that a source text defines outside anonymous namespaces and functions."""
    names = []
    scopes = []  # a qualified part, or None where what is within is nobody else's
    head = []
    for word in re.split(r"([{};])", NOT_CODE.sub(" ", text)):
        if word == "{":
            before = re.sub(r"^(?:(?:public|private|protected)\s*:\s*)+", "", "".join(head).strip())
            namespace, type_name = NAMESPACE.match(before), TYPE.match(before)
            if namespace:
                scopes.append(namespace.group(1))
            elif type_name:
                scopes.append(type_name.group(1))
                if None not in scopes:
                    names.append("::".join(scopes))
            else:
                scopes.append(None)
        elif word == "}" and scopes:
            scopes.pop()
        if word in {"{", "}", ";"}:
            head = []
        else:
            head.append(word)
    return names


def find_faults(root):
    places = collections.defaultdict(list)
    for folder in FOLDERS:
        for file in sorted((root / folder).rglob("*")):
            if file.suffix in {".cpp", ".hpp"}:
                for name in defined_types(file.read_text()):
                    places[name].append(file.relative_to(root).as_posix())
    return [f"{name} is defined in {' and in '.join(files)}" for name, files in sorted(places.items()) if len(files) > 1]


if __name__ == "__main__":
    rule_command.run(find_faults, "no name is defined twice in a namespace")
