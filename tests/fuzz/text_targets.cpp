#include <filesystem>
#include <fstream>
#include <sstream>

#include "drivers/datasets/dataset_sources.hpp"
#include "pipeline/base/checks.hpp"
#include "pipeline/bus/channel_pattern.hpp"
#include "pipeline/messages/wire_check.hpp"
#include "pipeline/types/camera.hpp"
#include "pose/tracks/camera_extrinsics.hpp"
#include "tests/fuzz/fuzz_targets.hpp"
#include "tools/common/key_values.hpp"
#include "tools/stream/stream_plan.hpp"

// Texts that people write: options, configurations, lists.

namespace houghstream::fuzz {
namespace {

std::string text_of(ByteView input) {
  return {reinterpret_cast<const char*>(input.data), input.size};
}

/// Names of people and messages; the first letter selects the reader of the rest.
Taken read_words(ByteView input) {
  if (input.size == 0) return {};
  const std::string text = text_of({input.data + 1, input.size - 1});
  if (input.data[0] == 'p') ChannelPattern(text).matches("OPENNI_FRAME");
  if (input.data[0] == 'c') parse_camera(text);
  if (input.data[0] == 's') parse_sequence({input.data + 1, input.size - 1});
  if (input.data[0] == 'q') stream::shell_words(text, "--view-options");
  if (input.data[0] == 'l') tracks::parse_camera_pose(text);
  std::istringstream lines(text);
  if (input.data[0] == 'k') read_key_values(lines);
  return {};
}

std::vector<Bytes> words() {
  return {bytes_of_text("pOPENNI_.*|LEFT"),
          bytes_of_text("c640x480,525,525,319.5,239.5"),
          bytes_of_text("s12345"),
          bytes_of_text("q--video \"my file.mp4\" 'a b' c\\ d"),
          bytes_of_text("lLEFT=0.5,0,1.25,1,0,0,0"),
          bytes_of_text("k# made\nsource = \"openni2\"\nevery = 5 # s\n")};
}

Taken read_places(ByteView input) {
  return {tracks::read_camera_extrinsics(as_file(input, "places.yaml")).size()};
}

std::vector<Bytes> places() {
  return {
      bytes_of_text("cameras:\n  LEFT: {translation: [1.0, 0, 0.5], rotation: [1, 0, 0, 0]}\n"
                    "  RIGHT:\n    parent: LEFT\n    translation: [0.0, 2, 0]\n    rotation: [0.7071, 0, 0, 0.7071]\n"),
      bytes_of_text("transforms:\n- header:\n    frame_id: map\n  child_frame_id: stand\n  transform:\n"
                    "    translation: {x: 0.0, y: 0.5, z: 0.0}\n    rotation: {x: 0.0, y: 0.0, z: 0.0, w: 1.0}\n"
                    "---\n")};
}

/// Reads the two lists of a TUM sequence, which a byte 0 divides.
Taken read_sequence(ByteView input) {
  const std::string text = text_of(input);
  const std::size_t end = std::min(text.find('\0'), text.size());
  const std::filesystem::path folder = std::filesystem::path(as_file({}, "sequence")).concat("_folder");
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "rgb.txt", std::ios::binary) << text.substr(0, end);
  std::ofstream(folder / "depth.txt", std::ios::binary) << text.substr(std::min(end + 1, text.size()));
  open_tum_source(folder, {640, 480, 525.0, 525.0, 319.5, 239.5});
  return {};
}

std::vector<Bytes> sequences() {
  const std::string colours = "# color images\n1305031102.175304 rgb/0.png\n1305031102.211214 rgb/1.png\n";
  const std::string depths = "# depth maps\n1305031102.160407 depth/0.png\n1305031102.226738 depth/1.png\n";
  return {bytes_of_text(colours + '\0' + depths)};
}

}  // namespace

std::vector<FuzzTarget> text_targets() {
  return {
      {"words", read_words, words, nullptr, {"[a-z]", "(a|b)*", "{2,3}", "\\d", "640x480,", "1e308", "\"", "'"}, 128},
      // A cut between two cameras cannot be detected.
      {"places",
       read_places,
       places,
       nullptr,
       {"cameras:", "parent:", "translation:", "rotation:", "transforms:", "header:", "frame_id:", "- ", "{", "["},
       4096,
       {false, 0}},
      {"sequence", read_sequence, sequences, nullptr, {"1e10", "-1", "# "}}};
}

}  // namespace houghstream::fuzz
