"""Writes RESULTS.md: the tables of what tools/demo, tools/bench and tools/reproduce have measured, each with machine, date
and command, all of one commit. What was measured of another commit, or not at all, is named as not measured.

Usage: tools/reproduce --results, or python3 -m studies.results [--from DIR] [--into FILE] [--commit NAME]"""

import argparse
import pathlib
import shutil

from studies.command import die
from studies.records import REPOSITORY, commit_name, read_json_if_any
from studies.result_tables import (
    attitude_defaults,
    attitude_table,
    attitude_words,
    bop_rivals,
    bop_table,
    bop_words,
    demo_frames,
    demo_table,
    growth_table,
    host_words,
    household_table,
    household_words,
    live_frames,
    live_table,
    pose_table,
    pose_words,
    rate_table,
    recorded_pose_words,
    sequence_table,
    show,
    shown_table,
    shown_words,
    small_speed_table,
    speed_gains,
    speed_table,
    stage_table,
    stream_table,
    table,
    track_words,
)

HERE = pathlib.Path(__file__).resolve().parent
FAILURES = "files/failures/realtime.png"  # below out/reproduce

HEAD = """# Results

Written by `tools/reproduce --results` of what `tools/demo`, `tools/bench` and `tools/reproduce` have measured; do not edit.
All of commit `{commit}`. What the figures mean, and what was chosen on which data: [README.md](README.md).
Rendered training views and test scenes share one model of the sensor, but for the table that names another.
"""


class Source:
    """A summary.json, where it is of the commit that is asked for."""

    def __init__(self, file, commit, part=None):
        summary = read_json_if_any(file)
        about = None if summary is None else summary["parts"][part] if part else summary.get("settings", {}) | summary
        self.is_there = bool(about) and about.get("commit") == commit
        self.summary = summary if self.is_there else None
        self.origin = f"*`{about['command']}`; {about['cpu']}; {about['date']}*" if self.is_there else ""


def section(title, source, command, *content):
    """`content`: functions of the summary that give tables or sentences, or None."""
    if not source.is_there:
        return f"## {title}\n\nNot measured of this commit: `{command}`.\n"
    parts = [part for part in (make(source.summary) for make in content) if part]
    return "\n\n".join([f"## {title}", source.origin, *parts]) + "\n"


def reproduce_tables(folder):
    """(title, functions of the summary) of each section."""
    from studies.reproduce import tables

    def of(make):
        return lambda summary: table(make(summary))

    def shown(name, words):
        made = folder / (FAILURES if name == "failures.jpg" else f"pictures/{name}")
        return lambda _: f"![{words}](pictures/{name})" if made.is_file() else None

    def features(summary):
        return table(tables.feature_rows(summary, summary["settings"]["left_out"]))

    def default_point(summary):
        return (f"`realtime` from its default score on, six scenes: precision {show(summary['precision_at_default'])}, recall "
                f"{show(summary['recall_at_default'])}; training {show(summary['train_seconds'], '{:.0f}')} s.")  # fmt: skip

    def measured(name, make):
        left_out = "Left out by a quick run: `tools/reproduce` without `--quick` measures it."
        return lambda summary: left_out if name in summary["settings"]["left_out"] else table(make(summary))

    return [
        ("At a glance, beside the paper", of(tables.glance)),
        ("Six rendered scenes", of(tables.final), default_point, shown("final.svg", "AUC of all detectors over six scenes")),
        ("What depth adds", features, shown("features.svg", "AUC by feature"), of(tables.depth_normalisation)),
        ("What saves time", of(tables.timings), of(tables.strides), shown("stride.svg", "AUC and time of paper by stride")),
        ("Another sensor", of(tables.other_sensor)),
        ("Camera-recorded data", of(tables.real)),
        ("Twenty objects", measured("objects_20", tables.twenty)),
        ("What a score means", lambda summary: table(tables.reliability(summary["reliability"])),
         shown("reliability.svg", "Predicted score against the share of true detections")),
        ("What still fails", lambda _: "The gravest of each scene; red: false, yellow: not found from the default score on.",
         shown("failures.jpg", "Failures of realtime")),
    ]  # fmt: skip


