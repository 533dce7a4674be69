"""Adds up one replay of tools/demo: summary.json, report.html, and a table for the terminal."""

import json
import shutil

from PIL import Image
from studies.command import die
from studies.demo import followed
from studies.demo.posed import fullest_image, poses_by_frame
from studies.records import about, read_csv, read_json, train_seconds, write_json
from studies.report.charts import Chart
from studies.report.page import embedded, render, show

FEW, SPREAD = 24, 8  # images of a stream: all of so few, else so many of them
RIGHT_RECALL = "mssd_recall"
POSE_RECALL = "pose_recall_add_s_10"  # right up to what the shape cannot tell


def about_run(options):
    """Returns what stands beside the figures."""
    return {**about(options.command), "network": options.network}


def account(sent, observed):
    """Returns what became of every frame that was sent, by the detector's own count. Ends the demo where it does not add up."""
    detector = observed["processes"].get("hs-detect")
    if detector is None:
        die("hs-detect has sent no status, so the frames cannot be accounted for")
    counts = {
        "frames_sent": sent,
        "frames_received": detector["received"],
        "frames_detected": detector["processed"],
        "frames_skipped": detector["skipped"],
        "frames_lost": sent - detector["received"],
        "frames_with_poses": observed["frames_with_poses"],
    }
    accounted = counts["frames_detected"] + counts["frames_skipped"] + counts["frames_lost"]
    if accounted != sent:
        die(f"{sent} frames sent, but detected + skipped + lost = {accounted}: {counts}, {detector}")
    if observed["frames_detected"] != counts["frames_detected"]:
        die(f"hs-detect published {counts['frames_detected']} results, the bus carried {observed['frames_detected']}")
    return counts


def detection_figures(evaluation):
    """Returns figures by object; "mean" is over the objects."""
    auc = {name: value for name, value in evaluation["auc"].items() if name != "weighted"}
    figures = {"auc": auc, "auc_weighted": evaluation["auc"]["weighted"]}
    return figures | {key: evaluation[key] for key in ("precision", "recall", "required", RIGHT_RECALL, POSE_RECALL)}


def clutter(folder):
    evaluation = read_json(folder / "evaluation" / "summary.json")
    return {key: evaluation[key] for key in ("frames_processed", "false_detections", "false_per_frame")}


def commands(store):
    """Returns how each piece of data was made."""
    return {name: store.record(unit)["command"] for name, unit in store.units.items()}


def summarise(options, store, sent):
    """Recalls and AUC are over all frames that were sent; under "processed", over those that hs-detect inspected. Where objects
    are followed, "followed" holds their poses beside the truth, and hs-detect inspects few frames on purpose."""
    out = options.out
    observed = read_json(out / "stream" / "observe.json")
    evaluation = read_json(out / "stream" / "evaluation" / "summary.json")
    summary = {"followed": followed.summarise(out, sent, observed)} if options.follow else {}
    summary |= account(sent, observed)
    summary |= {"rate_hz": observed["detection_rate_hz"], "latency_ms": observed["latency_ms"]}
    summary |= detection_figures(evaluation)
    summary["bop19_ar"] = evaluation["bop19"]["ar"] if "bop19" in evaluation else None
    summary["false_detections"] = evaluation["false_detections"]
    summary["processed"] = detection_figures(read_json(out / "stream" / "evaluation_processed" / "summary.json"))
    summary["train_seconds"] = train_seconds(store.log(store.units["forest"]))
    if "clutter" in store.units:
        summary["clutter"] = clutter(out / "clutter_stream")
    summary |= about_run(options)
    summary["settings"] = {
        "source": options.real or f"rendered scene {options.scene}",
        "network": options.network,
        "evaluation": evaluation["rules"],
        "commands": commands(store),
    }
    return summary


def precision_recall_chart(curves):
    chart = Chart(("recall", 1.0), ("precision", 1.0))
    for name in dict.fromkeys(row["object"] for row in curves):
        chart.line(name, [(float(row["recall"]), float(row["precision"])) for row in curves if row["object"] == name])
    return chart.svg()


def latency_points(times, key):
    """(arrival of the frame, s; from there to that of its results, ms) of the frames that have them."""
    known = [(float(row["t_frame"]), float(row[key])) for row in times if row["t_frame"] and row[key]]
    return [(frame, 1e3 * (results - frame)) for frame, results in known]


def latency_chart(times):
    points = {name: latency_points(times, f"t_{name}") for name in ("detections", "poses")}
    everything = points["detections"] + points["poses"] or [(1.0, 1.0)]
    last, most = max(x for x, _ in everything), 1.1 * max(y for _, y in everything)
    chart = Chart(("stream time, s", last), ("after the frame's arrival, ms", most))
    for name, line in points.items():
        chart.dots(name, line)
    return chart.svg()


def object_rows(summary):
    """The first figures over the frames that hs-detect inspected, the last ones over all that were sent."""

    def figures(found, name):
        return [show(found[key].get(name)) for key in ("auc", "recall", RIGHT_RECALL, POSE_RECALL)]

    return [
        (name, summary["processed"]["required"].get(name, ""), *figures(summary["processed"], name),
         show(summary["precision"].get(name)), summary["required"].get(name, ""), *figures(summary, name))
        for name in summary["auc"]
    ]  # fmt: skip


