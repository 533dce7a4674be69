"""Tests of the one report kit: charts are whole SVGs, pages are single files. Usage: PYTHONPATH=tools report_test.py"""

import unittest
import xml.etree.ElementTree

from studies.report import charts, page

SVG = "{http://www.w3.org/2000/svg}"


def words_of(svg):
    return [element.text for element in xml.etree.ElementTree.fromstring(svg).iter(f"{SVG}text")]


class Charts(unittest.TestCase):
    def test_axes_have_few_round_ticks_and_names_stay_text(self):
        chart = charts.Chart(("x <unit>", 47.0), ("y", 1.0), "title & more")
        chart.line("a & b", [(0, 0), (40, 1)])
        words = words_of(chart.svg())
        for text in ("x <unit>", "title & more", "a & b", "0", "10", "40", "0.2", "1.0"):
            self.assertIn(text, words)

    def test_the_same_chart_is_the_same_text(self):
        def drawn():
            chart = charts.Chart(("x", 1.0), ("y", 1.0))
            chart.dots("dots", [(0.5, 0.5)])
            return chart.svg()

        self.assertEqual(drawn(), drawn())

    def test_a_chart_without_points_is_whole(self):
        self.assertIn("nothing", words_of(charts.Chart(("nothing", 0.0), ("y", 0.0)).svg()))

    def test_a_label_near_the_right_edge_stands_on_the_points_left(self):
        chart = charts.Chart(("score", 1.0), ("share", 1.0))
        chart.label(0.5, 0.5, "3692")
        chart.label(1.0, 0.5, "3693")
        self.assertEqual([text.get_ha() for text in chart.axes.texts], ["left", "right"])

    def test_a_value_that_is_missing_is_no_bar(self):
        words = words_of(charts.grouped_bars(["a <b>", "c"], [("one", None, [0.5, None], [(0.4, 0.6), None])], "AUC"))
        self.assertEqual((words.count(".50"), words.count("–"), words.count("a <b>")), (1, 1, 1))

    def test_rows_without_value_say_so(self):
        words = words_of(
            charts.row_bars([("a", None, None, 0.5), ("b", 0.25, (0.2, 0.3), None)], "AUC", "ours", "theirs")
        )
        self.assertIn("not measured (paper 0.500)", words)
        self.assertIn("0.250", words)


class Page(unittest.TestCase):
    def test_cells_are_escaped(self):
        self.assertIn("<td>&lt;b&gt;</td>", page.table(("a",), [("<b>",)]))

    def test_what_is_unknown_is_a_dash(self):
        self.assertEqual((page.show(None), page.percent(None), page.milliseconds(None)), ("–",) * 3)
        self.assertEqual((page.percent(-0.123), page.milliseconds(2500.0)), ("−12 %", "2.50 s"))

    def test_a_value_that_the_template_misses_is_an_error(self):
        with self.assertRaises(Exception):
            page.render("demo/page.html", summary={})


if __name__ == "__main__":
    unittest.main()
