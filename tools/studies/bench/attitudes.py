"""The figures of tools/bench attitudes, attitudes.json: the same meshes taught upright and taught as they come to rest, both in
scenes in which the objects lie, lean and are held, and in the scenes in which they stand."""

from studies.bop.figures import of_scenes
from studies.bop.plan import SceneFolders
from studies.command import TEST_SCENES
from studies.records import about, mean_of, read_json, rounded, write_json
from studies.report.page import show

LYING = ("table_lying", "meeting_lying", "table_tilted", "meeting_held")
GROUPS = {"lying": LYING, "standing": TEST_SCENES}
TAUGHT = {"upright": "taught upright", "resting": "taught as they come to rest"}  # hs-teach mesh --attitudes
FIGURES = ("auc", "ar", "precision", "recall", "published_right_fraction", "published_good_fraction", "ece_score",
           "ece_quality", "ms_detect_median", "ms_pose_median")  # fmt: skip


def scene_folders(out, taught, scene):
    folder = out / "attitudes" / taught / scene
    return SceneFolders(scene, folder / "ranked", folder / "default")


def figures(folders):
    found = of_scenes(folders)
    return {name: found[name] for name in FIGURES}


def summarise(out):
    """Returns figures by scene, and by group: AUC and AR are the means of its scenes', the others are of what was counted in
    all of them."""
    scenes = {name: {scene: figures([scene_folders(out, name, scene)]) for group in GROUPS.values() for scene in group}
              for name in TAUGHT}  # fmt: skip
    groups = {}
    for group, members in GROUPS.items():
        for name in TAUGHT:
            pooled = figures([scene_folders(out, name, scene) for scene in members])
            means = {key: mean_of(scenes[name][scene][key] for scene in members) for key in ("auc", "ar")}
            groups.setdefault(group, {})[name] = pooled | means
    standing = groups["standing"]
    seconds = read_json(out / "attitudes" / "teach_seconds.json")
    return {
        "groups": groups,
        "scenes": scenes,
        "auc_lost_standing": standing["upright"]["auc"] - standing["resting"]["auc"],
        "teach_seconds": seconds,
    }


def rows(summary):
    """The header first."""
    out = [("AUC, average recall of poses", *(words for words in TAUGHT.values()))]

    def cells(found):
        return (f"{show(found[name]['auc'])}, {show(found[name]['ar'])}" for name in TAUGHT)

    for group, members in GROUPS.items():
        for scene in members:
            out.append((scene, *cells({name: summary["scenes"][name][scene] for name in TAUGHT})))
        out.append((f"mean of what is {group}", *cells(summary["groups"][group])))
    return out


def default_rows(summary):
    """Returns rows of what is reported and published at the defaults; the header first."""
    header = ("at the defaults", "precision", "recall", "right, of published", "up to shape", "ECE score", "ECE quality",
              "ms detection", "ms poses")  # fmt: skip
    keys = FIGURES[2:]
    return [header] + [
        (f"{group}, {TAUGHT[name]}", *(show(found[key], "{:.1f}" if key.startswith("ms") else "{:.3f}") for key in keys))
        for group, by_name in summary["groups"].items()
        for name, found in by_name.items()
    ]


def words(summary):
    seconds = summary["teach_seconds"]
    taught = ", ".join(f"{TAUGHT[name]} {show(seconds[name], '{:.0f}')} s" for name in TAUGHT)
    lost = show(summary["auc_lost_standing"])
    return f"Standing objects lose {lost} of AUC beside the other attitudes. Teaching four objects: {taught}."


def write(out):
    summary = rounded(summarise(out)) | about("tools/bench attitudes")
    write_json(out / "attitudes.json", summary)
    for row in (*rows(summary), (), *default_rows(summary)):
        print("  ".join(f"{cell:<38}" for cell in row).rstrip())
    print(words(summary))
    print(out / "attitudes.json")