def frame_rows(summary):
    skipped = "not inspected, as meant" if "followed" in summary else "passed over for newer ones"
    rows = [
        ("frames sent", summary["frames_sent"]),
        ("received by hs-detect", summary["frames_received"]),
        ("inspected", summary["frames_detected"]),
        (skipped, summary["frames_skipped"]),
        ("lost", summary["frames_lost"]),
        ("with poses", summary["frames_with_poses"]),
    ]
    rows += [
        ("results a second", show(summary["rate_hz"], "{:.1f}")),
        ("training, s", show(summary["train_seconds"], "{:.0f}")),
    ]
    if "clutter" in summary:
        found = summary["clutter"]
        rows += [
            ("clutter: frames", found["frames_processed"]),
            ("clutter: detections, all false", found["false_detections"]),
        ]
        rows += [("clutter: false detections a frame", show(found["false_per_frame"]))]
    return rows


def latency_rows(summary):
    return [
        (stage, *(show(found[p], "{:.1f}") for p in ("p50", "p95", "p99")))
        for stage, found in summary["latency_ms"].items()
    ]


def contact_sheet(folder):
    """Images spread evenly over the stream."""
    images = sorted(folder.glob("*.jpg"))
    count = len(images) if len(images) <= FEW else SPREAD
    return [embedded(images[round(i * (len(images) - 1) / max(count - 1, 1))], "jpeg") for i in range(count)]


def page(out, summary):
    stream = out / "stream"
    evaluation = read_json(stream / "evaluation" / "summary.json")
    return render(
        "demo/page.html",
        summary=summary,
        overlay=embedded(out / "overlay.png", "png"),
        followed=summary.get("followed"),
        followed_header=followed.HEADER,
        followed_objects=followed.object_rows(summary["followed"]) if "followed" in summary else [],
        followed_frames=followed.frame_rows(summary["followed"], summary["frames_sent"]) if "followed" in summary else [],
        objects=object_rows(summary),
        precision_recall=precision_recall_chart(read_csv(stream / "evaluation" / "curves.csv")),
        latencies=latency_chart(read_csv(stream / "frame_times.csv")),
        latency_rows=latency_rows(summary),
        frame_rows=frame_rows(summary),
        stage_rows=[(stage, show(ms, "{:.2f}")) for stage, ms in evaluation["stage_ms_median"].items()],
        images=contact_sheet(stream / "pictures"),
        clutter_images=contact_sheet(out / "clutter_stream" / "pictures") if "clutter" in summary else [],
        settings=json.dumps(summary["settings"], indent=2),
    )


def print_table(summary):
    if "followed" in summary:
        print(f"\nPoses of followed objects beside the truth\n{followed.words(summary['followed'], summary['frames_sent'])}")
    inspected, sent = summary["processed"], summary["frames_sent"]
    print(f"\nThe detector, in the {summary['frames_detected']} frames that it inspected; AUC over all {sent} beside, the others missed")
    print(f"{'object':<16}{'AUC':>8}{'poses right':>14}{'ADD-S recall':>14}{f'AUC of {sent}':>14}")
    for name, auc in inspected["auc"].items():
        recalls = (show(inspected[key].get(name)) for key in (RIGHT_RECALL, POSE_RECALL))
        cells = [*recalls, show(summary["auc"].get(name))]
        print(f"{name:<16}{show(auc):>8}" + "".join(f"{cell:>14}" for cell in cells))
    print(f"\n{'latency, ms':<16}{'p50':>8}{'p95':>8}{'p99':>8}")
    for stage, *latencies in latency_rows(summary):
        print(f"{stage:<16}" + "".join(f"{latency:>8}" for latency in latencies))
    print(
        "\nhs-detect: {frames_sent} frames sent = {frames_detected} inspected + {frames_skipped} {skipped} + {frames_lost} lost;"
        " {frames_with_poses} with poses; {rate_hz:.1f} results a second; trained in {train_seconds:.0f} s".format(
            skipped="left out, as meant" if "followed" in summary else "passed over", **summary
        )
    )
    if "clutter" in summary:
        print("clutter: {false_detections} detections, all false, on {frames_processed} frames: "
              "{false_per_frame} a frame".format(**summary["clutter"]))  # fmt: skip
    print(f"{summary['cpu']}; commit {summary['commit']}\n")


def write(options, store, sent):
    out = options.out
    summary = summarise(options, store, sent)
    write_json(out / "summary.json", summary)
    shutil.copyfile(out / "stream" / "overlay.mp4", out / "overlay.mp4")
    with Image.open(fullest_image(poses_by_frame(out / "stream" / "results.lcmlog"), out / "stream" / "pictures")) as image:
        image.save(out / "overlay.png")
    (out / "report.html").write_text(page(out, summary))
    print_table(summary)
    print(f"{out}/report.html, {out}/summary.json, {out}/overlay.png, {out}/overlay.mp4")
