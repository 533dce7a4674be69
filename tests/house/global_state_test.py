"""Plants faults in a small copy of the house and expects each to be found, and nothing in a tidy one."""

import unittest

import global_state
import seeded_faults

GOOD = """
#include "pipeline/base/files.hpp"
namespace houghstream {
namespace {
constexpr int kMost = 3;
const char* const kName = "x";
template <typename T>
T twice(T value) { return value + value; }
struct Settings {
  int threads = 2;
  static Settings quick();
  static constexpr int kThreads = 2;
};
}  // namespace
int count(const Settings& settings) {
  static const std::map<int, int> known = {{1, 2}};
  int sum = 0;
  for (const auto& [key, value] : known) sum += value * settings.threads;
  return sum;
}
void announce();
Detector::Detector(Forest forest) : state_(std::make_unique<State>(forest)) { check(forest); }
}  // namespace houghstream
"""
WRONG = {
    "a variable of a namespace": "namespace houghstream {\nint verbosity = 1;\n}\n",
    "one that another library sets": "namespace houghstream {\nnamespace {\nstd::function<void(Detector&)> install_extensions;\n}\n}\n",
    "a pointer that is not constant": 'namespace houghstream {\nSettings* settings{nullptr};\n}\n',
    "a variable of a class": "namespace houghstream {\nclass Detector {\n  inline static Settings common = {};\n};\n}\n",
    "a static one of a function": "namespace houghstream {\nint next() {\n  static int last = 0;\n  return ++last;\n}\n}\n",
}


def faults_with(text, name="pose/seen/region.cpp"):
    return seeded_faults.faults_of({"pipeline/base/files.cpp": GOOD, name: text}, lambda root: list(global_state.find_faults(root)))


class GlobalState(unittest.TestCase):
    def test_constants_functions_and_members_are_none(self):
        self.assertEqual(faults_with(GOOD), [])

    def test_every_planted_fault_is_found_once(self):
        for what, text in WRONG.items():
            with self.subTest(what):
                self.assertEqual(len(faults_with(text)), 1, faults_with(text))

    def test_studies_and_what_a_process_has_by_its_nature_are_left_out(self):
        for name in ("tools/studies/speed/kernels.cpp", "pipeline/base/stop_signal.cpp"):
            self.assertEqual(faults_with(WRONG["a variable of a namespace"], name), [])


if __name__ == "__main__":
    unittest.main()
