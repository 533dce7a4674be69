"""The output of tools/bench bop: summary.json, a file of poses for each set as BOP's tools read it, and the page."""

from studies.bop import figures
from studies.bop.figures import COUNTS, FIGURES
from studies.bop.plan import RANKED, Plan, target_count
from studies.command import step
from studies.records import about, rounded, threads, write_json
from studies.report.charts import Chart
from studies.report.page import embedded, render, show

TABLE = (  # key, words
    ("targets", "targets"), ("ar", "AR"), ("ar_nothing_withheld", "AR, nothing withheld"), ("auc", "AUC"),
    ("precision", "precision"), ("recall", "recall"), ("published_right_fraction", "right, of published"),
    ("published_good_fraction", "up to shape"),
    ("ece_score", "ECE score"), ("ece_quality", "ECE quality"), ("ece_quality_up_to_shape", "up to shape"), ("ms_detect_median", "ms detection"),
    ("ms_pose_median", "ms poses"),
)  # fmt: skip
RIVALS = (
    ("linemod_auc", "AUC, LINEMOD"), ("linemod_frames", "its frames"), ("ar_prerejective", "AR, prerejective"),
    ("ar_ppf", "AR, PPF"), ("ar_on_rival_frames", "AR, ours, nothing withheld"), ("rival_frames", "their frames"),
)  # fmt: skip
KEPT = (*FIGURES, *COUNTS, "ar_at_default")


def cell(key, value):
    if isinstance(value, int):
        return str(value)
    return show(value, "{:.2f}" if key.startswith("ms_") or key.endswith("seconds") else "{:.3f}")


def with_spread(figures, key):
    """The figure, and from where to where the seeds' figures reach."""
    text, spread = cell(key, figures[key]), figures.get("spread", {}).get(key)
    return f"{text} ({cell(key, spread[0])} to {cell(key, spread[1])})" if spread else text


def rows(figures_by_name, columns):
    return [(name, *(with_spread(figures, key) for key, _ in columns)) for name, figures in figures_by_name.items()]


def header(columns, first=""):
    return (first, *(words for _, words in columns))


def kept(run):
    """Returns the entry of summary.json for a run, or for one of its scenes."""
    out = {key: run[key] for key in KEPT}
    for key in ("spread", "calibration"):
        if key in run:
            out[key] = run[key]
    if "scenes" in run:
        out["scenes"] = {name: kept(scene) for name, scene in run["scenes"].items()}
    return out


def cut(options, run):
    """Returns what the rivals did not search for want of time, in words, or None."""
    if not options.rivals:
        return None
    told = [
        f"{words} looked at {run[key]} of {run['frames']} frames"
        for key, words in (("linemod_frames", "LINEMOD"), ("rival_frames", "prerejective and PPF"))
        if 0 < run[key] < run["frames"]
    ]
    return f"cut after {options.rivals_seconds:.0f} s: {', '.join(told)}" if told else None


def reliability(calibration, title):
    chart = Chart(("mean of what was said", 1.0), ("share that is right", 1.0), title)
    chart.dashes([(0, 0), (1, 1)])
    for name, found in calibration.items():
        if found:
            points = [(bin["mean_score"], bin["true_fraction"]) for bin in found["bins"]]
            chart.line(f"{name}, ECE {found['ece']:.3f}", points)
            chart.axes.lines[-1].set_marker("o")
            for bin in found["bins"]:
                chart.label(bin["mean_score"], bin["true_fraction"], str(bin["count"]))
    return chart.svg()


WORST = 4  # poses of a scene that are shown


def images(folders):
    """Returns of each scene what was missed or false, and the worst poses, by (words, images)."""
    out = []
    for scene in folders:
        if scene.failures:
            out.append((f"scene {scene.name}: missed (yellow) and false (red)", [embedded(scene.failures, "png")]))
        worst = (
            sorted(scene.poses.glob("worst_*.png"), key=lambda file: int(file.stem.split("_")[1]))
            if scene.poses
            else []
        )
        if worst:
            out.append(
                (
                    f"scene {scene.name}: the worst poses that were published",
                    [embedded(file, "png") for file in worst[:WORST]],
                )
            )
    return out


