"""Line and dot charts as inline SVG, without any library."""

import html

# Okabe and Ito (2008): colours that stay apart for colour-blind eyes.
COLOURS = ["#e69f00", "#56b4e9", "#009e73", "#d55e00", "#0072b2", "#cc79a7", "#a09000", "#666666"]
WIDTH, HEIGHT = 560, 340
LEFT, RIGHT, TOP, BOTTOM = 56, 12, 22, 44
CHARACTER = 7  # width of a figure in the text


def nice_step(span, most_ticks=6):
    """The smallest of 1, 2, 5 times a power of ten that divides the span into at most `most_ticks`."""
    step = 1e-9
    while True:
        for factor in (1, 2, 5):
            if span / (step * factor) <= most_ticks:
                return step * factor
        step *= 10


def thinned(points, least_px=0.7):
    """Without the points that could not be told from the one before; the last one stays."""
    kept = []
    for point in points[:-1]:
        if not kept or max(abs(point[0] - kept[-1][0]), abs(point[1] - kept[-1][1])) >= least_px:
            kept.append(point)
    return kept + points[-1:]


def upright(x, y, words):
    """Text that is read from below, centred at (x, y)."""
    place = f'x="{x}" y="{y}" text-anchor="middle" transform="rotate(-90 {x} {y})"'
    return f"<text {place}>{html.escape(words)}</text>"


def figure(width, height, parts, legend, title=""):
    """The drawing with its title above and the legend's (name, colour) below."""
    heading = f"<b>{html.escape(title)}</b>" if title else ""
    names = "".join(f'<span><i style="background:{colour}"></i>{html.escape(name)}</span>' for name, colour in legend)
    drawing = f'<svg viewBox="0 0 {width} {height}">{"".join(parts)}</svg>'
    return f"<figure>{heading}{drawing}<figcaption>{names}</figcaption></figure>"


class Chart:
    """Axes from (0, 0) to (x_max, y_max); series are added, then the text of the SVG is taken."""

    def __init__(self, x_label, y_label, x_max, y_max, title=""):
        self.x_max, self.y_max = max(x_max, 1e-9), max(y_max, 1e-9)
        self.title = title
        self.parts = []
        self.legend = []
        self._axes(x_label, y_label)

    def _x(self, value):
        return LEFT + (WIDTH - LEFT - RIGHT) * value / self.x_max

    def _y(self, value):
        return HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * value / self.y_max

    def _axes(self, x_label, y_label):
        for size, place in ((self.x_max, self._x_tick), (self.y_max, self._y_tick)):
            step = nice_step(size)
            for i in range(int(size / step + 1e-6) + 1):
                place(i * step)
        self.parts.append(
            f'<text x="{(LEFT + WIDTH) / 2}" y="{HEIGHT - 8}" text-anchor="middle">{html.escape(x_label)}</text>'
        )
        self.parts.append(upright(14, (TOP + HEIGHT - BOTTOM) / 2, y_label))

    def _x_tick(self, value):
        x = self._x(value)
        self.parts.append(f'<line class="grid" x1="{x:.1f}" y1="{TOP}" x2="{x:.1f}" y2="{HEIGHT - BOTTOM}"/>')
        self.parts.append(f'<text x="{x:.1f}" y="{HEIGHT - BOTTOM + 16}" text-anchor="middle">{value:g}</text>')

    def _y_tick(self, value):
        y = self._y(value)
        self.parts.append(f'<line class="grid" x1="{LEFT}" y1="{y:.1f}" x2="{WIDTH - RIGHT}" y2="{y:.1f}"/>')
        self.parts.append(f'<text x="{LEFT - 6}" y="{y + 4:.1f}" text-anchor="end">{value:g}</text>')

    def _next_colour(self, name):
        colour = COLOURS[len(self.legend) % len(COLOURS)]
        self.legend.append((name, colour))
        return colour

    def _path(self, points, style):
        path = " ".join(
            f"{x:.1f},{y:.1f}" for x, y in thinned([(self._x(x), self._y(min(y, self.y_max))) for x, y in points])
        )
        self.parts.append(f'<polyline fill="none" {style} points="{path}"/>')

    def line(self, name, points, others=()):
        """`others`: lines of the same series, drawn faintly below."""
        colour = self._next_colour(name)
        for other in others:
            self._path(other, f'stroke-width="1" stroke-opacity="0.4" stroke="{colour}"')
        self._path(points, f'stroke-width="2" stroke="{colour}"')

    def dashes(self, points):
        """A line for comparison, outside of the legend."""
        self._path(points, 'stroke-width="1" stroke-dasharray="5 4" stroke="#888"')

    def dots(self, name, points, radius=2):
        colour = self._next_colour(name)
        for x, y in points:
            cy = self._y(min(y, self.y_max))
            self.parts.append(f'<circle cx="{self._x(x):.1f}" cy="{cy:.1f}" r="{radius}" fill="{colour}"/>')

    def whisker(self, x, low, high):
        at = f'x1="{self._x(x):.1f}" x2="{self._x(x):.1f}"'
        self.parts.append(f'<line class="whisker" {at} y1="{self._y(low):.1f}" y2="{self._y(high):.1f}"/>')

    def label(self, x, y, text):
        """Beside a point: on its right, or on its left where the text would leave the drawing."""
        at = self._x(x)
        fits = at + 7 + CHARACTER * len(text) <= WIDTH
        place = f'x="{at + 7:.1f}"' if fits else f'x="{at - 7:.1f}" text-anchor="end"'
        self.parts.append(f'<text {place} y="{self._y(y) - 6:.1f}">{html.escape(text)}</text>')

    def svg(self):
        return figure(WIDTH, HEIGHT, self.parts, self.legend, self.title)
