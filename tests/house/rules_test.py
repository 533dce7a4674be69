"""Plants faults in a small copy of the house and expects each to be found, and nothing in a tidy one."""

import pathlib
import tempfile
import unittest

import seeded_faults
import rules

GOOD = {
    "pipeline/README.md": "# Pipeline\n\n`order: base < { geometry, messages } < .`\n",
    "pipeline/loop.cpp": '#include "pipeline/messages/codecs.hpp"\n',
    "pipeline/base/files.hpp": "#pragma once\n",
    "pipeline/base/files.cpp": '#include "pipeline/base/files.hpp"\n',
    "pipeline/geometry/mesh.hpp": '#include "pipeline/base/files.hpp"\n',
    "pipeline/geometry/mesh_io.cpp": '#include "pipeline/geometry/mesh.hpp"\n',
    "pipeline/messages/codecs.hpp": '#include "pipeline/base/files.hpp"\n',
    "tests/house/owners.txt": "# IDEA | PATTERN | PLACES\nPCL | #\\s*include\\s*[<\"]pcl/ | pose/baseline/\nJPEG | \\btjCompress | pipeline/messages/codecs\n",
}
WRONG = {
    "an include against the order of folders": {"pipeline/base/log.cpp": '#include "pipeline/messages/codecs.hpp"\n'},
    "an include between folders side by side": {"pipeline/geometry/paint.cpp": '#include "pipeline/messages/codecs.hpp"\n'},
    "a folder that stands in no order": {"pipeline/text/words.cpp": "\n"},
    "a top folder without an order": {"pose/pose.cpp": "\n"},
    "a circle of two units by way of a source": {
        "pipeline/base/one.hpp": "#pragma once\n",
        "pipeline/base/one.cpp": '#include "pipeline/base/one.hpp"\n#include "pipeline/base/two.hpp"\n',
        "pipeline/base/two.hpp": '#include "pipeline/base/one.hpp"\n',
    },
    "a circle of a folder and one in it": {
        "pipeline/geometry/shapes.hpp": '#include "pipeline/geometry/files/read.hpp"\n',
        "pipeline/geometry/shapes.cpp": '#include "pipeline/geometry/shapes.hpp"\n',
        "pipeline/geometry/files/read.hpp": '#include "pipeline/geometry/mesh.hpp"\n',
        "pipeline/other.cpp": '#include "pipeline/geometry/shapes.hpp"\n',
    },
    "a header for its own source alone": {
        "pipeline/base/own.hpp": "#pragma once\n",
        "pipeline/base/own.cpp": '#include "pipeline/base/own.hpp"\n',
    },
    "a header for tests alone": {
        "pipeline/base/tried.hpp": "#pragma once\n",
        "tests/pipeline/base/other_test.cpp": '#include "pipeline/base/tried.hpp"\n',
    },
    "a library's header elsewhere": {"pipeline/base/files.cpp": '#include "pipeline/base/files.hpp"\n#include <pcl/point_types.h>\n'},
    "a second owner": {"pipeline/base/files.cpp": '#include "pipeline/base/files.hpp"\nint i = tjCompress(1);\n'},
}


def faults_with(extra):
    return seeded_faults.faults_of({**GOOD, **extra}, rules.find_faults)


class Rules(unittest.TestCase):
    def test_a_tidy_house_has_no_fault(self):
        self.assertEqual(faults_with({}), [])

    def test_every_planted_fault_is_found_once(self):
        for what, extra in WRONG.items():
            with self.subTest(what):
                self.assertEqual(len(faults_with(extra)), 1, faults_with(extra))

    def test_a_circle_of_three_is_named_as_a_whole(self):
        ring = {f"pipeline/base/{name}.hpp": f'#include "pipeline/base/{after}.hpp"\n' for name, after in ("ab", "bc", "ca")}
        self.assertEqual(faults_with(ring), ["circle: pipeline/base/a, pipeline/base/b, pipeline/base/c"])

    def test_a_public_header_may_be_for_nobody_here(self):
        extra = {**WRONG["a header for tests alone"], ".cmake/public_headers.txt": "pipeline/base/tried.hpp\n"}
        self.assertEqual(faults_with(extra), [])

    def test_a_pattern_in_a_comment_is_no_second_owner(self):
        self.assertEqual(faults_with({"pipeline/base/files.cpp": '// As tjCompress does.\n#include "pipeline/base/files.hpp"\n'}), [])

    def test_known_faults_are_no_news_and_gone_ones_are(self):
        fault = "circle: pipeline/base/one, pipeline/base/two"
        files = {**GOOD, **WRONG["a circle of two units by way of a source"]}
        for known, told in (("", [fault]), (f"{fault}\n", [])):
            self.assertEqual(seeded_faults.faults_of({**files, "tests/house/known.txt": known}, rules.news), told)
        (gone,) = seeded_faults.faults_of({**GOOD, "tests/house/known.txt": f"{fault}\n"}, rules.news)
        self.assertIn("no fault any more", gone)

    def test_a_row_of_owners_without_places_is_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, rules.HOUSE, "owners.txt")
            file.parent.mkdir(parents=True)
            file.write_text("JPEG | tjCompress\n")
            with self.assertRaisesRegex(ValueError, "expected IDEA"):
                rules.read_owners(pathlib.Path(folder))


if __name__ == "__main__":
    unittest.main()