def page(summary, folders):
    """`folders`: of the first seed's scenes, by set."""
    sets = [
        {
            "name": name,
            "scenes": rows(run["scenes"], TABLE),
            "rivals": rows(run["scenes"], RIVALS) if summary["settings"]["rivals"] else [],
            "chart": reliability(run["calibration"], name) if any(run["calibration"].values()) else None,
            "cut": run["rivals_cut"],
            "unknown": run["unknown"],
            "images": images(folders[name]),
        }
        for name, run in summary["datasets"].items()
    ]
    taught = (*TABLE, ("teach_seconds", "teaching, s"))
    return render(
        "bop/page.html",
        summary=summary,
        sets=sets,
        header=header(TABLE, "scene"),
        rival_header=header(RIVALS, "scene"),
        glance_header=header(taught, "set"),
        glance=rows(summary["datasets"], taught),
        rivals_header=header(RIVALS, "set"),
        rivals=rows(summary["datasets"], RIVALS) if summary["settings"]["rivals"] else [],
    )


def glance(summary):
    """Returns the lines for the terminal."""
    lines = []
    for name, run in summary["datasets"].items():
        lines.append(f"{name}: " + ", ".join(f"{words} {with_spread(run, key)}" for key, words in TABLE))
        if summary["settings"]["rivals"]:
            lines.append("  rivals: " + ", ".join(f"{words} {cell(key, run[key])}" for key, words in RIVALS))
        if run["rivals_cut"]:
            lines.append("  " + run["rivals_cut"])
    return "\n".join(lines)


def settings(options, datasets):
    told = {key: getattr(options, key) for key in ("split", "every", "seeds", "rivals", "rivals_seconds")}
    told["objects"] = str(options.objects) if options.objects else None
    told["datasets"] = {dataset.name: str(dataset.root.resolve()) for dataset in datasets}
    told["threads"] = threads()
    told["ranked"] = " ".join(RANKED)
    told["measured"] = (
        "ar, ar_nothing_withheld, auc and ece: every detection, ranked; precision, recall, published_right_fraction, "
        "published_good_fraction (by ADD-S), ar_at_default and ms: as the programs run; rivals: the same boxes, score from 0.1"
    )
    return told


def summarise(options, datasets, folders, seconds, plan):
    out = {}
    for dataset in datasets:
        runs = [figures.of_run(folders[dataset.name, seed]) for seed in range(1, options.seeds + 1)]
        run = figures.over_seeds(runs)
        taught = [seconds.get((dataset.name, seed)) for seed in range(1, options.seeds + 1)]
        out[dataset.name] = {
            **{key: value for key, value in kept(run).items() if key != "scenes"},
            "teach_seconds": figures.mean_figure(taught),
            "targets_named": target_count(dataset),
            "rivals_cut": cut(options, run),
            "unknown": plan.unknown.get(dataset.name, []),
            "runs": [{key: one[key] for key in KEPT} for one in runs] if len(runs) > 1 else [],
            "scenes": kept(run)["scenes"],
        }
    return {"datasets": rounded(out), **about("tools/bench bop"), "settings": settings(options, datasets)}


def run(options):
    plan, datasets = Plan(options), options.datasets
    step("teach")
    taught, seconds = plan.teach(datasets)
    step("find and measure")
    folders = plan.measure(taught)
    step("report")
    summary = summarise(options, datasets, folders, seconds, plan)
    first = {dataset.name: folders[dataset.name, 1] for dataset in datasets}
    for name, scenes in first.items():
        figures.write_csv(scenes, options.out / f"{name}_bop19.csv")
    write_json(options.out / "summary.json", summary)
    (options.out / "report.html").write_text(page(summary, first))
    print(glance(summary))
    print(f"{options.out}/report.html, {options.out}/summary.json")
