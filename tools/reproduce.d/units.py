"""A unit of work as plain data, and the collector that keeps each once."""

import dataclasses
import re

INPUT = re.compile(r"\{([^{}]+)\}")


@dataclasses.dataclass(frozen=True)
class Unit:
    """One command and what it makes. In the command "{out}" is what it writes, "{NAME}" what unit NAME has written."""

    name: str  # also the path of what it makes, below the folder of all such files
    command: tuple  # first the executable's name
    figures: tuple  # of the paper, or parts of the report
    what: str = ""  # detector, in the words of the report
    scene: str = ""
    seed: int = 0  # 0: the same for all

    @property
    def kind(self):
        return self.name.split("/")[0].split("_every_")[0]

    @property
    def inputs(self):
        names = [name for word in self.command for name in INPUT.findall(word)]
        return tuple(dict.fromkeys(name for name in names if name != "out"))


class Units:
    """Units in the order in which they can run. Two figures may ask for the same one."""

    def __init__(self):
        self.by_name = {}

    def add(self, name, figure, *command, **facts):
        """Returns the name."""
        unit = Unit(name, tuple(str(word) for word in command), (figure,), **facts)
        known = self.by_name.get(name)
        if known:
            if known.command != unit.command:
                raise ValueError(f"two units are called {name}: {known.command}, {unit.command}")
            unit = dataclasses.replace(known, figures=tuple(dict.fromkeys(known.figures + unit.figures)))
        self.by_name[name] = unit
        return name

    def all(self):
        return list(self.by_name.values())


def with_inputs(units, chosen):
    """The chosen ones and all that they need, in order."""
    by_name = {unit.name: unit for unit in units}
    needed = set()
    waiting = [unit.name for unit in chosen]
    while waiting:
        name = waiting.pop()
        if name not in needed:
            needed.add(name)
            waiting.extend(by_name[name].inputs)
    return [unit for unit in units if unit.name in needed]
