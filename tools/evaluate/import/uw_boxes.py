"""Prints the boxes of a video of the UW RGB-D Scenes Dataset as boxes.json has those of its frames.

Lai, Bo, Ren, Fox, ICRA 2011; the first version, not v2. Of SCENE_K.mat it relies on what published readers of it rely on: a cell
array `bboxes` with one cell for each frame in order, each empty or a struct array with `category` (text), `instance` (number),
`top`, `bottom`, `left` and `right` (pixels of the box, first and last one included; MATLAB counts them from 1). An edge one pixel
outside the image is taken as its border. What is missing, damaged or absurd ends it with one line; of some damage scipy itself
dies or never ends, which is why this is a process of its own with limits.

Usage: uw_boxes.py SCENE_K.mat WIDTH HEIGHT
"""

import json
import math
import pathlib
import resource
import sys
import warnings

MAX_BYTES = 16 << 20
# A damaged file may state any sizes.
MAX_MEMORY = 4 << 30
MAX_SECONDS = 20
FIRST_TO_LAST = ("top", "bottom", "left", "right")


class Refused(Exception):
    """One line that names the file, the value and what was expected."""


def require(good, line):
    if not good:
        raise Refused(line)


def kind_of(array):
    if array.dtype.names is not None:
        return "structs"
    return {"O": "cells", "U": "text"}.get(array.dtype.kind, "numbers" if array.dtype.kind in "biuf" else "something else")


def read_cells(file):
    """The cells of `bboxes`, frame by frame."""
    require(file.is_file(), f"{file}: missing, expected a MATLAB file")
    require(file.stat().st_size <= MAX_BYTES, f"{file}: {file.stat().st_size} bytes, expected at most {MAX_BYTES}")
    header = file.read_bytes()[:128]
    order = header[126:]
    require(order in (b"IM", b"MI"), f"{file}: no MATLAB file, expected the header of version 5")
    version = header[125 if order == b"IM" else 124]
    require(version == 1, f"{file}: MATLAB file version {version}, expected 1 (-v5, -v6 or -v7, not -v7.3)")
    import scipy.io  # where it is missing, that is a refusal too
    resource.setrlimit(resource.RLIMIT_AS, (MAX_MEMORY, MAX_MEMORY))
    resource.setrlimit(resource.RLIMIT_CPU, (MAX_SECONDS, MAX_SECONDS))
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # of a variable that is left out, or there twice
        variables = scipy.io.loadmat(file, variable_names=["bboxes"])
    require("bboxes" in variables, f"{file}: no variable 'bboxes'")
    cells = variables["bboxes"]
    require(kind_of(cells) == "cells" and cells.size > 0,
            f"{file} 'bboxes': {cells.size} {kind_of(cells)}, expected one cell for each frame")
    return list(cells.ravel(order="F"))


def field(box, name, where):
    require(name in box.dtype.names, f"{where}: no field '{name}'")
    return box[name]


def number(box, name, where):
    values = field(box, name, where)
    require(kind_of(values) == "numbers", f"{where} field '{name}': {kind_of(values)}, expected a number")
    require(values.size == 1, f"{where} field '{name}': {values.size} numbers, expected one")
    value = float(values.item())
    require(math.isfinite(value), f"{where} field '{name}': {value}, expected a finite number")
    return value


def instance_name(box, where):
    texts = field(box, "category", where)
    require(kind_of(texts) == "text" and texts.size == 1,
            f"{where} field 'category': {kind_of(texts)} of length {texts.size}, expected text")
    category = str(texts.item())
    require(category and all(" " <= letter <= "~" for letter in category),
            f"{where} field 'category': {category!a}, expected printable ASCII characters")
    instance = number(box, "instance", where)
    require(1 <= instance <= 10000 and instance == int(instance),
            f"{where} field 'instance': {instance:g}, expected a whole number from 1 to 10000")
    return f"{category}_{int(instance)}"


def pixel(edge):
    """Rounded with halves away from zero, and counted from 0."""
    whole = math.floor(edge)
    return whole - 1 + (edge - whole >= 0.5)


def object_of(box, size, where):
    width, height = size
    name = instance_name(box, where)
    top, bottom, left, right = (number(box, edge, where) for edge in FIRST_TO_LAST)
    require(0 <= left <= right <= width + 1 and 0 <= top <= bottom <= height + 1,
            f"{where}: box from left {left:g} top {top:g} to right {right:g} bottom {bottom:g}, "
            f"expected ordered and inside 1,1 to {width},{height}")
    corners = [max(pixel(left), 0), max(pixel(top), 0), min(pixel(right) + 1, width), min(pixel(bottom) + 1, height)]
    require(corners[0] < corners[2] and corners[1] < corners[3],
            f"{where}: box at left {left:g} top {top:g} lies outside the {width}x{height} image")
    return {"object": name, "bbox_xyxy": corners}


def objects_of(cell, size, where):
    if cell.size == 0:
        return []
    require(kind_of(cell) == "structs", f"{where}: {kind_of(cell)}, expected structs")
    require(cell.size <= 1000, f"{where}: {cell.size} boxes, expected at most 1000")
    return [object_of(box, size, f"{where} box {number}") for number, box in enumerate(cell.ravel(order="F"), 1)]


def frames_of(file, size):
    """The frames of a video as boxes.json has them."""
    try:
        return [{"frame": f"{file.stem}_{frame}", "objects": objects_of(cell, size, f"{file} 'bboxes' frame {frame}")}
                for frame, cell in enumerate(read_cells(file), 1)]
    except ImportError as error:
        raise Refused(f"{file}: {error}, expected Debian's python3-scipy to read it with") from error
    except Refused:
        raise
    except Exception as error:  # whatever the parsers of scipy trip over
        reason = " ".join(str(error).split()) or type(error).__name__
        raise Refused(f"{file}: cannot be read ({reason}), expected a whole MATLAB file") from error


def main():
    file, width, height = sys.argv[1:]
    try:
        print(json.dumps(frames_of(pathlib.Path(file), (int(width), int(height)))))
    except Refused as refusal:
        sys.exit(str(refusal))


if __name__ == "__main__":
    main()
