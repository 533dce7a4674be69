"""Names of somebody else's making reach no page as markup: every writer of pages is known here, and is given such names.

Usage: PYTHONPATH=tools pages_test.py"""

import pathlib
import re
import unittest
import xml.etree.ElementTree

from studies.report import charts, page

TOOLS = pathlib.Path(__file__).resolve().parents[2] / "tools"
SCRIPT = "<script>alert(1)</script>"
TEMPLATES = sorted(path.relative_to(page.PACKAGE).as_posix() for path in page.PACKAGE.rglob("*.html"))
# What writes markup. Another one needs a test of its own before it stands here.
WRITERS = {
    "studies/report/page.py",  # here
    "teach/mesh/store_report.cpp",  # tests/tools/teach/mesh/store_report_test.cpp
    "teach/show/session_archive.cpp",  # tests/tools/teach/show/session_archive_test.cpp
}
MARKUP = re.compile(r"""["'](?:[^"'\n]*[^\w"'\n])?</?(?:!doctype|html|title|h[1-6]|p|pre|div|img|figure|table|t[rdh]|svg|script|a)[ >]""")


class Evil(str):
    """A name that is markup. Its parts, its attributes and what it returns are so too: whatever a template does with it."""

    __slots__ = ()

    def __new__(cls, *_):
        return super().__new__(cls, SCRIPT)

    def __getattr__(self, name):
        if name.startswith("__"):  # it says of itself that it is no markup
            raise AttributeError(name)
        return Evil()

    def __getitem__(self, key):
        return [Evil(), Evil()] if isinstance(key, slice) else Evil()

    def __iter__(self):
        return iter((Evil(), Evil()))

    def __call__(self, *_):
        return Evil()

    def items(self):
        return [(Evil(), Evil())]

    def __contains__(self, _):
        return True

    def __format__(self, _):
        return SCRIPT

    def __float__(self):
        return 1.0

    def __gt__(self, _):
        return True

    def __lt__(self, _):
        return True

    def __hash__(self):
        return super().__hash__()

    def __eq__(self, other):
        return self is other


class Everything(dict):
    """The values of a template: whatever it asks for."""

    def __missing__(self, _):
        return Evil()


def names_in(template):
    """The variables of a template: the words in its expressions, whatever else they are too."""
    text = (page.PACKAGE / template).read_text()
    inside = " ".join(re.findall(r"{[{%](.*?)[}%]}", text, re.DOTALL))
    return set(re.findall(r"(?<![.\w\"])[a-z_][a-z_0-9]*", re.sub(r'"[^"]*"', "", inside))) - {"figure", "image", "show", "table"}


class Pages(unittest.TestCase):
    def test_no_template_lets_a_name_through(self):
        self.assertGreater(len(TEMPLATES), 5)
        for template in TEMPLATES:
            with self.subTest(template):
                drawn = page.render(template, **{name: Evil() for name in names_in(template)})
                self.assertNotIn(SCRIPT, drawn)
                if template != "report/base.html":
                    self.assertIn("&lt;script&gt;alert(1)&lt;/script&gt;", drawn)

    def test_no_template_takes_text_for_markup(self):
        for template in TEMPLATES:
            self.assertNotRegex((page.PACKAGE / template).read_text(), r"\|\s*safe|autoescape", template)

    def test_the_kit_escapes_names(self):
        for text in (page.table((SCRIPT,), [(SCRIPT, 1)]), page.figure("<svg/>", SCRIPT)):
            self.assertNotIn(SCRIPT, text)
            self.assertIn("&lt;script&gt;", text)

    def test_charts_show_names_as_they_are(self):
        chart = charts.Chart((SCRIPT, 1.0), (SCRIPT, 1.0), SCRIPT)
        chart.line(SCRIPT, [(0.0, 0.0), (1.0, 1.0)])
        chart.label(0.5, 0.5, SCRIPT)
        bars = charts.grouped_bars([SCRIPT], [(SCRIPT, None, [0.5], [None])], SCRIPT)
        rows = charts.row_bars([(SCRIPT, 0.25, None, None)], SCRIPT, SCRIPT, SCRIPT)
        for drawing in (chart.svg(), bars, rows):
            self.assertNotIn("<script", drawing)
            self.assertIn("&lt;script&gt;", drawing)

    def test_a_name_with_dollars_is_no_formula(self):
        drawn = xml.etree.ElementTree.fromstring(charts.Chart(("$a_b$", 1.0), ("$\\nothing$", 1.0)).svg())
        words = [element.text for element in drawn.iter("{http://www.w3.org/2000/svg}text")]
        self.assertLessEqual({"$a_b$", "$\\nothing$"}, set(words))

    def test_every_writer_of_markup_is_known(self):
        found = set()
        for path in sorted(TOOLS.rglob("*")):
            if path.suffix in (".py", ".cpp", ".hpp") and MARKUP.search(path.read_text()):
                found.add(path.relative_to(TOOLS).as_posix())
        self.assertEqual(found, WRITERS)
        markup = {path.relative_to(TOOLS).as_posix() for path in TOOLS.rglob("*.py") if re.search(r"\bMarkup\b|jinja2", path.read_text())}
        self.assertEqual(markup, {"studies/report/page.py"})

    def test_the_live_page_sets_text_only(self):
        live = (TOOLS / "view/http/page.html").read_text()
        for dangerous in ("innerHTML", "outerHTML", "insertAdjacentHTML", "document.write", "eval(", "new Function", "srcdoc"):
            self.assertNotIn(dangerous, live)


if __name__ == "__main__":
    unittest.main()
