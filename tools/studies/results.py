"""Writes RESULTS.md: the tables of what tools/demo, tools/bench and tools/reproduce have measured, each with machine, date
and command, all of one commit. What was measured of another commit, or not at all, is named as not measured.

Usage: tools/reproduce --results, or python3 -m studies.results [--from DIR] [--into FILE] [--commit NAME]"""

import argparse
import pathlib
import shutil

from studies.command import die
from studies.measured import REPOSITORY, commit_name, read_json_if_any

HERE = pathlib.Path(__file__).resolve().parent
NOT_MEASURED = "not measured"
FAILURES = "files/failures/realtime.png"  # below out/reproduce

HEAD = """# Results

Written by `tools/reproduce --results` of what `tools/demo`, `tools/bench` and `tools/reproduce` have measured; do not edit.
All of commit `{commit}`. What the figures mean, and what was chosen on which data: [README.md](README.md).
Rendered training views and test scenes share one model of the sensor, but for the table that names another.
"""


def show(value, form="{:.3f}"):
    return NOT_MEASURED if value is None else form.format(value)


def ms(value):
    return show(value, "{:.1f}")


def table(rows):
    """Markdown; rows: the header first."""
    lines = [
        "| " + " | ".join(str(cell).replace("|", "\\|").replace("–", NOT_MEASURED) for cell in row) + " |"
        for row in rows
    ]
    return "\n".join([lines[0], "|" + "---|" * len(rows[0]), *lines[1:]])


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


def demo_table(summary):
    names = list(summary["auc"])
    recall, processed = "pose_recall_add_s_10", summary["processed"]
    listed = [("AUC", summary["auc"]), ("recall at the defaults", summary["recall"])]
    if summary["bop19_ar"]:
        listed += [
            ("ADD-S recall", summary[recall]),
            ("BOP average recall", summary["bop19_ar"] | {"mean": summary["bop19_ar"]["all"]}),
        ]
    listed += [
        ("AUC, processed frames alone", processed["auc"]),
        ("recall, processed frames alone", processed["recall"]),
    ]
    if summary["bop19_ar"]:
        listed.append(("ADD-S recall, processed frames alone", processed[recall]))

    def cell(found, name):
        return "" if name == "mean" and name not in found else show(found.get(name))

    return table([("", *names), *((words, *(cell(found, name) for name in names)) for words, found in listed)])


def demo_frames(summary):
    latency = "; ".join(
        f"{stage} {ms(found['p50'])}, {ms(found['p99'])}" for stage, found in summary["latency_ms"].items()
    )
    text = ("{frames_sent} frames sent, {frames_detected} detected, {frames_skipped} passed over for newer ones, {frames_lost} "
            "lost; {frames_with_poses} with poses; {rate_hz:.1f} results a second; false detections at the "
            "defaults: {false_detections}; training {train_seconds:.0f} s. ").format(**summary)  # fmt: skip
    clutter = summary.get("clutter")
    if clutter:
        text += "Clutter: {false_detections} detections, all false, in {frames_processed} frames. ".format(**clutter)
    return text + f"Latency, median and 99 %, ms: {latency}."


def live_table(summary):
    rows = [("from the shutter to, ms", "p50", "p95", "p99")]
    return table(
        rows
        + [(name, *(ms(found[p]) for p in ("p50", "p95", "p99"))) for name, found in summary["glass_to_ms"].items()]
    )


def live_frames(summary):
    return ("{frames_sent} frames, {frames_lost_from_camera} lost between camera and hs-capture, {frames_lost_on_bus} on the "
            "bus; {frames_detected} detected, {frames_skipped} passed over, {frames_with_poses} with poses.").format(**summary)  # fmt: skip


def speed_table(summary):
    from studies.bench import speed

    return table([("", "ms a frame", "AUC", "settings of both"), *speed.detection_rows(summary)])


