"""Plants lists in braces that fill a struct by position and expects each to be found, and nothing in a tidy house."""

import unittest

import named_fields
import seeded_faults

STRUCTS = """
struct Track {
  int id = 0;
  std::string name;
  double score = 0.0, age_s = 0.0;
  bool there() const { return score > 0.0; }
  std::vector<int> cameras = {};
};
struct Point {
  double x, y, z, w;
};
struct View {
  const Track& track;
  const Point& from;
  int pixels = 0;
  int hidden = 0;
  int beside = 0;
};
struct World {
  std::vector<Track> tracks;
  Track newest;
};
void show(const std::vector<Track>& all, const Track& newest);
"""
GOOD = """#include "pose/track.hpp"
constexpr Track kTable[] = {{1, "mug", 0.5, 0.0, {}}, {2, "bowl", 0.5, 0.0, {}}};
const Point point{1.0, 2.0, 3.0, 4.0};
World tidy(const Track& given) {
  Track track{given};
  track.id = 1;
  View view{given, point};
  view.pixels = 3;
  World world;
  world.tracks.push_back(track);
  return world;
}
"""
WRONG = {
    "a variable": "Track track{1, \"mug\", 0.5, 0.0, {}};",
    "a variable with a sign of equality": "const Track track = {1, \"mug\"};",
    "a temporary": "const auto track = Track{1, \"mug\", 0.5};",
    "a result": "Track made() { return {1, \"mug\", 0.5}; }",
    "an element": "void add(World& world) { world.tracks.push_back({1, \"mug\", 0.5}); }",
    "a single row": "const std::vector<Track> all = {{1, \"mug\", 0.5}};",
    "a member": "void set(World& world) { world.newest = {1, \"mug\", 0.5}; }",
    "an argument": "void call() { show({}, {1, \"mug\", 0.5}); }",
    "a field within a struct": "World world{{}, {1, \"mug\", 0.5}};",
    "more than the references": "View view{track, point, 3};",
}


def faults_with(extra):
    return seeded_faults.faults_of({"pose/track.hpp": STRUCTS, "pose/tidy.cpp": GOOD, **extra}, named_fields.find_faults)


class NamedFields(unittest.TestCase):
    def test_a_tidy_house_has_no_fault(self):
        self.assertEqual(faults_with({}), [])

    def test_every_planted_fault_is_found_once(self):
        for what, code in WRONG.items():
            with self.subTest(what):
                found = faults_with({"pose/wrong.cpp": code + "\n"})
                self.assertEqual(len(found), 1, found)
                self.assertIn("pose/wrong.cpp:1: ", found[0])

    def test_a_comment_or_a_text_is_no_list(self):
        self.assertEqual(faults_with({"pose/words.cpp": '// Track{1, "mug", 0.5}\nconst char* text = "Track{1, 2, 3}";\n'}), [])


if __name__ == "__main__":
    unittest.main()
