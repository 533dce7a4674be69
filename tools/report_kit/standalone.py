"""A figure of a report as an SVG file of its own, with its title and its legend drawn in."""

import html
import re

STYLE = (
    "text { font: 12px sans-serif; fill: #444; } .value { font-size: 10.5px; } "
    ".grid { stroke: #e4e4e4; } .whisker { stroke: #222; stroke-width: 1.2; } .title { font-weight: bold; }"
)
TITLE_HEIGHT, LEGEND_HEIGHT = 24, 26
LETTER_WIDTH, SWATCH_WIDTH = 6.4, 34  # pixels that a letter of the legend takes, and a name's colour with its margins


def legend(names, y):
    """`names`: (colour, name) in one row."""
    parts, x = [], 56.0
    for colour, name in names:
        parts.append(f'<rect x="{x:.0f}" y="{y - 9}" width="10" height="10" fill="{colour}"/>')
        parts.append(f'<text x="{x + 15:.0f}" y="{y}">{name}</text>')
        x += SWATCH_WIDTH + LETTER_WIDTH * len(html.unescape(name))
    return "".join(parts)


def standalone(figure):
    """`figure`: HTML as charts.figure makes it."""
    width, height, drawing = re.search(r'<svg viewBox="0 0 (\S+) (\S+)">(.*?)</svg>', figure, re.S).groups()
    title = re.search(r"<b>(.*?)</b>", figure)
    names = re.findall(r'<i style="background:(.*?)"></i>(.*?)</span>', figure)
    top = TITLE_HEIGHT if title else 0
    whole = int(height) + top + LEGEND_HEIGHT
    heading = f'<text class="title" x="56" y="16">{title.group(1)}</text>' if title else ""
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {whole}" width="{width}">'
        f'<style>{STYLE}</style><rect width="100%" height="100%" fill="#fff"/>{heading}'
        f'<g transform="translate(0 {top})">{drawing}</g>{legend(names, whole - 10)}</svg>\n'
    )
