"""summary.json and report.md: what is measured now takes the place of what was measured before, the rest stays; each part
says of which commit it is."""

from studies.command import die
from studies.records import about, commit_name, read_json_if_any, write_atomically, write_json

PARTS = ("faults", "long")
COUNTS = ("received", "processed", "skipped", "passed_over", "lost", "missing", "refused")
COSTS = ("cores", "memory_mb", "growth_per_hour", "growth_surely", "rise", "swing", "descriptors", "threads")
SHARES = ("passed_over", "growth_per_hour", "growth_surely", "rise", "swing")
NOT_TOLD = ("good", "load", "reported", "back_after_s", "about")


def read_earlier(file):
    """By part. What does not say of which commit it is, speaks of none."""
    try:
        old = read_json_if_any(file) or {}
        return {part: {name: seen for name, seen in old.get(part, {}).items() if isinstance(seen, dict) and "about" in seen}
                for part in PARTS}  # fmt: skip
    except (ValueError, AttributeError) as error:
        die(f"{file}: {error}, expected the JSON that this has written; remove it to measure anew")


class Record:
    """Both files, in a folder. They are written whenever something has been measured."""

    def __init__(self, folder):
        self.folder = folder
        self.summary = read_earlier(folder / "summary.json")
        self.good = True  # all that was measured now
        commit_name()  # that of the programs, whatever is checked out meanwhile

    def note(self, part, name, seen, command):
        self.summary[part][name] = {**seen, "about": about(command)}
        self.good = self.good and seen["good"]
        self.write()

    def write(self):
        write_json(self.folder / "summary.json", self.summary)
        write_atomically(self.folder / "report.md", page(self.summary))


def words_of(value):
    """A value for people."""
    if isinstance(value, dict):
        return ", ".join(f"{key} {words_of(one)}" for key, one in value.items())
    return ", ".join(map(words_of, value)) if isinstance(value, list) else str(value)


def counts_of(seen):
    """Returns what became of the frames: of those that were sent, where that is known, of those that came elsewhere."""
    if "processed" not in seen:
        return "–"
    whole = f"{seen['sent']} sent" if "sent" in seen else f"{seen['received']} came"
    return f"{whole} = {seen['processed']} + {seen['skipped']} + {seen['lost']} + {seen['refused']}"


def verdict(seen):
    return "good" if seen["good"] else "**WRONG**"


def fault_lines(faults):
    yield from ("# What the stream does under faults", "",
                "Frames: sent = processed + passed over + lost + refused. Back after: seconds until the first result.", "",
                "| fault | | frames | back after, s | load | commit |", "|---|---|---|---|---|---|")  # fmt: skip
    for name, seen in faults.items():
        yield (f"| {name} | {verdict(seen)} | {counts_of(seen)} | {words_of(seen.get('back_after_s', '–'))} | {seen['load']} | "
               f"{seen['about']['commit']} |")  # fmt: skip
    for name, seen in faults.items():
        rest = {key: value for key, value in seen.items() if key not in NOT_TOLD}
        yield from ("", f"## {name}", "", words_of(rest))
        if seen.get("reported"):
            yield from ("", "What was reported:", "", *(f"    {line}" for line in seen["reported"]))


def cell(one, key):
    if one.get(key) is None:
        return "–"
    return f"{one[key]:.2%}" if key in SHARES else words_of(one[key])


def long_lines(rate, seen):
    """One long run."""
    measured = seen["about"]
    yield from ("", f"## {seen['minutes']} of {seen['of_minutes']} minutes at {rate} Hz: {verdict(seen)}", "",
                f"Of commit {measured['commit']}, {measured['date']}, {measured['cpu']}; `{measured['command']}`.", "")  # fmt: skip
    beside = f" beside another stream of {words_of(seen['beside_hz'])} Hz" if seen["beside_hz"] else ""
    if "sent" in seen:
        yield f"{seen['sent']} frames sent at {seen['sent_hz']} Hz{beside}; {seen['cores']} cores in all."
    for result, latency in seen["latency_ms"].items():
        yield f"From a frame to its {result}: p50 {latency['p50']} ms, p99 {latency['p99']} ms of {latency['frames']}."
    yield from ("", "| process | received | processed | passed over | share | lost | missing | refused "
                "| cores | memory at minute 2, MB | it grows an hour by | surely by | has risen by | swings by | descriptors | threads |",
                "|" + "---|" * 16)  # fmt: skip
    for name, one in seen["processes"].items():
        yield f"| hs-{name} | " + " | ".join(cell(one, key) for key in (*COUNTS, *COSTS)) + " |"
    for title, key in (("What is wrong:", "wrong"), ("What was reported:", "reported")):
        if seen.get(key):
            text = "\n".join(seen[key]).splitlines()
            yield from ("", title, "", *(f"    {line}" for line in text))
    yield from ("", f"![memory, descriptors, threads, latency](long_run_{rate}.png)")


def page(summary):
    lines = list(fault_lines(summary["faults"])) if summary["faults"] else []
    if summary["long"]:
        lines += [*([""] if lines else []), "# Long runs", "",
                  "Lost: frames that never came, by their numbers. Missing: what the process before it sent and it did not get. "
                  "Memory: the slope of the minutes' medians from minute 2 on (Theil and Sen), what it exceeds with 99 %, the rise from "
                  "all of the first quarter to all of the last, and from the least to the most."]  # fmt: skip
    for rate, seen in summary["long"].items():
        lines += long_lines(rate, seen)
    return "\n".join(lines) + "\n"
