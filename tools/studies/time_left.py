"""How long work still takes: by what its steps took before, or what they are expected to take, at the pace of those that are
done. The expected seconds are of a machine with two slow cores; the first step that ends corrects them."""

import re
import time

SECONDS_APART = 10  # of two lines of progress
LONGEST_WORDS = 90


def in_words(seconds):
    minutes, seconds = divmod(int(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    if hours:
        return f"{hours} h {minutes:02} min"
    return f"{minutes} min {seconds:02} s" if minutes else f"{seconds} s"


def left_in_words(seconds):
    """Of less than a second: what goes on takes longer than it was expected to, and ends soon."""
    return "about " + in_words(seconds) + " left" if seconds >= 1.0 else "nearly done"


def seconds_said(words):
    """How long a program says that it still takes, "..., about 2 min 03 s left"; 0 where it does not. Of several parts it says so of
    the one that it is at."""
    said = re.search(r"about (?:(\d+) h )?(?:(\d+) min )?(?:(\d+) s )?left", words)
    hours, minutes, seconds = (int(part or 0) for part in said.groups()) if said else (0, 0, 0)
    return 3600 * hours + 60 * minutes + seconds


def last_words(log):
    """The last line that a program has written, shortened, or None."""
    lines = [line.strip() for line in log.read_text(errors="replace").splitlines() if line.strip()]
    return lines[-1][:LONGEST_WORDS] if lines else None


class TimeLeft:
    """Steps in order, {name: expected seconds}. `clock` returns seconds."""

    def __init__(self, expected, clock=time.monotonic):
        self.expected, self.clock = expected, clock
        self.took, self.running, self.since = {}, None, clock()

    def begin(self, name):
        """Ends the step that runs. Raises KeyError for a step that is not among them."""
        now = self.clock()
        if self.running is not None:
            self.took[self.running] = now - self.since
        if name not in self.expected:
            raise KeyError(f"{name}: no step, expected one of {', '.join(self.expected)}")
        self.running, self.since = name, now

    def pace(self):
        """How many seconds one of the expected ones takes."""
        return pace_of([(self.took[name], self.expected[name]) for name in self.took])

    def seconds(self):
        rest = sum(seconds for name, seconds in self.expected.items() if name not in self.took and name != self.running)
        running = self.expected.get(self.running, 0.0) * self.pace() - (self.clock() - self.since)
        return rest * self.pace() + max(running, 0.0)

    def words(self):
        return left_in_words(self.seconds())


def pace_of(pairs):
    """Of (seconds that something took, expected ones); 1 where nothing is known."""
    took, expected = (sum(values) for values in zip(*pairs)) if pairs else (0.0, 0.0)
    return took / expected if expected > 0 else 1.0