def demo_sections(out, commit):
    demo, real, live = (Source(out / name / "summary.json", commit) for name in ("demo", "real", "live"))
    return [
        section("Demo: a rendered scene at 30 Hz", demo, "tools/demo", demo_table, demo_frames),
        section("Demo: camera-recorded pictures at 2 Hz", real, "tools/demo --real DIR", demo_table, demo_frames),
        section("Demo: live, from the virtual camera's shutter", live, "tools/demo --live", live_table, live_frames),
    ]


def bench_sections(out, commit):
    file = out / "bench" / "summary.json"
    speed, stream, growth = (Source(file, commit, part) for part in ("speed", "stream", "growth"))
    pose, attitudes = (Source(out / "bench" / f"{part}.json", commit) for part in ("pose", "attitudes"))
    return [
        section(
            "Speed: one frame", speed, "tools/bench speed", speed_table, speed_gains, stage_table, small_speed_table
        ),
        section("Speed: a minute of replay at 30 Hz, frame to poses", stream, "tools/bench stream", stream_table),
        section("Speed: how time grows", growth, "tools/bench growth", growth_table),
        section("Poses", pose, "tools/bench pose", pose_table, pose_words, recorded_pose_words),
        section(
            "What lies or leans", attitudes, "tools/bench attitudes", attitude_table, attitude_defaults, attitude_words
        ),
    ]


def life_sections(out, commit):
    """Returns the sections of objects that are followed over time, of objects that are shown, and of many in one store."""
    tracks, shown = Source(out / "bench" / "tracks.json", commit), Source(out / "teach" / "summary.json", commit)
    household = Source(out / "household" / "summary.json", commit)
    followed = (sequence_table, track_words, rate_table, host_words)
    return [
        section("Objects that persist", tracks, "tools/bench tracks", *followed),
        section("Objects that are shown to a camera", shown, "tools/bench teach", shown_table, shown_words),
        section("A household", household, "tools/bench household", household_table, household_words),
    ]


def bop_sections(out, commit):
    measured = Source(out / "bop" / "summary.json", commit)
    command = "tools/bench bop --dataset NAME=ROOT"
    return [section("Sets of the BOP challenge", measured, command, bop_table, bop_words, bop_rivals)]


def copy_images(folder, into):
    from PIL import Image

    into.mkdir(parents=True, exist_ok=True)
    for file in sorted((folder / "pictures").glob("*.svg")):
        shutil.copyfile(file, into / file.name)
    if (folder / FAILURES).is_file():
        Image.open(folder / FAILURES).convert("RGB").save(into / "failures.jpg", quality=85)


def page(out, commit):
    reproduced = Source(out / "reproduce" / "summary.json", commit)
    made = (demo_sections, bench_sections, life_sections, bop_sections)
    sections = [one for make in made for one in make(out, commit)]
    if reproduced.is_there:
        sections += [
            section(title, reproduced, "", *content) for title, *content in reproduce_tables(out / "reproduce")
        ]
    else:
        sections.append(section("The paper's comparison, repeated", reproduced, "tools/reproduce"))
    return "\n".join([HEAD.format(commit=commit), *sections]), reproduced.is_there


def write(out=REPOSITORY / "out", into=HERE / "RESULTS.md", commit=None):
    commit = commit or commit_name()
    text, with_images = page(out, commit)
    if text.count("Not measured of this commit") == text.count("\n## "):
        die(f"{out}: nothing there was measured of commit {commit}")
    if with_images:
        copy_images(out / "reproduce", into.parent / "pictures")
    into.write_text(text)
    print(into)


def main():
    parser = argparse.ArgumentParser(prog="studies.results", description=__doc__)
    parser.add_argument(
        "--from", dest="out", type=pathlib.Path, default=REPOSITORY / "out", help="folder of demo/, bench/ ..."
    )
    parser.add_argument("--into", type=pathlib.Path, default=HERE / "RESULTS.md")
    parser.add_argument("--commit", help="default: the one that is checked out")
    options = parser.parse_args()
    write(options.out, options.into, options.commit)


if __name__ == "__main__":
    main()