def speed_gains(summary):
    default = summary["at_default"]
    return (
        f"`realtime` against the original, same fast engine, one thread each: "
        f"{show(summary['speedup_over_gall_same_engine'], '{:.0f}')}-fold. Whole systems, the original in its reference engine "
        f"on one thread against `realtime` on all, both ranking every maximum: {show(summary['speedup_over_gall_whole_system'], '{:.0f}')}-fold. As it "
        f"runs, from its default score on: {show(default['ms'], '{:.2f}')} ms, precision {show(default['precision'])}, recall "
        f"{show(default['recall'])}."
    )


def stage_table(summary):
    from studies.bench import speed

    return table(speed.stage_rows(summary))


def small_speed_table(summary):
    rows = [("`realtime`, default settings", "ms a frame")]
    rows += [
        (f"{count} thread{'s' if count > 1 else ''}", show(value, "{:.2f}")) for count, value in summary["threads"]
    ]
    return table(rows + [(f"one thread, {name}", show(value, "{:.2f}")) for name, value in summary["simd"].items()])


def stream_table(summary):
    from studies.bench import speed

    header = (
        "frames",
        "p50 ms",
        "p95 ms",
        "p99 ms",
        "sent",
        "lost",
        "skipped",
        "with poses",
        "cores in use",
        "memory, MB",
    )
    return table([header, *speed.stream_rows(summary)])


def growth_table(summary):
    series = {"objects": "objects", "trees": "trees", "pixels": "pixels"}
    parts = []
    for name, words in series.items():
        if summary[name]:
            rows = [(words, *(count for count, _ in summary[name])), ("ms", *(ms(value) for _, value in summary[name]))]
            parts.append(
                table(rows) + f"\n\nTime goes with the power {show(summary['exponents'][name], '{:.2f}')} of {words}."
            )
    return "\n\n".join(parts)


def pose_table(summary):
    rows = [
        ("", "ms a pose, median", "ADD-S recall", "ADD(-S) recall", "AR", f"AR on {summary['rival_frames']} frames")
    ]
    ours = f"{show(summary['ms_per_pose_median'], '{:.2f}')} (99 %: {show(summary['ms_per_pose_p99'], '{:.2f}')})"
    rows.append(("ours, all detections from score 0.1 on", ours, show(summary["add_s_recall"]), show(summary["add_recall"]),
                 show(summary["bop_ar"]), show(summary["bop_ar_on_rival_frames"])))  # fmt: skip
    strong = (show(summary["add_s_recall_from_0.5"]), show(summary["add_recall_from_0.5"]))
    rows.append(("ours, detections from score 0.5 on", "", *strong, "", ""))
    pcl = (show(summary["pcl_add_s_recall"]), show(summary["pcl_add_recall"]), show(summary["bop_ar_pcl"]))
    rows.append(("PCL's point-to-plane ICP from the same starts", ms(summary["pcl_ms_median"]), *pcl, ""))
    for name, words in (
        ("prerejective", "FPFH, prerejective sampling, ICP (PCL)"),
        ("ppf", "point pair features, ICP (OpenCV)"),
    ):
        rows.append((words, ms(summary[f"{name}_ms_median"]), "", "", "", show(summary[f"bop_ar_{name}"])))
    return table(rows)


def pose_words(summary):
    return (
        f"{summary['frames']} frames; of all published poses {show(summary['published_good_fraction'])} are right; errors "
        f"(medians): {show(summary['translation_mm_median_at_1m'], '{:.2f}')} mm at 1 m, "
        f"{show(summary['rotation_deg_median'], '{:.2f}')} degrees."
    )


def recorded_pose_words(summary):
    real = summary["real"]
    if real["frames"] is None:
        return None
    return (
        f"Camera-recorded: of {real['frames']} frames with a reliable pseudo pose {real['with_pose']} have a pose, "
        f"{real['within_5mm_5deg']} within 5 mm and 5 degrees; median {show(real['median_mm'], '{:.2f}')} mm, "
        f"{show(real['median_deg'], '{:.2f}')} degrees."
    )


