"""Keeps the rules of the house that counting cannot satisfy: the order of folders and of files, one owner for an idea, headers that are for others.

    rules.py REPOSITORY            prints one line per new fault, and per known one that is no fault any more; status 1 where there is any
    rules.py REPOSITORY --known    prints every fault of today, as known.txt holds them

1. Folders have an order. A README's line `order: a < b < { c, d } < .` names folders below it, `.` being the files that lie beside the
   README; a folder may include those to its left. Those in braces may not include one another. A folder that is not named belongs to
   the nearest folder above it that is; what stands in no order is a fault. No folders include one another in a circle, at any depth.
2. Files have an order. A unit is a header with its source; no unit includes itself by way of others.
3. An idea has one owner: owners.txt names a pattern of text and the places where it may stand.
4. A header is for others: one that only its own source and tests include belongs into the source, one that only tests include to tests/.

What broke a rule when the rules came stands in known.txt, which only shrinks.
"""

import pathlib
import re
import sys

import rule_command

TOP = ("pipeline", "drivers", "detector", "pose", "tools")
ORDER = re.compile(r"^`?order: (.*?)`?$", re.MULTILINE)
INCLUDE = re.compile(r'^\s*#\s*include\s*"([^">]+)"', re.MULTILINE)
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
HOUSE = pathlib.PurePosixPath("tests/house")


def read_sources(root):
    """{path: text} of the C++ files, paths relative to the repository."""
    return {
        file.relative_to(root).as_posix(): file.read_text()
        for folder in (*TOP, "tests")
        for file in sorted((root / folder).rglob("*"))
        if file.suffix in {".cpp", ".hpp"}
    }


def includes_of(sources):
    """{path: [paths of ours that it includes]}"""
    return {name: [found for found in INCLUDE.findall(text) if found in sources] for name, text in sources.items()}


def parse_order(text):
    """[[names that stand side by side], ...] from left to right."""
    return [[name.strip() for name in group.strip(" {}").split(",")] for group in text.split("<")]


def read_orders(root):
    """{folder: parsed order} of every README below the top folders that states one."""
    orders = {}
    for top in TOP:
        for readme in sorted((root / top).rglob("README.md")):
            found = ORDER.search(readme.read_text())
            if found:
                orders[readme.parent.relative_to(root).as_posix()] = parse_order(found.group(1))
    return orders


def place_in(order, folder, file):
    """(rank, name) of the part of `folder` to which the file belongs; None where the order does not name it."""
    parent = pathlib.PurePosixPath(file).parent.relative_to(folder).as_posix()
    ranks = {name: rank for rank, names in enumerate(order) for name in names}
    while parent != "." and parent not in ranks:
        parent = pathlib.PurePosixPath(parent).parent.as_posix()
        if parent == ".":
            return None
    return (ranks[parent], parent) if parent in ranks else None


def includes_against_order(orders, includes):
    """(file, what it includes, folder of the README, name of the file's part, name of the other's part)"""
    for folder, order in orders.items():
        inside = f"{folder}/"
        for file, included in includes.items():
            here = place_in(order, folder, file) if file.startswith(inside) else None
            for target in (name for name in included if here and name.startswith(inside)):
                there = place_in(order, folder, target)
                if there and there[1] != here[1] and there[0] >= here[0]:
                    yield file, target, folder, here[1], there[1]


def order_faults(root, includes):
    orders = read_orders(root)
    for folder, order in orders.items():
        for file in includes:
            if file.startswith(f"{folder}/") and place_in(order, folder, file) is None:
                yield f"order: {file} lies in no folder that {folder}/README.md names"
    for file, target, folder, here, there in includes_against_order(orders, includes):
        yield f"order: {file} includes {target}, but {folder}/README.md has {here} not right of {there}"
    for top in TOP:
        if top not in orders and any(file.startswith(f"{top}/") for file in includes):
            yield f"order: {top}/README.md states none"


def unit_of(file):
    return file.rsplit(".", 1)[0]


