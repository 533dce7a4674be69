"""Plants names that are defined twice in a small copy of the house and expects each to be found, and no other."""

import unittest

import unique_names
import seeded_faults

GOOD = {
    "pipeline/frame.hpp": "namespace houghstream {\nclass Later;\nstruct Frame {\n  struct Pair { int a; };\n};\n"
                          "enum class Kind : int { kOne };\nFrame make(struct Later* x);\n}  // namespace houghstream\n",
    "pipeline/frame.cpp": "namespace houghstream {\nnamespace {\nstruct Helper { int a = 1'000; };\n}  // namespace\n"
                          "class Later {\n public:\n  struct Pair {};\n};\n"
                          "Frame make(struct Later* x) {\n  struct Local {};\n  return {};\n}\n}\n",
    "drivers/openni/pair.hpp": "namespace houghstream::openni {\nstruct Pair {};\nstruct Frame {};  // struct Frame {\n"
                               "template <typename T>\nclass Box final : public Base<T> {};\n}\n",
    "drivers/openni/other.cpp": "#define OPEN {\nnamespace houghstream {\nnamespace {\nstruct Helper {};\n"
                                'const char* text = "namespace houghstream { struct Frame {";\n}\n'
                                "void work() { struct Local {}; }\n}\n",
}

TWICE = {
    "a struct beside a struct": ("detector/a.hpp", "namespace houghstream {\nstruct Frame {};\n}\n", "houghstream::Frame"),
    "a class in a source file": ("pose/a.cpp", "namespace houghstream {\nclass Later : public X {\n};\n}\n",
                                 "houghstream::Later"),
    "an enum": ("tools/a/a.hpp", "namespace houghstream {\nenum Kind { kTwo };\n}\n", "houghstream::Kind"),
    "a template": ("drivers/a.hpp", "namespace houghstream {\nnamespace openni {\ntemplate <class T, class U = X<T>>\n"
                   "struct Box {};\n}\n}\n", "houghstream::openni::Box"),
    "a nested one of a class that is taken apart": (
        "drivers/b.hpp", "namespace houghstream {\nstruct Frame::Pair {};\n}\n", "houghstream::Frame::Pair"),
}


def faults_with(extra):
    return seeded_faults.faults_of({**GOOD, **extra}, unique_names.find_faults)


class UniqueNames(unittest.TestCase):
    def test_names_of_their_own_are_no_fault(self):
        self.assertEqual(faults_with({}), [])

    def test_every_planted_fault_is_found_and_named(self):
        for what, (file, text, name) in TWICE.items():
            with self.subTest(what):
                faults = faults_with({file: text})
                self.assertEqual(len(faults), 1, faults)
                self.assertIn(f"{name} is defined in ", faults[0])
                self.assertIn(file, faults[0])

    def test_twice_in_one_file_is_a_fault_too(self):
        text = "namespace houghstream {\nstruct Twice {};\n}\nnamespace houghstream {\nstruct Twice {};\n}\n"
        self.assertEqual(len(faults_with({"pose/twice.hpp": text})), 1)


if __name__ == "__main__":
    unittest.main()
