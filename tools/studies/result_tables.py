"""The parts of RESULTS.md for each summary.json: tables and sentences, as Markdown. None where there is nothing to say."""

NOT_MEASURED = "not measured"


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


def demo_table(summary):
    names = list(summary["auc"])
    right, recall, processed = "mssd_recall", "pose_recall_add_s_10", summary["processed"]
    listed = []
    if "followed" in summary:
        for words, key in (("poses of followed objects: right", "right_fraction"),
                           ("objects in all frames with a right pose", "recall")):  # fmt: skip
            found = summary["followed"][key]
            listed.append((words, found | {"mean": found["all"]}))
    listed += [
        ("AUC, inspected frames alone", processed["auc"]),
        ("recall, inspected frames alone", processed["recall"]),
    ]
    if summary["bop19_ar"]:
        listed.append(("poses right, inspected frames alone", processed.get(right, {})))
        listed.append(("ADD-S recall, inspected frames alone", processed[recall]))
    listed += [("AUC, all frames", summary["auc"]), ("recall at the defaults, all frames", summary["recall"])]
    if summary["bop19_ar"]:
        listed += [
            ("poses right, all frames", summary.get(right, {})),
            ("ADD-S recall, all frames (right up to shape)", summary[recall]),
            ("BOP average recall", summary["bop19_ar"] | {"mean": summary["bop19_ar"]["all"]}),
        ]

    def cell(found, name):
        return "" if name == "mean" and name not in found else show(found.get(name))

    return table([("", *names), *((words, *(cell(found, name) for name in names)) for words, found in listed)])


def demo_frames(summary):
    latency = "; ".join(
        f"{stage} {ms(found['p50'])}, {ms(found['p99'])}" for stage, found in summary["latency_ms"].items()
    )
    followed = summary.get("followed")
    text = ("{frames_followed} frames followed, {frames_passed_over} passed over for newer ones, {frames_lost} lost. "
            "The detector: ").format(**followed) if followed else ""  # fmt: skip
    skipped = "not inspected, as meant" if followed else "passed over for newer ones"
    text += ("{frames_sent} frames sent, {frames_detected} detected, {frames_skipped} {skipped}, {frames_lost} "
             "lost; {frames_with_poses} with poses; {rate_hz:.1f} results a second; false detections at the "
             "defaults: {false_detections}; training {train_seconds:.0f} s. ").format(skipped=skipped, **summary)  # fmt: skip
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


def attitude_table(summary):
    from studies.bench import attitudes

    return table(attitudes.rows(summary))


def attitude_defaults(summary):
    from studies.bench import attitudes

    return table(attitudes.default_rows(summary))


def attitude_words(summary):
    from studies.bench import attitudes

    return attitudes.words(summary)


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
        ("", "ms a pose, median", "poses right", "ADD-S recall", "ADD(-S) recall", "AR",
         f"AR on {summary['rival_frames']} frames")  # fmt: skip
    ]

    def recalls(key):
        return tuple(show(summary.get(key.format(error))) for error in ("mssd", "add_s", "add"))

    ours = f"{show(summary['ms_per_pose_median'], '{:.2f}')} (99 %: {show(summary['ms_per_pose_p99'], '{:.2f}')})"
    rows.append(("ours, all detections from score 0.1 on", ours, *recalls("{}_recall"), show(summary["bop_ar"]),
                 show(summary["bop_ar_on_rival_frames"])))  # fmt: skip
    rows.append(("ours, detections from score 0.5 on", "", *recalls("{}_recall_from_0.5"), "", ""))
    rows.append(("PCL's point-to-plane ICP from the same starts", ms(summary["pcl_ms_median"]), *recalls("pcl_{}_recall"),
                 show(summary["bop_ar_pcl"]), ""))  # fmt: skip
    for name, words in (
        ("prerejective", "FPFH, prerejective sampling, ICP (PCL)"),
        ("ppf", "point pair features, ICP (OpenCV)"),
    ):
        rows.append((words, ms(summary[f"{name}_ms_median"]), "", "", "", "", show(summary[f"bop_ar_{name}"])))
    return table(rows)