def circles(edges):
    """The sets of more than one unit that reach one another (Tarjan 1972, without recursion)."""
    index, low, stack, on_stack, found = {}, {}, [], set(), []
    for start in edges:
        if start in index:
            continue
        work = [(start, iter(edges[start]))]
        index[start] = low[start] = len(index)
        stack.append(start)
        on_stack.add(start)
        while work:
            node, targets = work[-1]
            for target in targets:
                if target not in index:
                    index[target] = low[target] = len(index)
                    stack.append(target)
                    on_stack.add(target)
                    work.append((target, iter(edges.get(target, ()))))
                    break
                if target in on_stack:
                    low[node] = min(low[node], index[target])
            else:
                work.pop()
                if work:
                    low[work[-1][0]] = min(low[work[-1][0]], low[node])
                if low[node] == index[node]:
                    members = set()
                    while node not in members:
                        members.add(stack[-1])
                        on_stack.discard(stack.pop())
                    if len(members) > 1:
                        found.append(sorted(members))
    return found


def folder_of(file):
    return pathlib.PurePosixPath(file).parent.as_posix()


def circles_among(part_of, includes):
    edges = {}
    for file, included in includes.items():
        edges.setdefault(part_of(file), set()).update(part_of(name) for name in included)
    return circles({part: sorted(targets - {part}) for part, targets in sorted(edges.items())})


def circle_faults(root, includes):
    """Yields the circles of units, and of folders, each with its own files alone. Of folders, the includes that their order
    forbids are left out: they are faults of their own."""
    for members in circles_among(unit_of, includes):
        yield f"circle: {', '.join(members)}"
    forbidden = {(file, target) for file, target, _, _, _ in includes_against_order(read_orders(root), includes)}
    allowed = {file: [name for name in included if (file, name) not in forbidden] for file, included in includes.items()}
    for members in circles_among(folder_of, allowed):
        yield f"circle of folders: {', '.join(members)}"


def header_faults(root, includes):
    listed = root / ".cmake/public_headers.txt"
    public = set(re.findall(r"\S+\.hpp", listed.read_text())) if listed.is_file() else set()
    users = {file: set() for file in includes if file.endswith(".hpp") and file.startswith(TOP)}
    for file, included in includes.items():
        for name in included:
            if name in users and unit_of(name) != unit_of(file):
                users[name].add(file)
    for header, by in sorted(users.items()):
        if header in public or any(not user.startswith("tests/") for user in by):
            continue
        yield f"header: {header} is {'for tests alone' if by else 'for nobody'}"


def read_owners(root):
    """[(idea, pattern, [places])] of owners.txt, whose lines are IDEA | PATTERN | PLACE, PLACE."""
    file = root / HOUSE / "owners.txt"
    lines = file.read_text().splitlines() if file.is_file() else []
    rows = [[part.strip() for part in line.split(" | ")] for line in lines if line.strip() and not line.startswith("#")]
    for row in rows:
        if len(row) != 3:
            raise ValueError(f"{file}: '{' | '.join(row)}', expected IDEA | PATTERN | PLACE, PLACE")
    return [(idea, re.compile(pattern), [place.strip() for place in places.split(",")]) for idea, pattern, places in rows]


def owner_faults(root, sources):
    for idea, pattern, places in read_owners(root):
        for file, text in sources.items():
            if not file.startswith((*places, "tests/")) and pattern.search(COMMENT.sub(" ", text)):
                yield f"owner: {file} holds {idea}, which belongs to {', '.join(places)}"


def find_faults(root):
    sources = read_sources(root)
    includes = includes_of(sources)
    return [
        *order_faults(root, includes),
        *circle_faults(root, includes),
        *header_faults(root, includes),
        *owner_faults(root, sources),
    ]


def news(root):
    """Returns the differences from known.txt, one line each."""
    file = root / HOUSE / "known.txt"
    known = set(filter(None, file.read_text().splitlines())) if file.is_file() else set()
    found = set(find_faults(root))
    return [*sorted(found - known), *(f"{HOUSE}/known.txt: no fault any more, take it out: {line}" for line in sorted(known - found))]


if __name__ == "__main__":
    if sys.argv[2:] == ["--known"]:
        sys.argv.pop()
        rule_command.run(lambda root: sorted(set(find_faults(root))), "")
    rule_command.run(news, "the rules of the house hold, but for what known.txt names")