def bop_table(summary):
    from studies.bop import report

    columns = (*report.TABLE, ("teach_seconds", "teaching, s"))
    return table([report.header(columns, "set"), *report.rows(summary["datasets"], columns)])


def bop_rivals(summary):
    from studies.bop import report

    if not summary["settings"]["rivals"]:
        return None
    cut = [f"{name}: {run['rivals_cut']}." for name, run in summary["datasets"].items() if run["rivals_cut"]]
    rows = [report.header(report.RIVALS, "set"), *report.rows(summary["datasets"], report.RIVALS)]
    return "\n\n".join([table(rows), *cut])


def bop_words(summary):
    settings = summary["settings"]
    words = f"Every {settings['every']}th image" if settings["every"] > 1 else "All images"
    taught = f"the store {settings['objects']}" if settings["objects"] else f"{settings['seeds']} teaching(s) a set"
    return f"{words} of the sets' targets, split `{settings['split']}`; {taught}."


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
        return lambda summary: None if name in summary["settings"]["left_out"] else table(make(summary))

    return [
        ("At a glance, beside the paper", of(tables.glance)),
        ("Six rendered scenes", of(tables.final), default_point, shown("final.svg", "AUC of all detectors over six scenes")),
        ("What depth adds", features, shown("features.svg", "AUC by feature"), of(tables.depth_normalisation)),
        ("What saves time", of(tables.timings), of(tables.strides), shown("stride.svg", "AUC and time of paper by stride")),
        ("Another sensor", of(tables.other_sensor)),
        ("Camera-recorded data", of(tables.real)),
        ("Twenty objects", measured("objects_20", tables.twenty)),
        ("What lies or leans", measured("attitudes", tables.attitudes)),
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
    pose = Source(out / "bench" / "pose.json", commit)
    return [
        section(
            "Speed: one frame", speed, "tools/bench speed", speed_table, speed_gains, stage_table, small_speed_table
        ),
        section("Speed: a minute of replay at 30 Hz, frame to poses", stream, "tools/bench stream", stream_table),
        section("Speed: how time grows", growth, "tools/bench growth", growth_table),
        section("Poses", pose, "tools/bench pose", pose_table, pose_words, recorded_pose_words),
    ]


def bop_sections(out, commit):
    measured = Source(out / "bop" / "summary.json", commit)
    command = "tools/bench bop --dataset NAME=ROOT"
    return [section("Sets of the BOP challenge", measured, command, bop_table, bop_words, bop_rivals)]


def copy_pictures(folder, into):
    from PIL import Image

    into.mkdir(parents=True, exist_ok=True)
    for file in sorted((folder / "pictures").glob("*.svg")):
        shutil.copyfile(file, into / file.name)
    if (folder / FAILURES).is_file():
        Image.open(folder / FAILURES).convert("RGB").save(into / "failures.jpg", quality=85)


def page(out, commit):
    reproduced = Source(out / "reproduce" / "summary.json", commit)
    sections = demo_sections(out, commit) + bench_sections(out, commit) + bop_sections(out, commit)
    if reproduced.is_there:
        sections += [
            section(title, reproduced, "", *content) for title, *content in reproduce_tables(out / "reproduce")
        ]
    else:
        sections.append(section("The paper's comparison, repeated", reproduced, "tools/reproduce"))
    return "\n".join([HEAD.format(commit=commit), *sections]), reproduced.is_there


def write(out=REPOSITORY / "out", into=HERE / "RESULTS.md", commit=None):
    commit = commit or commit_name()
    text, with_pictures = page(out, commit)
    if text.count("Not measured of this commit") == text.count("\n## "):
        die(f"{out}: nothing there was measured of commit {commit}")
    if with_pictures:
        copy_pictures(out / "reproduce", into.parent / "pictures")
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
