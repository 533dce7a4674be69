"""The report as one HTML page that needs no network."""

import html
import json

import figures
import further_tables
import tables
import texts
from glance import glance
from html_parts import STYLE

MORE_STYLE = """
body { background: #fff; max-width: 1100px; } h1 { font-size: 2em; line-height: 1.2; } .lead { font-size: 1.1em; }
.about { color: #555; } figure { margin: 1em 0; } table { margin: 1em 0; } figcaption { color: #333; }
.charts.small figure { flex: 0 1 calc(33% - .7em); margin: .5em 0; } .small svg text { font-size: 16px; }
.charts.half figure { flex: 0 1 calc(50% - .5em); } svg .value { font-size: 10.5px; }
figure img { border: 1px solid #ddd; }
.paper { background: #faf6ee; border-left: 4px solid #d55e00; padding: .4em 1em; } .gap { color: #a33; }
.missing { columns: 2; font-size: 13px; }
@media (max-width: 800px) { .charts.half figure, .charts.small figure { flex: 1 1 100%; } }
"""


def section(name, *content):
    """A figure, what it shows, and what the paper says of the same."""
    title, says, in_paper = texts.SECTIONS[name]
    body = "".join(part for part in content if part) or '<p class="gap">Not measured in this run.</p>'
    note = f'<p class="paper"><b>Paper:</b> {html.escape(in_paper)}</p>' if in_paper else ""
    return f"<h2>{html.escape(title)}</h2><p>{html.escape(says)}</p>{note}{body}"


def side_by_side(*content):
    return f'<div class="charts half">{"".join(content)}</div>'


def about(settings):
    """What ran, how far, and where."""
    runs = "one training run" if settings["quick"] else "five training runs (kernels, scales and strides: one), 60 frames"
    if settings["units_done"] < settings["units"]:
        runs += f"; so far {settings['units_done']} of {settings['units']} units of work"
    work = f"{settings['dataset']} data, {runs}, {settings['hours']:.1f} h of work"
    return f"{settings['command']}; {work}; {settings['cpu']}; commit {settings['commit']}"


def quickly(settings):
    """What a quick run does less."""
    if not settings["quick"]:
        return ""
    words = {**figures.FEATURE_NAMES, **texts.LEFT_OUT}
    names = "; ".join(words[name].removeprefix("+ ") for name in settings["left_out"])
    return f"<p>{html.escape(texts.QUICK)} Left out: {html.escape(names)}.</p>"


def head(settings):
    return (
        "<!doctype html><html lang=en><meta charset=utf-8><title>Houghstream: the paper's comparison, repeated</title>"
        f"<style>{STYLE}{MORE_STYLE}</style><h1>{html.escape(texts.TITLE)}</h1>"
        f'<p class="lead">{html.escape(texts.LEAD)}</p><p class="about">{html.escape(about(settings))}</p>'
    )


def study_sections(summary, results):
    return [
        section("features curves", figures.feature_curves(results)),
        section("features", figures.feature_bars(results), tables.features(results)),
        section("hough", figures.hough_spaces(results)),
        section("normalisation", figures.depth_normalisation(results), tables.depth_normalisation(summary)),
        section("stride", side_by_side(figures.stride_chart(summary["stride"]), tables.strides(summary))),
        section("final", figures.final_bars(results), tables.final(summary)),
    ]


def further_sections(summary, results):
    found = summary["reliability"]
    return [
        section("time", tables.timings(summary)),
        *([] if "objects_20" in results.left_out else [section("twenty", further_tables.twenty(summary))]),
        section("real", further_tables.real(summary)),
        section(
            "reliability", side_by_side(figures.reliability_chart(found["bins"]), further_tables.reliability(found))
        ),
        section("failures", further_tables.failures(results), figures.failures(results)),
    ]


def render(summary, results):
    missing = "".join(f"<li>{html.escape(path)}</li>" for path in summary["missing"])
    parts = [head(summary["settings"]), "<h2>At a glance</h2>", glance(summary)]
    parts.append(f"<h2>How it was measured</h2><p>{html.escape(texts.PROTOCOL)}</p>{quickly(summary['settings'])}")
    parts += study_sections(summary, results) + further_sections(summary, results)
    parts += [f'<h2>Not measured</h2><ul class="missing">{missing}</ul>'] if missing else []
    parts += [f"<h2>Settings</h2><pre>{html.escape(json.dumps(summary['settings'], indent=2))}</pre></html>"]
    return "\n".join(parts)
