"""Charts as SVG texts, drawn by matplotlib in one style."""

import io

import matplotlib
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

# Okabe and Ito (2008): colours that stay apart for colour-blind eyes.
COLOURS = ["#e69f00", "#56b4e9", "#009e73", "#d55e00", "#0072b2", "#cc79a7", "#a09000", "#666666"]
DARK, GREY, PALE = "#222222", "#888888", "#e4e4e4"
STYLE = {
    "font.size": 9, "axes.titlesize": 10, "axes.titleweight": "bold", "axes.edgecolor": GREY, "axes.grid": True,
    "axes.axisbelow": True, "axes.spines.top": False, "axes.spines.right": False, "grid.color": PALE,
    "legend.frameon": False, "legend.fontsize": 9, "text.color": "#444444", "axes.labelcolor": "#444444",
    "text.parse_math": False, "svg.fonttype": "none", "svg.hashsalt": "houghstream",
}  # fmt: skip
NARROW, WIDE = (5.6, 3.6), (10.0, 3.6)  # inches


class Drawing:
    """Axes of one figure, and their SVG."""

    def __init__(self, size=NARROW, title=""):
        with matplotlib.rc_context(STYLE):
            self.figure = Figure(figsize=size, layout="constrained")
            self.axes = self.figure.subplots()
            self.axes.set_title(title, loc="left")
            self.axes.tick_params(length=0)

    def _legend(self):
        """Below the axes, in as many columns as names fit beside each other."""
        handles, names = self.axes.get_legend_handles_labels()
        if names:
            letters = self.figure.get_figwidth() * 15
            columns = max(1, min(len(names), int(letters / (max(map(len, names)) + 8))))
            below = -0.62 / self.figure.get_figheight()
            self.axes.legend(handles, names, loc="upper center", bbox_to_anchor=(0.5, below), ncol=columns)

    def svg(self):
        with matplotlib.rc_context(STYLE):
            self._legend()
            text = io.StringIO()
            self.figure.savefig(text, format="svg", metadata={"Date": None})
        return text.getvalue()


class Chart(Drawing):
    """Axes from (0, 0) on; series are added, each in the next colour."""

    def __init__(self, x, y, title="", size=NARROW):
        """`x`, `y`: (label, largest value)."""
        super().__init__(size, title)
        (x_label, x_max), (y_label, y_max) = x, y
        self.axes.set(xlabel=x_label, ylabel=y_label, xlim=(0.0, max(x_max, 1e-9)), ylim=(0.0, max(y_max, 1e-9)))
        for axis in (self.axes.xaxis, self.axes.yaxis):
            axis.set_major_locator(MaxNLocator(6, steps=[1, 2, 5, 10]))
        self.count = 0

    def _next_colour(self):
        self.count += 1
        return COLOURS[(self.count - 1) % len(COLOURS)]

    def line(self, name, points, others=()):
        """`others`: lines of the same series, drawn faintly."""
        colour = self._next_colour()
        for other in others:
            self.axes.plot(*zip(*other), color=colour, linewidth=0.8, alpha=0.4)
        self.axes.plot(*zip(*points), color=colour, linewidth=1.6, label=name)

    def dashes(self, points):
        """A line for comparison, outside of the legend."""
        self.axes.plot(*zip(*points), color=GREY, linewidth=0.8, linestyle=(0, (5, 4)))

    def dots(self, name, points, radius=1.5):
        colour = self._next_colour()
        self.axes.plot([x for x, _ in points], [y for _, y in points], "o", color=colour, markersize=2 * radius,
                       markeredgewidth=0, label=name, clip_on=False)  # fmt: skip

    def whisker(self, x, low, high):
        self.axes.plot([x, x], [low, high], color=DARK, linewidth=0.9)

    def label(self, x, y, text):
        """Beside a point: on its right, or on its left in the right part of the drawing."""
        right = x < 0.85 * self.axes.get_xlim()[1]
        self.axes.annotate(text, (x, y), (5 if right else -5, 5), textcoords="offset points", fontsize=8,
                           ha="left" if right else "right", annotation_clip=False)  # fmt: skip


def grouped_bars(groups, series, y_label, title="", size=WIDE):
    """One group a name. `series`: (name, colour or None, values, spreads), the latter two one a group; a value is None
    where there is none, a spread is (low, high) or None."""
    drawing = Drawing(size, title)
    axes = drawing.axes
    width = 0.84 / max(len(series), 1)
    for s, (name, colour, values, spreads) in enumerate(series):
        places = [g + (s - (len(series) - 1) / 2) * width for g in range(len(groups))]
        axes.bar(places, [value or 0.0 for value in values], 0.94 * width, color=colour or COLOURS[s], label=name)
        for place, value, spread in zip(places, values, spreads):
            top = draw_spread(axes, place, spread) if value is not None else 0.0
            words = "–" if value is None else f"{value:.2f}".lstrip("0")  # .95: bars are narrower than 0.95
            axes.annotate(words, (place, max(value or 0.0, top)), (0, 2), textcoords="offset points", ha="center",
                          fontsize=7)  # fmt: skip
    axes.set(ylabel=y_label, ylim=(0.0, 1.04), xticks=range(len(groups)))
    axes.set_xticklabels(groups)
    axes.grid(axis="x", visible=False)
    return drawing.svg()


def draw_spread(axes, place, spread):
    """Draws a bar from the worst to the best; returns its upper end."""
    if not spread or spread[0] == spread[1]:
        return 0.0
    axes.plot([place, place], spread, color=DARK, linewidth=0.9)
    return spread[1]


def row_bars(rows, x_label, ours, theirs):
    """rows: (name, value, (low, high) or None, mark), from the top; each value or mark None where unknown."""
    drawing = Drawing((10.0, 0.26 * len(rows) + 1.1))
    axes = drawing.axes
    places = range(len(rows))
    axes.barh(places, [row[1] or 0.0 for row in rows], 0.72, color=COLOURS[4], label=ours)
    marks = [(place, row[3]) for place, row in zip(places, rows) if row[3] is not None]
    axes.plot([mark for _, mark in marks], [place for place, _ in marks], "|", color=COLOURS[3], markersize=14,
              markeredgewidth=3, label=theirs)  # fmt: skip
    for place, (_, value, spread, mark) in zip(places, rows):
        if spread and spread[0] != spread[1]:
            axes.plot(spread, [place, place], color=DARK, linewidth=0.9)
        words = "not measured" if value is None else f"{value:.3f}"
        words += f" (paper {mark:.3f})" if mark is not None else ""
        axes.annotate(words, (1.01, place), va="center", annotation_clip=False)
    axes.set(xlabel=x_label, xlim=(0.0, 1.0), ylim=(len(rows) - 0.4, -0.6), yticks=places)
    axes.set_yticklabels([row[0] for row in rows])
    axes.grid(axis="y", visible=False)
    return drawing.svg()
