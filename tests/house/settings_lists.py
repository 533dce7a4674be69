"""Finds fields of settings that their list leaves out: what is not in the list is not checked, and takes any value.

Beside a settings struct stands `fields(settings, visit)` (pipeline/base/settings_fields.hpp). Each number in the struct has to be in it, and
each struct in it that has a list of its own. Switches, names, maps and functions have no range.

A list that is a loop names its members elsewhere (kQualityTerms), with an assertion of its own. ANY_VALUE names the numbers without a range.

Prints one line per fault; status 1 where there is any. Usage: settings_lists.py REPOSITORY
"""

import re

import rule_command
from named_fields import closing_of, code_of, fields_of, plain

TOP = ("pipeline", "drivers", "detector", "pose", "tools")
ANY_VALUE = {
    "FeatureSettings::families",  # a set of bits, of which check_settings(FeatureSettings) knows the names
    "AugmentationSettings::seed",
}
LIST = re.compile(r"void fields\(const ([\w:]+)&[^)]*\)\s*\{")
NUMBER = re.compile(r"(?:std::)?(?:float|double|int|unsigned|long|size_t|u?int(?:8|16|32|64)_t)$")


def read_headers(root):
    return {
        file.relative_to(root).as_posix(): code_of(file.read_text())
        for top in TOP for file in sorted((root / top).rglob("*.hpp"))
    }


def struct_body(code, name):
    found = re.search(r"\bstruct %s\s*\{" % re.escape(name), code)
    return code[found.end():closing_of(code, found.end() - 1)] if found else None


def lists_of(code):
    """{struct: names of the members in its list} of those that are no loop"""
    out = {}
    for found in LIST.finditer(code):
        body = code[found.end():closing_of(code, found.end() - 1)]
        if not re.search(r"\bfor\s*\(", body):
            out[found.group(1)] = set(re.findall(r"&\w+::(\w+)", body))
    return out


def find_faults(root):
    headers = read_headers(root)
    listed = {name for code in headers.values() for name in lists_of(code)}
    for file, code in headers.items():
        for name, members in lists_of(code).items():
            body = struct_body(code, name)
            for type_name, field in fields_of(name, body) or () if body else ():
                wanted = NUMBER.match(plain(type_name)) or plain(type_name).split("::")[-1] in listed
                if wanted and field not in members and f"{name}::{field}" not in ANY_VALUE:
                    yield f"{file}: {name}::{field} is in no list, and takes any value"


if __name__ == "__main__":
    rule_command.run(find_faults, "each number of the settings has a range")
