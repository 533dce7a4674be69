"""What the reports have in common: their style, tables, pictures inside the page."""

import base64
import html

STYLE = """
body { font: 15px/1.5 sans-serif; max-width: 1180px; margin: 2em auto; padding: 0 1em; color: #222; }
h1 { margin-bottom: 0; } h2 { margin-top: 2em; border-bottom: 1px solid #ddd; }
img, video { max-width: 100%; border-radius: 4px; }
table { border-collapse: collapse; } td, th { padding: .2em 1em .2em 0; text-align: right; border-bottom: 1px solid #eee; }
td:first-child, th:first-child { text-align: left; }
.charts, .sheet { display: flex; flex-wrap: wrap; gap: 1em; } .charts { align-items: flex-start; } .charts figure { flex: 1 1 480px; margin: 0; }
.sheet img { width: calc(50% - .5em); } svg { width: 100%; } svg text { font-size: 12px; fill: #444; }
.grid { stroke: #e4e4e4; } .whisker { stroke: #222; stroke-width: 1.2; } figcaption span { margin-right: 1.2em; display: inline-block; }
figcaption i { display: inline-block; width: .8em; height: .8em; margin-right: .4em; border-radius: 2px; }
pre { background: #f6f6f6; padding: 1em; overflow-x: auto; font-size: 13px; }
"""


def embedded(file, kind):
    data = base64.b64encode(file.read_bytes()).decode()
    return f'<img alt="{html.escape(file.name)}" src="data:image/{kind};base64,{data}">'


def table(header, rows):
    def row(cells, tag):
        return "<tr>" + "".join(f"<{tag}>{html.escape(str(cell))}</{tag}>" for cell in cells) + "</tr>"

    return "<table>" + row(header, "th") + "".join(row(cells, "td") for cells in rows) + "</table>"


def show(value, form="{:.3f}"):
    return "–" if value is None else form.format(value)
