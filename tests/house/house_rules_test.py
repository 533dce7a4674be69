"""Plants faults in a small copy of the house and expects each to be found."""

import unittest

import house_rules
import seeded_faults

GOOD = {
    "README.md": "A house.\n",
    "CMakeLists.txt": "",
    ".ci/run": "",
    "detector/detector.cpp": "int main() {}\n",
    **{f"{folder}/README.md": "What is where.\n" for folder in house_rules.FOLDERS_WITH_README},
}
WRONG = {
    "history in prose": {"tools/studies/README.md": "Measured at 1a2b3c4.\n"},
    "a stranger at the top": {"notes.txt": ""},
    "memory without an owner": {"pose/seen/region.cpp": "static thread_local int x = 0;\n"},
    "something unfinished": {"tools/view/viewer.cpp": "// TO" "DO: the rest\n"},
    "a function of many parameters": {"tools/studies/soak/relay.py": "def pass_on(a, b, c, d, e=1, *, f=2):\n    return a\n"},
}


def faults_with(extra, left_out=()):
    files = {name: text for name, text in {**GOOD, **extra}.items() if name not in left_out}
    return seeded_faults.faults_of(files, house_rules.find_faults)


class HouseRules(unittest.TestCase):
    def test_a_tidy_house_has_no_fault(self):
        self.assertEqual(faults_with({}), [])

    def test_every_planted_fault_is_found(self):
        for what, extra in WRONG.items():
            with self.subTest(what):
                self.assertEqual(len(faults_with(extra)), 1, faults_with(extra))

    def test_the_object_itself_is_no_parameter(self):
        for first in ("self", "cls"):
            method = f"class Relay:\n    def pass_on({first}, a, b, c, d, *e):\n        return a\n"
            self.assertEqual(faults_with({"tools/studies/soak/relay.py": method}), [])

    def test_a_folder_without_readme_is_named(self):
        self.assertEqual(len(faults_with({}, left_out=["pose/README.md"])), 1)


if __name__ == "__main__":
    unittest.main()
