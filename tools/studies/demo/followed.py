"""What one replay of tools/demo that follows objects adds up to: hs-pose --follow publishes poses for each frame at once, while
hs-detect inspects a few frames a second."""

from studies.command import die
from studies.records import read_json
from studies.report.page import show


def account(sent, observed):
    """What became of every frame that was sent, by the own count of hs-pose. Ends the demo where it does not add up."""
    pose = observed["processes"].get("hs-pose")
    if pose is None:
        die("hs-pose has sent no status, so the frames cannot be accounted for")
    counts = {
        "frames_followed": pose["processed"],
        "frames_passed_over": pose["skipped"],
        "frames_lost": sent - pose["received"],
    }
    if sum(counts.values()) != sent:
        die(f"{sent} frames sent, but followed + passed over + lost = {sum(counts.values())}: {counts}, {pose}")
    return counts


def summarise(out, sent, observed):
    """Poses beside the truth: which share of the published ones is right, and which share of all objects in all frames that were
    sent has a right one, so that those of a frame that was passed over or lost are missed."""
    evaluated = read_json(out / "stream" / "evaluation" / "summary.json").get("followed")
    if evaluated is None:
        die("hs-evaluate found no poses of followed objects, expected some of hs-pose --follow")
    keys = ("published", "required", "right_fraction", "right_up_to_shape_fraction", "recall", "recall_up_to_shape")
    return {
        **account(sent, observed),
        "frames_with_poses": observed["frames_with_poses"],
        "looks": observed["frames_detected"],
        **{key: evaluated[key] for key in keys},
        "latency_ms": observed["latency_ms"]["total"],
        "objects_latency_ms": observed["objects_latency_ms"],
    }


HEADER = ("object", "poses published", "right", "right up to shape", "objects in all frames", "of these with a right pose",
          "up to shape")  # fmt: skip


def object_rows(followed):
    keys = ("published", "right_fraction", "right_up_to_shape_fraction", "required", "recall", "recall_up_to_shape")

    def cell(value):
        return str(value) if isinstance(value, int) else show(value)

    return [(name, *(cell(followed[key][name]) for key in keys)) for name in followed["required"]]


def frame_rows(followed, sent):
    def latency(found):
        return "{}, {} ms".format(*(show(found[p], "{:.1f}") for p in ("p50", "p99")))

    return [
        ("frames sent", sent),
        ("followed", followed["frames_followed"]),
        ("passed over for newer ones", followed["frames_passed_over"]),
        ("lost", followed["frames_lost"]),
        ("looks of the detector", followed["looks"]),
        ("frame to poses, median and 99 %", latency(followed["latency_ms"])),
        ("frame to objects of the world", latency(followed["objects_latency_ms"])),
    ]


def words(followed, sent):
    """For the terminal, the first lines."""
    lines = [f"{'object':<16}{'published':>10}{'right':>8}{'by shape':>10}{'in all frames':>15}{'right pose':>12}{'by shape':>10}"]
    for name, published, right, shape, required, recall, shape_recall in object_rows(followed):
        lines.append(f"{name:<16}{published:>10}{right:>8}{shape:>10}{required:>15}{recall:>12}{shape_recall:>10}")
    counts = ", ".join(f"{what} {count}" for what, count in frame_rows(followed, sent)[:5])
    return "\n".join([*lines, "", counts, *("{}: {}".format(*row) for row in frame_rows(followed, sent)[5:])])
