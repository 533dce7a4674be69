"""The account of a long run, of its samples, arrivals and counts, with what is not as it should be."""

import csv
import itertools
import math
import re
import statistics

from studies.records import percentiles

SETTLED_S, WINDOW_S = 120, 60  # from minute two on nothing may grow; it is looked at minute by minute
# Of memory: it may swing, it may not grow.
MOST_GROWTH = 0.005  # an hour, by its slope
MOST_RISE = 0.02  # that stays, from the first to the last quarter
SURE = 2.326  # standard deviations: one-sided, 99 %
MOST_PASSED_OVER = 0.01  # of the frames of each process
LEAST_RATE = 0.98  # of the rate that was asked for
CHAIN = ("capture", "detect", "pose", "track")  # each works on what the one before it sends
ARRIVALS = {"poses": "t_poses", "objects": "t_objects"}  # columns of hs-observe's CSV
LOOKS = re.compile(r"looks: (\d+) came, (\d+) answered, (\d+) passed over")
CAPTURED = re.compile(r"(\d+) frames of .*, ([\d.]+) Hz$", re.MULTILINE)


def windows(samples):
    """The samples of each minute from the second on; of a shorter run those of each quarter of its second half."""
    end = samples[-1]["s"]
    start = min(SETTLED_S, end / 2)
    length = min(WINDOW_S, (end - start) / 4)
    last = max(int((end - start) / length + 1e-6), 1) - 1 if length else 0  # what is left of a minute belongs to the one before
    found = [[] for _ in range(last + 1)]
    for one in samples:
        if one["s"] >= start:
            found[min(int((one["s"] - start) / length), last) if length else 0].append(one)
    return [window for window in found if window]


def grows(settled, key):
    """Returns whether there is a window in which the count never came down to the least of the first: a file that is open while
    it is read does not count."""
    least = [min(one[key] for one in window) for window in settled]
    return max(least) > least[0]


def fewer(values):
    """Returns as how many times fewer values these count, whose neighbours resemble one another, as in a slow swing (Hamed and
    Rao 1998)."""
    count, mean = len(values), statistics.fmean(values)
    spread = sum((value - mean) ** 2 for value in values)
    # What is left of an exact line is the rounding of its numbers.
    if count < 4 or spread <= 1e-12 * count * max(abs(value) for value in values) ** 2:
        return 1.0
    alike = 0.0
    for lag in range(1, count - 2):
        same = sum((a - mean) * (b - mean) for a, b in zip(values, values[lag:])) / spread
        if abs(same) > SURE / math.sqrt(count):  # others are chance
            alike += (count - lag) * (count - lag - 1) * (count - lag - 2) * same
    return max(1.0 + 2.0 * alike / (count * (count - 1) * (count - 2)), 1.0)


def trend(times, values):
    """Slope by Theil and Sen, the median of the slopes between all pairs, and the one that it exceeds with 99 % (Sen 1968);
    None where the values are too few to say so."""
    pairs = itertools.combinations(zip(times, values), 2)
    slopes = sorted((after - before) / (end - start) for (start, before), (end, after) in pairs)
    if not slopes:
        return 0.0, None
    slope = statistics.median(slopes)
    count = len(values)
    alike = fewer([value - slope * time for time, value in zip(times, values)])
    deviation = math.sqrt(count * (count - 1) * (2 * count + 5) / 18 * alike)
    place = math.floor((len(slopes) - SURE * deviation) / 2)
    return slope, slopes[place] if place >= 0 else None