def pose_words(summary):
    return (
        f"{summary['frames']} frames; of all published poses {show(summary.get('published_right_fraction'))} are right, "
        f"{show(summary['published_good_fraction'])} up to what the shape cannot tell; errors "
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


SEQUENCES = {
    "walk": "a camera walks round a table",
    "pushed": "objects are pushed",
    "carried": "carried by a hand",
    "removed": "taken away, brought back",
    "swapped": "swapped",
    "cans": "two equal cans",
    "arm": "an arm passes before them",
    "jerk": "the camera is pushed",
    "cameras": "three cameras",
}


def sequence_table(summary):
    header = ("", "frames", "recall", "precision", "switches", "HOTA", "standing: mm, 95 %", "within two deviations")
    rows = [header]
    for name, one in summary["sequences"].items():
        standing = one["error"]["standing"]
        errors = f"{show(standing['mm_median'], '{:.2f}')}, {show(standing['mm_p95'], '{:.2f}')}"
        rows.append((SEQUENCES[name], one["frames"], show(one["recall"]), show(one["precision"]), one["id_switches"],
                     show(one["hota"]), errors, show(standing["within_two_deviations"])))  # fmt: skip
    return table(rows)


def track_words(summary):
    jitter, cameras = summary["jitter"], summary["cameras"]
    text = (f"An object put into view is published within {show(summary['seconds_to_find'], '{:.2f}')} s, one taken away is gone "
            f"within {show(summary['seconds_to_gone'], '{:.2f}')} s. What stands jitters by {show(jitter['mm'], '{:.2f}')} mm and "
            f"{show(jitter['deg'], '{:.2f}')} degrees (deviation over 5 s). ")  # fmt: skip
    if cameras is not None:
        best = min(cameras["mm_median_alone"].values())
        text += (f"By three cameras the error is {show(cameras['mm_median'], '{:.2f}')} mm, by the best alone "
                 f"{show(best, '{:.2f}')} mm.")  # fmt: skip
    return text


def rate_table(summary):
    rows = [("camera", "to poses, ms: p50, p99", "to the world's objects, ms", "lost", "passed over", "cores in use")]
    for name in ("hz30", "hz60", "hz90"):
        one = summary.get(name)
        if one is None:
            continue
        rows.append((f"{name[2:]} Hz", f"{ms(one['p50_ms'])}, {ms(one['p99_ms'])}", f"{ms(one['objects_p50_ms'])}, "
                     f"{ms(one['objects_p99_ms'])}", one["lost"], show(one["skipped"]), show(one["cores"], "{:.2f}")))  # fmt: skip
    return table(rows) if len(rows) > 1 else None


def host_words(summary):
    hosts = summary.get("hosts")
    if not hosts:
        return None
    one, two, lost = hosts["one"]["world"], hosts["two"]["world"], hosts["lost"]
    return (f"Frame to the world's objects: {ms(one['p50_ms'])} ms (p50) with twenty objects on one host, {ms(two['p50_ms'])} ms "
            f"with forty on two. A host that goes away is said after {ms(lost['said_s'])} s; back, its objects are there after "
            f"{ms(lost['back_s'])} s.")  # fmt: skip


def shown_table(summary):
    """Returns of each object: the model beside the true mesh, and what is found by it beside what the true mesh finds."""
    header = ("", "mesh: mm, 95 %", "drift: mm, degrees", "masks' IoU", "AUC, of true mesh", "ADD-S, of true mesh", "verdict")
    rows = [header]
    for name, one in summary["objects"].items():
        rows.append((name, f"{show(one['mesh_mm_median'], '{:.2f}')}, {show(one['mesh_mm_95'], '{:.2f}')}",
                     f"{show(one['drift_mm'], '{:.2f}')}, {show(one['drift_deg'], '{:.2f}')}", show(one["mask_iou"]),
                     f"{show(one['auc'])}, {show(one['auc_true'])}", f"{show(one['add_s'])}, {show(one['add_s_true'])}",
                     one["verdict"]))  # fmt: skip
    return table(rows)


def household_table(summary):
    """Returns how well stores of several numbers of objects find them, and what they cost."""
    from studies.household import report

    return "\n\n".join(table(report.rows(columns, summary["by_number"])) for columns in (report.COLUMNS, report.COSTS))


def household_words(summary):
    return (f"{summary['rooms']} rooms, {summary['frames']} frames; {len(summary['taught'])} objects are taught, "
            f"{len(summary['strangers'])} never. {summary['alone']}")  # fmt: skip


def shown_words(summary):
    text = f"Frames are followed at {show(summary['tracking_hz'], '{:.0f}')} Hz."
    stream = summary["stream"]
    if stream is None:
        return text
    return text + (f" Taught while a stream went on: found {show(summary['seconds_to_found'], '{:.0f}')} s after the take's end; "
                   f"{stream['frames']} frames, {stream['lost']} lost, {stream['skipped']} passed over.")  # fmt: skip
