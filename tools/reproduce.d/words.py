"""How the report writes numbers."""


def percent(value):
    if value is None:
        return "–"
    rounded = round(100.0 * value)
    return f"{rounded:+d} %".replace("-", "−") if rounded else "0 %"


def milliseconds(value):
    return "–" if value is None else f"{value / 1e3:.2f} s" if value >= 2000.0 else f"{value:.1f} ms"
