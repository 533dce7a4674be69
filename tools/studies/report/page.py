"""Pages as single files that need no network: templates of this package, with tables and images inside them."""

import base64
import pathlib

import jinja2
from markupsafe import Markup, escape

PACKAGE = pathlib.Path(__file__).resolve().parent.parent


def embedded(file, kind):
    data = base64.b64encode(file.read_bytes()).decode()
    return Markup(f'<img alt="{escape(file.name)}" src="data:image/{kind};base64,{data}">')


def figure(svg, caption=""):
    """A chart; as an image of its own, so that two charts' names inside them cannot mix."""
    data = base64.b64encode(svg.encode()).decode()
    below = f"<figcaption>{escape(caption)}</figcaption>" if caption else ""
    return Markup(f'<figure><img class="chart" alt="chart" src="data:image/svg+xml;base64,{data}">{below}</figure>')


def image(file, caption):
    return Markup(f"<figure>{embedded(file, 'png')}<figcaption>{escape(caption)}</figcaption></figure>")


def table(header, rows):
    def row(cells, tag):
        return "<tr>" + "".join(f"<{tag}>{escape(cell)}</{tag}>" for cell in cells) + "</tr>"

    return Markup("<table>" + row(header, "th") + "\n".join(row(cells, "td") for cells in rows) + "</table>")


def show(value, form="{:.3f}"):
    return "–" if value is None else form.format(value)


def percent(value):
    if value is None:
        return "–"
    rounded = round(100.0 * value)
    return f"{rounded:+d} %".replace("-", "−") if rounded else "0 %"


def milliseconds(value):
    return "–" if value is None else f"{value / 1e3:.2f} s" if value >= 2000.0 else f"{value:.1f} ms"


def render(template, **values):
    """`template`: its path below tools/studies. A value that the template misses is an error."""
    loader = jinja2.FileSystemLoader(PACKAGE)
    environment = jinja2.Environment(loader=loader, autoescape=True, undefined=jinja2.StrictUndefined,
                                     trim_blocks=True, lstrip_blocks=True)  # fmt: skip
    environment.globals.update(figure=figure, image=image, show=show, table=table)
    return environment.get_template(template).render(**values)