def memory_growth(settled):
    """Returns how memory grows, as parts of its median: an hour, by the slope of the minutes' medians; what that is at least;
    and the rise from all of the first quarter to all of the last one."""
    hours = [statistics.fmean(one["s"] for one in window) / 3600 for window in settled]
    mb = [statistics.median(one["mb"] for one in window) for window in settled]
    middle = statistics.median(mb)
    slope, surely = trend(hours, mb)
    quarter = max(len(mb) // 4, 1)
    rise = min(mb[-quarter:]) - max(mb[:quarter]) if len(mb) > 1 else 0.0
    return {
        "growth_per_hour": round(slope / middle, 4),
        "growth_surely": None if surely is None else round(surely / middle, 4),
        "rise": round(max(rise, 0.0) / middle, 4),
        "swing": round((max(mb) - min(mb)) / middle, 4),
    }


def cost(samples):
    """Returns what one process takes, and how far that grows from minute two on."""
    settled = windows(samples)
    seconds = samples[-1]["s"] - samples[0]["s"]
    return {
        "cores": round((samples[-1]["cpu_s"] - samples[0]["cpu_s"]) / seconds, 3) if seconds else 0.0,
        "memory_mb": round(statistics.median(one["mb"] for one in settled[0]), 1),
        **memory_growth(settled),
        **{key: sorted({one[key] for window in settled for one in window}) for key in ("descriptors", "threads")},
        "growing": [key for key in ("descriptors", "threads") if grows(settled, key)],
    }


def captured(words):
    """(frames, Hz) of what hs-capture says in the end, or None."""
    found = CAPTURED.search(words)
    return (int(found.group(1)), float(found.group(2))) if found else None


def looks_of(words):
    """Returns what hs-pose --follow says in the end of the detector's results, or None."""
    found = LOOKS.search(words)
    return dict(zip(("came", "answered", "passed_over"), map(int, found.groups()))) if found else None


def accounts(sent, counts, looks=None):
    """Returns what each process says of its frames, which share it passed over, and how many of the results of the one before
    it never came to it: what is lost behind the last that comes its own count cannot know. hs-pose --follow takes each frame
    itself, hs-detect looks at some only, as it is told to; the answer to such a look (`looks`: see looks_of) is a second result
    of its frame, which hs-track passes over when it has the first."""
    found, before = {}, sent
    for name in CHAIN[1:]:
        one = counts[name]
        second = looks["answered"] if looks and name == "track" else 0
        found[name] = {**one, "missing": before + second - one["received"]}
        if looks and name == "detect":
            continue
        if looks and name == "pose":
            found[name]["missing"] += counts["detect"]["processed"] - looks["came"]
        found[name]["passed_over"] = round(max(one["skipped"] - second, 0) / max(one["received"] - second, 1), 5)
        before = one["processed"]
    return found


def latencies(file):
    """Milliseconds from a frame's arrival to that of its poses, and to that of the world's objects after it: of the whole
    run, and of each minute."""
    found = {result: {} for result in ARRIVALS}
    with open(file, newline="") as text:
        for row in csv.DictReader(text):
            for result, column in ARRIVALS.items():
                if row["t_frame"] and row[column]:
                    frame = float(row["t_frame"])
                    found[result].setdefault(int(frame // 60), []).append(1e3 * (float(row[column]) - frame))
    return {result: of_result(by_minute) for result, by_minute in found.items()}


def of_result(by_minute):
    whole = [value for values in by_minute.values() for value in values]
    minutes = [{"minute": minute, **percentiles(by_minute[minute], (50, 99))} for minute in sorted(by_minute)]
    return {"frames": len(whole), **percentiles(whole, (50, 99)), "minutes": minutes}


def wrong_of_process(name, one):
    """Yields the faults of a process, in words."""
    for count in ("lost", "missing", "refused"):
        if one.get(count):
            yield f"hs-{name}: {one[count]} {count}"
    if one.get("passed_over", 0) > MOST_PASSED_OVER:
        yield f"hs-{name}: {one['passed_over']:.2%} passed over, expected at most {MOST_PASSED_OVER:.0%}"
    if one["growth_per_hour"] > MOST_GROWTH and (one["growth_surely"] or 0.0) > 0.0:
        yield (f"hs-{name}: memory grows by {one['growth_per_hour']:.1%} an hour, surely by {one['growth_surely']:.1%}, "
               f"expected at most {MOST_GROWTH:.1%}")  # fmt: skip
    elif one["rise"] > MOST_RISE:
        yield f"hs-{name}: memory has risen by {one['rise']:.1%} and stays there, expected at most {MOST_RISE:.0%}"
    for key in one["growing"]:
        yield f"hs-{name}: more {key} than in minute 2"


def wrong(seen):
    """Returns what is not as it should be; nothing where the run is good."""
    found = [seen["failed"]] if "failed" in seen else []
    if "sent_hz" in seen and seen["sent_hz"] < LEAST_RATE * seen["rate_hz"]:
        found.append(f"hs-capture: {seen['sent_hz']} Hz, expected {seen['rate_hz']}")
    for name, one in seen["processes"].items():
        found += wrong_of_process(name, one)
    return found + [f"no {result} have come" for result, one in seen.get("latency_ms", {}).items() if not one["frames"]]
