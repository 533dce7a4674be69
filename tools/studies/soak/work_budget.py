"""The time that a row of works still takes, and whether it may take it."""

import statistics
import time


class WorkBudget:
    """Names of works, in their order, and the seconds that some of them took before: what is left of them, from those and,
    where one has not been run before, from the mean of the others. `limit_s` is what all of them may take."""

    def __init__(self, names, earlier_s, limit_s, now=time.monotonic):
        self.names, self.limit_s, self.now = list(names), limit_s, now
        self.known_s = {name: earlier_s[name] for name in names if name in earlier_s}
        self.start = self.begun = now()

    def begin(self):
        self.begun = self.now()

    def done(self, name):
        """Returns the seconds since begin()."""
        self.known_s[name] = self.now() - self.begun
        self.pass_over(name)
        return round(self.known_s[name], 1)

    def pass_over(self, name):
        self.names.remove(name)

    def is_over(self):
        return self.now() - self.start >= self.limit_s

    def words(self):
        if not self.names:
            return "none left"
        number = f"{len(self.names)} left"
        if not self.known_s:
            return f"{number}, at most {self.limit_s / 60:.0f} min"
        mean = statistics.fmean(self.known_s.values())
        left_s = sum(self.known_s.get(name, mean) for name in self.names)
        late = "" if self.now() - self.start + left_s <= self.limit_s else f"; more than the {self.limit_s / 60:.0f} min that it may take"
        return f"{number}, about {max(round(left_s / 60), 1)} min{late}"
