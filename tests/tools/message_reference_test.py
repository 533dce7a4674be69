"""The generator of the message reference. Usage: message_reference_test.py SOURCE_FOLDER"""

import importlib.machinery
import importlib.util
import pathlib
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(sys.argv[1]).resolve()
PROGRAM = SOURCE / "tools" / "message_reference"
loader = importlib.machinery.SourceFileLoader("message_reference", str(PROGRAM))
reference = importlib.util.module_from_spec(importlib.util.spec_from_loader("message_reference", loader))
loader.exec_module(reference)

TYPE = """package houghstream;

// A thing. On two
// lines.
struct thing_t {
  // how many
  int32_t n;
  // metres | feet
  part_t parts[n][3];

  // not one
  const int8_t INVALID = -1;
}
"""


class MessageReference(unittest.TestCase):
    def test_page_is_current(self):
        subprocess.run([str(PROGRAM), "--check"], check=True)

    def test_every_type_is_there(self):
        page = reference.PAGE.read_text()
        for path in (SOURCE / "lcmtypes").glob("*.lcm"):
            self.assertIn(f"\n## {path.stem}\n", page)

    def test_members_and_constants(self):
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "thing_t.lcm").write_text(TYPE)
            (pathlib.Path(folder) / "part_t.lcm").write_text("package houghstream;\n// A part.\nstruct part_t {\n}\n")
            page = reference.page(pathlib.Path(folder))
        self.assertIn("## thing_t\n\nA thing. On two lines.\n", page)
        self.assertIn("| `n` | `int32_t` | how many |\n", page)
        self.assertIn("| `parts` | [`part_t[n][3]`](#part_t) | metres \\| feet |\n", page)
        self.assertIn("| `INVALID` | -1 | not one |\n", page)
        self.assertNotIn("package", page.partition("##")[2])

    def test_what_cannot_be_read_is_an_error(self):
        with self.assertRaises(ValueError):
            reference.parse(TYPE.replace("int32_t n;", "int32_t n"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
