"""Plants a document that states another default than the code."""

import unittest

import documented_defaults
import seeded_faults

ROWS = (("pose/README.md", r"from quality ([\d.]+) on", "pose/quality.hpp", r"min_quality = ([\d.]+)F"),)


def faults_of(document, source):
    files = {"pose/README.md": document, "pose/quality.hpp": source}
    return seeded_faults.faults_of(files, lambda root: list(documented_defaults.find_faults(root, ROWS)))


class DocumentedDefaults(unittest.TestCase):
    def test_the_same_number_is_no_fault(self):
        self.assertEqual(faults_of("from quality 0.75 on\n", "float min_quality = 0.75F;\n"), [])

    def test_another_number_is_named(self):
        self.assertEqual(faults_of("from quality 0.8 on\n", "float min_quality = 0.75F;\n"), ["pose/README.md: says 0.8, but pose/quality.hpp has 0.75"])

    def test_other_words_and_other_code_are_named(self):
        self.assertIn("no words like", faults_of("from there on\n", "float min_quality = 0.75F;\n")[0])
        self.assertIn("no default like", faults_of("from quality 0.8 on\n", "float fewest = 0.75F;\n")[0])


if __name__ == "__main__":
    unittest.main()
