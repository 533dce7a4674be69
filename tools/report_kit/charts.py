"""Line and dot charts as inline SVG, without any library."""

import html

# Okabe and Ito (2008): colours that stay apart for colour-blind eyes.
COLOURS = ["#e69f00", "#56b4e9", "#009e73", "#d55e00", "#0072b2", "#cc79a7", "#a09000", "#666666"]
WIDTH, HEIGHT = 560, 340
LEFT, RIGHT, TOP, BOTTOM = 56, 12, 12, 44


def nice_step(span, most_ticks=6):
    """The smallest of 1, 2, 5 times a power of ten that divides the span into at most `most_ticks`."""
    step = 1e-9
    while True:
        for factor in (1, 2, 5):
            if span / (step * factor) <= most_ticks:
                return step * factor
        step *= 10


class Chart:
    """Axes from (0, 0) to (x_max, y_max); series are added, then the text of the SVG is taken."""

    def __init__(self, x_label, y_label, x_max, y_max):
        self.x_max, self.y_max = max(x_max, 1e-9), max(y_max, 1e-9)
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
        self.parts.append(f'<text x="{(LEFT + WIDTH) / 2}" y="{HEIGHT - 8}" text-anchor="middle">{html.escape(x_label)}</text>')
        middle = (TOP + HEIGHT - BOTTOM) / 2
        self.parts.append(
            f'<text x="14" y="{middle}" text-anchor="middle" transform="rotate(-90 14 {middle})">{html.escape(y_label)}</text>'
        )

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

    def line(self, name, points):
        path = " ".join(f"{self._x(x):.1f},{self._y(min(y, self.y_max)):.1f}" for x, y in points)
        self.parts.append(f'<polyline fill="none" stroke-width="2" stroke="{self._next_colour(name)}" points="{path}"/>')

    def dots(self, name, points):
        colour = self._next_colour(name)
        for x, y in points:
            cy = self._y(min(y, self.y_max))
            self.parts.append(f'<circle cx="{self._x(x):.1f}" cy="{cy:.1f}" r="2" fill="{colour}"/>')

    def svg(self):
        legend = "".join(
            f'<span><i style="background:{colour}"></i>{html.escape(name)}</span>' for name, colour in self.legend
        )
        return f'<figure><svg viewBox="0 0 {WIDTH} {HEIGHT}">{"".join(self.parts)}</svg><figcaption>{legend}</figcaption></figure>'
