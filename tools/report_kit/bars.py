"""Bar charts as inline SVG: groups side by side, or named rows with a mark for comparison."""

import html

from charts import COLOURS, figure, nice_step, upright

WIDTH, HEIGHT = 1000, 300
LEFT, RIGHT, TOP, BOTTOM = 56, 12, 20, 34
ROW, NAME_WIDTH, VALUE_WIDTH = 26, 220, 200


def text(x, y, words, anchor="middle"):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{html.escape(words)}</text>'


def rectangle(x, y, width, height, colour):
    return f'<rect x="{x:.1f}" y="{y:.1f}" width="{width:.1f}" height="{max(height, 0.0):.1f}" fill="{colour}"/>'


def line(kind, x1, y1, x2, y2):
    return f'<line class="{kind}" x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}"/>'


def ticks(size):
    step = nice_step(size)
    return [i * step for i in range(int(size / step + 1e-6) + 1)]


class GroupedBars:
    """One group a name; each series has one value for every group, None where there is none."""

    def __init__(self, groups, y_label, y_max=1.0, width=WIDTH, title=""):
        self.groups, self.y_label, self.y_max, self.width, self.title = groups, y_label, y_max, width, title
        self.series = []

    def add(self, name, values, spreads=None, colour=None):
        """`spreads`: (low, high) for each group, or None."""
        self.series.append((name, values, spreads or [None] * len(values), colour or COLOURS[len(self.series)]))

    def _y(self, value):
        return HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * min(value, self.y_max) / self.y_max

    def _axis(self):
        parts = []
        for value in ticks(self.y_max):
            parts += [
                line("grid", LEFT, self._y(value), self.width - RIGHT, self._y(value)),
                text(LEFT - 6, self._y(value) + 4, f"{value:g}", "end"),
            ]
        return parts + [upright(14, (TOP + HEIGHT - BOTTOM) / 2, self.y_label)]

    def _bar(self, x, width, value, spread, colour):
        if value is None:
            return [text(x + width / 2, HEIGHT - BOTTOM - 3, "–")]
        top = self._y(value)
        parts = [rectangle(x, top, width, HEIGHT - BOTTOM - top, colour)]
        high = top
        if spread and spread[0] != spread[1]:
            high = self._y(spread[1])
            parts.append(line("whisker", x + width / 2, self._y(spread[0]), x + width / 2, high))
        words = f"{value:.2f}".lstrip("0")  # .95: bars are narrower than 0.95
        return parts + [
            f'<text class="value" x="{x + width / 2:.1f}" y="{high - 4:.1f}" text-anchor="middle">{words}</text>'
        ]

    def svg(self):
        parts = self._axis()
        slot = (self.width - LEFT - RIGHT) / max(len(self.groups), 1)
        width = min(0.84 * slot / max(len(self.series), 1), 46)
        for g, group in enumerate(self.groups):
            begin = LEFT + (g + 0.5) * slot - width * len(self.series) / 2
            for s, (_, values, spreads, colour) in enumerate(self.series):
                parts += self._bar(begin + s * width, width - 2, values[g], spreads[g], colour)
            parts.append(text(LEFT + (g + 0.5) * slot, HEIGHT - BOTTOM + 18, group))
        return figure(self.width, HEIGHT, parts, [(name, colour) for name, _, _, colour in self.series], self.title)


def row_bars(rows, x_label, ours, theirs, x_max=1.0):
    """rows: (name, value, (low, high) or None, mark), each value or mark None where unknown."""
    height = len(rows) * ROW + 44
    scale = (WIDTH - NAME_WIDTH - VALUE_WIDTH) / x_max
    parts = []
    for value in ticks(x_max):
        x = NAME_WIDTH + value * scale
        parts += [line("grid", x, 4, x, height - 40), text(x, height - 24, f"{value:g}")]
    for i, (name, value, spread, mark) in enumerate(rows):
        parts += row_bar(name, value, spread, mark, i * ROW + 6, scale)
    parts.append(text(NAME_WIDTH + x_max * scale / 2, height - 6, x_label))
    return figure(WIDTH, height, parts, [(ours, COLOURS[4]), (theirs, COLOURS[3])])


def row_bar(name, value, spread, mark, top, scale):
    middle = top + ROW / 2 - 2
    parts = [text(NAME_WIDTH - 8, middle + 4, name, "end")]
    words = "not measured" if value is None else f"{value:.3f}"
    if value is not None:
        parts.append(rectangle(NAME_WIDTH, top, value * scale, ROW - 7, COLOURS[4]))
    if spread and spread[0] != spread[1]:
        parts.append(line("whisker", NAME_WIDTH + spread[0] * scale, middle, NAME_WIDTH + spread[1] * scale, middle))
    if mark is not None:
        x = NAME_WIDTH + mark * scale
        parts.append(f'<path d="M {x:.1f} {top - 3} v {ROW - 1}" stroke="{COLOURS[3]}" stroke-width="4"/>')
        words += f" (paper {mark:.3f})"
    return parts + [text(WIDTH - VALUE_WIDTH + 8, middle + 4, words, "start")]
