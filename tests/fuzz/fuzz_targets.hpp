#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/messages/wire_reader.hpp"

// Everything that reads what others made: each reader with whole inputs to begin from. clang's libFuzzer runs them on
// inputs of its own making (fuzz_main.cpp), the ordinary tests on cut and damaged ones and on those that once failed
// (replay_test.cpp).

namespace houghstream::fuzz {

using Bytes = std::vector<std::uint8_t>;

/// Items that a reader took from an input.
struct Taken {
  std::size_t items = 0;    ///< events, frames, nodes, pixels, triangles: of what the format holds many
  bool tells_loss = false;  ///< it continued behind damage, and reports so
};

/// Names the damage of a whole input that a reader detects at any position: it then refuses the input, reports a loss,
/// or takes as many items as of the whole one. It never takes fewer silently.
struct KnownDamage {
  bool cuts = false;
  /// Flipped bits, but for those that take so many items at most; nothing = there are some that may take any number.
  std::optional<std::size_t> flips{};
};
inline constexpr KnownDamage kAnyDamage = {true, 0};

struct FuzzTarget {
  std::string name;
  /// Reads the input. Throws InputError where it refuses it; anything else that it throws is a fault.
  Taken (*run)(ByteView input);
  /// Whole inputs, which it takes.
  std::vector<Bytes> (*seeds)();
  /// Makes a checksum right that would keep mutations from being read any further; null = there is none.
  void (*repair)(Bytes& input);
  /// Words that the format is made of.
  std::vector<std::string> words;
  /// Longest input that is tried, bytes.
  int max_length = 4096;
  KnownDamage known{};
};

std::vector<FuzzTarget> message_targets();
std::vector<FuzzTarget> file_targets();
std::vector<FuzzTarget> recording_targets();
std::vector<FuzzTarget> mesh_targets();
std::vector<FuzzTarget> text_targets();

/// Returns all targets.
std::vector<FuzzTarget> fuzz_targets();

/// Returns the input as a file with this ending, in memory where the machine has such a folder; the same file each
/// time.
std::string as_file(ByteView input, const std::string& ending);

Bytes content_of(const std::filesystem::path& file);

inline Bytes bytes_of_text(const std::string& text) {
  return {text.begin(), text.end()};
}

}  // namespace houghstream::fuzz
