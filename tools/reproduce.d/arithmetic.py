"""Arithmetic with values that may be unknown: None."""


def relative(value, reference):
    """Change relative to the reference, -0.25 for a quarter less; None where either is unknown."""
    return None if value is None or not reference else value / reference - 1.0


def ratio(value, reference):
    return None if value is None or not reference else value / reference


def mean_of(values):
    """None where any is unknown: a mean of what happens to be there compares with nothing."""
    values = list(values)
    return None if not values or None in values else sum(values) / len(values)
