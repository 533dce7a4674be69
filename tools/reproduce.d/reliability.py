"""Whether a score is the probability that it claims to be."""

import math

BINS = 10


def verdicts(curve):
    """(score, is true) of each point of one curves.csv: recall rises exactly where a detection was true."""
    judged = []
    recall = {}
    for point in curve:
        name, now = point["object"], float(point["recall"])
        judged.append((float(point["score"]), now > recall.get(name, 0.0)))
        recall[name] = now
    return judged


def wilson(share, count, z=1.96):
    """95 % interval of a share seen in so many trials (Wilson 1927)."""
    centre = share + z * z / (2 * count)
    half = z * math.sqrt(share * (1 - share) / count + z * z / (4 * count * count))
    return (centre - half) / (1 + z * z / count), (centre + half) / (1 + z * z / count)


def reliability(curves):
    """For each bin of the score that has any: its mean score, count, share that is true, and that share's interval."""
    bins = [[] for _ in range(BINS)]
    for score, is_true in (verdict for curve in curves for verdict in verdicts(curve)):
        bins[min(max(int(score * BINS), 0), BINS - 1)].append((score, is_true))
    rows = []
    for judged in filter(None, bins):
        share = sum(is_true for _, is_true in judged) / len(judged)
        low, high = wilson(share, len(judged))
        mean = sum(score for score, _ in judged) / len(judged)
        rows.append({"score": mean, "count": len(judged), "share_true": share, "low": low, "high": high})
    return rows


def calibration_error(rows):
    """Expected calibration error: |score - share| averaged over the detections; None without any."""
    count = sum(row["count"] for row in rows)
    return sum(row["count"] * abs(row["score"] - row["share_true"]) for row in rows) / count if count else None
