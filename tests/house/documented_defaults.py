"""Compares the numbers that documents state with the defaults of the code.

Each row names a document, a pattern in it and a source, a pattern in it; both patterns hold one number. Words that have changed so that a
pattern is not found are a fault too. Prints one line per fault; status 1 where there is any. Usage: documented_defaults.py REPOSITORY
"""

import re

import rule_command

QUALITY = "pose/verification/quality.hpp"
STORED = "tools/finder/stored_quality.hpp"
REGION = "pose/following/region_modality.hpp"
TEXTURE = "pose/following/texture_modality.hpp"
SCHEDULE = "detector/group_schedule.hpp"
ROWS = (
    ("detector/README.md", r"it takes to search each within ([\d.]+) s", SCHEDULE, r"double interval_s = ([\d.]+);"),
    ("tools/teach/README.md", r"found for a second are searched every ([\d.]+) s", SCHEDULE, r"double interval_s = ([\d.]+);"),
    ("pose/README.md", r"A pose is published from quality ([\d.]+) on", QUALITY, r"float min_quality = ([\d.]+)F"),
    ("pose/README.md", r"learnt per object: ([\d.]+)\)", STORED, r"kStoreQuality = ([\d.]+)F"),
    ("pose/README.md", r"so a pose of quality ([\d.]+) \(", QUALITY, r"float min_candidate_quality = ([\d.]+)F"),
    ("pose/README.md", r"of a store's\s+objects ([\d.]+), as most", STORED, r"kStoreCandidateQuality = ([\d.]+)F"),
    ("pose/README.md", r"not seen \(([\d.]+) is in use", QUALITY, r"float min_quality = ([\d.]+)F"),
    ("pose/README.md", r"([\d.]+) of 255 levels of brightness", TEXTURE, r"double sigma = ([\d.]+);"),
    ("pose/README.md", r"`common_error_px`, ([\d.]+) pixels", REGION, r"double common_error_px = ([\d.]+);"),
    ("tools/studies/README.md", r"from its limit of ([\d.]+) on", QUALITY, r"float min_quality = ([\d.]+)F"),
)


def number_in(root, name, pattern):
    """The number that the pattern finds in a file; None where it finds none."""
    found = re.search(pattern, (root / name).read_text())
    return float(found.group(1)) if found else None


def find_faults(root, rows=ROWS):
    for document, words, source, code in rows:
        said, meant = number_in(root, document, words), number_in(root, source, code)
        if said is None:
            yield f"{document}: no words like '{words}', expected the default of {source}"
        elif meant is None:
            yield f"{source}: no default like '{code}', expected the one that {document} states"
        elif said != meant:
            yield f"{document}: says {said:g}, but {source} has {meant:g}"


if __name__ == "__main__":
    rule_command.run(find_faults, "documents state the code's defaults")
