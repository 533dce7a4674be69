"""The units of tools/bench household: rooms, groups that are taught, stores that are joined of them, and what is measured of
each store in the same rooms."""

import dataclasses
import json

from studies.bop.dataset import folder_digest
from studies.records import threads
from studies.unit_runner import Store, Units, make, sha256_of_file

MOST = 7  # objects of a group, as hs-teach divides them
NEAR = 0.1  # a store of given ones stands for a number of objects from which it differs by no larger part
TIMED_ROOMS = 2
TEACH_S = 45.0  # expected for an object


@dataclasses.dataclass(frozen=True)
class Group:
    """Objects that are taught together: a unit's output, or a store that was taught before."""

    key: str
    store: str  # its folder; "{UNIT}/store" where a unit makes it
    names: tuple
    of: str = ""  # digest of a store that was taught before


def ranges_of(numbers):
    """{number: [(first, last), ...]}: the groups of a store of so many objects, by places from 0, `last` excluded. A store of
    at most MOST is a group by itself; a larger one holds the largest of these and goes on from the next smaller store."""
    out, chain = {}, []
    for number in numbers:
        if number <= MOST:
            chain = [(0, number)]
        else:
            begin = chain[-1][1] if chain else 0
            parts = -(-(number - begin) // MOST)
            ends = [begin + (number - begin) * part // parts for part in range(parts + 1)]
            chain = chain + list(zip(ends, ends[1:]))
        out[number] = chain
    return out


def prefixes_of(sizes, numbers):
    """{number: how many of the stores, from the first, hold about so many objects together}, without those that none do."""
    out = {}
    for number in numbers:
        apart = {count: abs(sum(sizes[:count]) - number) for count in range(1, len(sizes) + 1)}
        best = min(apart, key=apart.get)
        if apart[best] <= NEAR * number:
            out[number] = best
    return out


class Plan:
    def __init__(self, options):
        self.options, self.units = options, Units()
        self.teach = options.programs / "hs-teach"
        self.digests = {}  # of programs that modules run, and of the meshes
        self.scenes = [f"{{scenes}}/{room:06}" for room in range(1, options.rooms + 1)]
        self.groups = {}  # by key
        self.numbers = {}  # {number: the groups of its store}

    def digest(self, program):
        if program not in self.digests:
            self.digests[program] = sha256_of_file(self.options.programs / program)
        return self.digests[program]

    def of_meshes(self):
        if "meshes" not in self.digests:
            self.digests["meshes"] = folder_digest(self.options.models)
        return self.digests["meshes"]

    def add_scenes(self):
        options = self.options
        least, most = options.in_a_room
        self.units.add("scenes", "", "hs-study", "household", "--models", options.models, "--ids",
                       ",".join(map(str, options.placed)), "--rooms", options.rooms, "--frames", options.frames,
                       "--min-objects", least, "--max-objects", most, "--seed", options.seed, "--threads", threads(), "--out",
                       "{out}", of=self.of_meshes(), expected_s=10.0 * options.rooms)  # fmt: skip

    def add_run(self, name, program, words, before=None, **facts):
        """A unit that measures what a program takes. `before`: the store of which it works on a copy, which is gone then."""
        copy = ("--before", before, "--drop") if before else ()
        facts["of"] = facts.get("of", "") + self.digest(program)
        return self.units.add(name, "", "studies.household.measured_run", "--program", self.options.programs / program,
                              "--out", "{out}", *copy, "--", *words, **facts)  # fmt: skip

    def mesh_words(self, ids):
        practice = self.options.practice_rooms
        return ("mesh", self.options.models, "--ids", ",".join(map(str, ids)), "--out", "{out}/store", "--seed",
                self.options.seed, "--threads", threads(),
                *(("--practice-rooms", practice) if practice else ()))  # fmt: skip

    def taught_group(self, first, last):
        """A group of the objects from place `first` on, before `last`."""
        key = f"{first + 1}_to_{last}"
        if key not in self.groups:
            ids = self.options.taught[first:last]
            unit = self.add_run(f"taught/{key}", "hs-teach", self.mesh_words(ids), of=self.of_meshes(),
                                expected_s=TEACH_S * len(ids))  # fmt: skip
            names = tuple(self.options.names[one] for one in ids)
            self.groups[key] = Group(key, f"{{{unit}}}/store", names)
        return self.groups[key]

    def given_groups(self):
        for place, (folder, known) in enumerate(self.options.stores, 1):
            key = f"{place}_{folder.name}"
            self.groups[key] = Group(key, str(folder), tuple(known.values()), folder_digest(folder))
        return list(self.groups.values())

    def choose(self):
        """The groups of each number's store."""
        numbers = self.options.numbers
        if self.options.stores:
            groups = self.given_groups()
            counts = prefixes_of([len(group.names) for group in groups], numbers)
            self.numbers = {number: groups[:count] for number, count in counts.items()}
            used = max(counts.values(), default=0)
            self.groups = {group.key: group for group in groups[:used]}
        else:
            self.numbers = {number: [self.taught_group(*place) for place in places]
                            for number, places in ranges_of(numbers).items()}  # fmt: skip

    def store_of(self, number):
        """(folder, digest) of the store of that number, which is joined where it has several groups. The folder may lie in a
        unit's output, as words say it."""
        groups = self.numbers[number]
        known = json.dumps([group.of for group in groups])
        if len(groups) == 1:
            return groups[0].store, known
        names = {name for group in groups for name in group.names}
        for folder, there in self.options.joined:
            if set(there.values()) == names:
                return str(folder), folder_digest(folder)
        unit = self.add_run(f"joined/{number}", "hs-teach", ("merge", *(group.store for group in groups), "--out",
                            "{out}/store"), of=known)  # fmt: skip
        return f"{{{unit}}}/store", known

    def add_found(self, name, store, known):
        scenes = [word for scene in self.scenes for word in ("--scene", scene)]
        return self.units.add(f"found/{name}", "", "hs-evaluate", "--objects", store, *scenes, "--threads", threads(), "--out",
                              "{out}", of=known)  # fmt: skip

    def add_measures(self, number):
        store, known = self.store_of(number)
        if len(self.numbers[number]) > 1:
            self.add_found(number, store, known)
        search = ("--objects", store, "--threads", threads(), "--output-log", "{out}/log")
        self.add_run(f"detected/{number}", "hs-detect", (*search, "--keep-frames", "-l", "file://{frames.lcmlog}"), of=known)
        self.add_run(f"posed/{number}", "hs-pose", (*search, "--cache", "{out}/cache", "-l",
                     f"file://{{detected/{number}}}/log"), of=known)  # fmt: skip
        if self.options.add and self.options.strangers:
            words = (*self.mesh_words(self.options.strangers[:1]), "--add")
            self.add_run(f"added/{number}", "hs-teach", words, store, of=known + self.of_meshes(), expected_s=2 * TEACH_S)

    def add_times(self):
        """All stores look at the same frames in turn, in one unit: what ran in two would not be compared."""
        stores = {number: self.store_of(number) for number in self.numbers}
        named = [word for number, (store, _) in stores.items() for word in ("--store", f"{number}={store}")]
        scenes = [word for scene in self.scenes[:TIMED_ROOMS] for word in ("--scene", scene)]
        of = json.dumps([known for _, known in stores.values()]) + self.digest("hs-evaluate")
        self.units.add("times.json", "", "studies.household.rounds", "--program", self.options.programs / "hs-evaluate",
                       "--out", "{out}", "--rounds", self.options.rounds, *named, "--", *scenes, "--threads", threads(),
                       of=of)  # fmt: skip

    def run(self):
        """Makes all, and returns the cache that holds it."""
        self.add_scenes()
        self.choose()
        if not self.options.scenes_only:
            self.units.add("frames.lcmlog", "", "hs-capture", "--source", f"bop:{self.scenes[0]}", "--log", "{out}")
            for group in self.groups.values():
                self.add_found(group.key, group.store, group.of)
            for number in self.numbers:
                self.add_measures(number)
            if self.numbers:
                self.add_times()
        wanted = self.units.all()
        if self.options.scenes_only:
            wanted = [unit for unit in wanted if unit.name == "scenes"]
        store = Store(self.options.out, self.options.programs, wanted, files="data")
        make(store, self.options.fresh)
        return store
