"""Finds includes that point the wrong way: lcmtypes < pipeline < {drivers, detector, pose} < tools < tests.

Prints one line per fault and exits with 1 when there is any. Usage: include_direction.py REPOSITORY
"""

import re

import rule_command

ALLOWED = {
    "lcmtypes": {"lcmtypes"},
    "pipeline": {"lcmtypes", "pipeline"},
    "drivers": {"lcmtypes", "pipeline", "drivers"},
    "detector": {"lcmtypes", "pipeline", "detector"},
    "pose": {"lcmtypes", "pipeline", "pose"},
    "tools": {"lcmtypes", "pipeline", "drivers", "detector", "pose", "tools"},
    "tests": {"lcmtypes", "pipeline", "drivers", "detector", "pose", "tools", "tests"},
}
LCM = re.compile(r"^(lcm/|houghstream/)")
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)


def read_includes(root):
    """{path of a source file: [what it includes]}, paths relative to the repository."""
    files = {}
    for folder in ALLOWED:
        for file in sorted((root / folder).rglob("*")):
            if file.suffix in {".cpp", ".hpp", ".c", ".h"}:
                files[file.relative_to(root).as_posix()] = INCLUDE.findall(file.read_text())
    return files


def sources_without_lcm(root, files):
    """Files of the libraries that must not know LCM: the stages, and what the CMake target `pipeline` compiles."""
    rules = root / "pipeline" / "CMakeLists.txt"
    target = re.search(r"houghstream_library\(pipeline\s(.*?)\)", rules.read_text(), re.DOTALL)
    compiled = {f"pipeline/{name}" for name in re.findall(r"[\w/]+\.cpp", target.group(1))} if target else set()
    return [f for f in files if f.startswith(("drivers/", "detector/", "pose/")) or f in compiled]


def path_to_lcm(file, files, visited):
    """The chain of includes by which `file` sees LCM, or an empty list."""
    visited.add(file)
    for included in files.get(file, []):
        if LCM.match(included):
            return [file, included]
        if included in files and included not in visited:
            chain = path_to_lcm(included, files, visited)
            if chain:
                return [file, *chain]
    return []


def find_faults(root):
    files = read_includes(root)
    faults = []
    for file, includes in files.items():
        folder = file.split("/")[0]
        for included in includes:
            target = included.split("/")[0]
            if target in ALLOWED and target not in ALLOWED[folder]:
                faults.append(f"{file}: {folder} may not include {included}")
    for file in sources_without_lcm(root, files):
        chain = path_to_lcm(file, files, set())
        if chain:
            faults.append(f"{file}: sees LCM: {' -> '.join(chain)}")
    return faults


if __name__ == "__main__":
    rule_command.run(find_faults, "all includes point the right way")
