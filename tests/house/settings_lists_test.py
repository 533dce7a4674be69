"""Plants fields without a range and expects each to be found, and nothing in a tidy house."""

import unittest

import seeded_faults
import settings_lists

GOOD = """
struct MotionSettings {
  double drift_m = 0.1;  ///< metres
  bool is_used = true;
  std::map<std::string, int> names;
};
template <typename Visit>
void fields(const MotionSettings& /*settings*/, const Visit& visit) {
  using S = MotionSettings;
  visit(number("drift_m", &S::drift_m, 0, 1, "m"));
}
struct TrackSettings {
  MotionSettings motion;
  std::size_t max_objects = 500;
  std::function<int(int)> engine;
};
template <typename Visit>
void fields(const TrackSettings& /*settings*/, const Visit& visit) {
  using S = TrackSettings;
  visit(group("motion", &S::motion));
  visit(number("max_objects", &S::max_objects, 0, 1000));
}
struct PlainOptions {
  int count = 1;
};
"""
WRONG = {
    "a number": ('  visit(number("drift_m", &S::drift_m, 0, 1, "m"));\n', ""),
    "a size": ('  visit(number("max_objects", &S::max_objects, 0, 1000));\n', ""),
    "settings within settings": ('  visit(group("motion", &S::motion));\n', ""),
    "a field that was added": ("  bool is_used = true;\n", "  bool is_used = true;\n  float coast_s = 0.1F;\n"),
}


def faults_of(text):
    return seeded_faults.faults_of({"pose/motion/motion.hpp": text}, lambda root: list(settings_lists.find_faults(root)))


class SettingsLists(unittest.TestCase):
    def test_a_tidy_house_has_no_fault(self):
        self.assertEqual(faults_of(GOOD), [])

    def test_every_planted_fault_is_found_once(self):
        for what, (old, new) in WRONG.items():
            with self.subTest(what):
                self.assertIn(old, GOOD)
                self.assertEqual(len(faults_of(GOOD.replace(old, new))), 1, faults_of(GOOD.replace(old, new)))


if __name__ == "__main__":
    unittest.main()
