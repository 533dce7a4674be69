"""The steps of tools/reproduce: runs the units of the comparison and writes its report."""

import dataclasses
import json

from studies.command import die
from studies.records import commit_name, cpu_name, rounded, today, write_atomically
from studies.report.page import image, render
from studies.reproduce import figures, tables
from studies.reproduce.plan import Protocol, make_plan, quick
from studies.reproduce.results import Results
from studies.reproduce.summary import summarise
from studies.reproduce.variants import LEFT_OUT_NAMES
from studies.unit_runner import Runner, Store, with_inputs

HOUGH = {"hough/before.png": "RGB features", "hough/after.png": "with depth value, derivatives and HoG"}
FAILURES = {"failures/realtime.png": "The gravest of each scene; red: false, yellow: not found"}


def words_of(values):
    """One of them, or from the first to the last; in order."""
    known = sorted(set(values))
    return " to ".join(dict.fromkeys([known[0], known[-1]]))


def drawings(summary, results):
    """The figures that stand in RESULTS.md too, by name."""
    return {
        "features": figures.feature_bars(results),
        "final": figures.final_bars(results),
        "stride": figures.stride_chart(summary["stride"]),
        "reliability": figures.reliability_chart(summary["reliability"]["bins"]),
    }


def page(summary, results, drawn):
    def images(captions):
        made = {unit.name: results.store.file(unit) for unit in results.units}
        return [image(made[name], caption) for name, caption in captions.items() if name in made]

    settings = summary["settings"]
    return render(
        "reproduce/page.html",
        summary=summary,
        left_out=[LEFT_OUT_NAMES[name].removeprefix("+ ") for name in settings["left_out"]],
        glance=tables.glance(summary),
        feature_curves=figures.feature_curves(results),
        feature_bars=drawn["features"],
        features=tables.feature_rows(summary, settings["left_out"]),
        hough=images(HOUGH),
        depth_normalisation_charts=figures.depth_normalisation(results),
        depth_normalisation=tables.depth_normalisation(summary),
        stride_chart=drawn["stride"],
        strides=tables.strides(summary),
        final_bars=drawn["final"],
        final=tables.final(summary),
        timings=tables.timings(summary),
        other_sensor=tables.other_sensor(summary),
        twenty=tables.twenty(summary),
        real=tables.real(summary),
        reliability_chart=drawn["reliability"],
        reliability=tables.reliability(summary["reliability"]),
        failures=tables.failures(results),
        failure_images=images(FAILURES),
    )


class Reproduction:
    def __init__(self, options, programs):
        protocol = dataclasses.replace(Protocol(), threads=options.threads)
        self.options = options
        self.protocol = quick(protocol) if options.quick else protocol
        self.units = make_plan(options.dataset, options.folder, options.real, self.protocol)
        self.store = Store(options.out, programs, self.units)
        self.store.require_programs()

    def print_list(self):
        for unit in self.units:
            state = "done" if self.store.is_current(unit) else "to do"
            print(f"{state:<6} {unit.name}  (figure {'; '.join(unit.figures)})\n         {' '.join(unit.command)}")

    def work(self):
        chosen = with_inputs(self.units, [unit for unit in self.units if unit.name.startswith(self.options.only)])
        if not chosen:
            die(f"--only {self.options.only}: no unit's name begins so, see --list")
        if self.options.fresh:
            for unit in chosen:
                self.store.forget(unit)
        if not self.options.report:
            Runner(self.store).run(chosen)
        self.write_report()

    def command_in_words(self):
        dataset = [] if self.options.dataset == "rendered" else ["--dataset", f"{self.options.dataset}:DIR"]
        return " ".join(["tools/reproduce", *(["--quick"] if self.options.quick else []), *dataset])

    def settings(self):
        """Returns the settings of the units that are current: programs that differ have made them anew, so that all are of this
        commit."""
        done = [self.store.record(unit) for unit in self.units if self.store.is_current(unit)]
        return {
            "command": self.command_in_words(),
            "dataset": self.options.dataset,
            "quick": self.options.quick,
            "left_out": list(self.protocol.left_out),
            "threads": self.options.threads,
            "commit": commit_name(),
            "cpu": words_of(record.get("cpu", "") for record in done) if done else cpu_name(),
            "date": words_of(record.get("date", "") for record in done) if done else today(),
            "units": len(self.units),
            "units_done": len(done),
            "hours": sum(record.get("seconds", 0.0) for record in done) / 3600.0,
        }

    def write_report(self):
        out = self.options.out
        results = Results(self.store, self.units, self.protocol.left_out)
        summary = {**summarise(results), "settings": self.settings()}
        write_atomically(out / "results.csv", results.csv())
        write_atomically(out / "results.json", results.json())
        write_atomically(out / "summary.json", json.dumps(rounded(summary), indent=2) + "\n")
        drawn = drawings(summary, results)
        write_atomically(out / "report.html", page(summary, results, drawn))
        for folder in [out / "pictures"] + ([self.options.pictures] if self.options.pictures else []):
            for name, drawing in drawn.items():
                if drawing:
                    write_atomically(folder / f"{name}.svg", drawing)
        print(f"{out}/report.html, summary.json, results.csv, results.json")
        if summary["missing"]:
            print(f"{len(summary['missing'])} figures are missing, named in summary.json")
