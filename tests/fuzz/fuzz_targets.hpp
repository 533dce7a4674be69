#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/messages/wire_reader.hpp"

// Everything that reads what others made: each reader with whole inputs to begin from. clang's libFuzzer runs them on
// inputs of its own making (fuzz_main.cpp), the ordinary tests on cut and damaged ones and on those that once failed
// (replay_test.cpp).

namespace houghstream::fuzz {

using Bytes = std::vector<std::uint8_t>;

struct FuzzTarget {
  std::string name;
  /// Reads the input. Throws InputError where it refuses it; anything else that it throws is a fault.
  void (*run)(ByteView input);
  /// Whole inputs, which it takes.
  std::vector<Bytes> (*seeds)();
  /// Makes a checksum right that would keep mutations from being read any further; null = there is none.
  void (*repair)(Bytes& input);
  /// Words that the format is made of.
  std::vector<std::string> words;
  /// Longest input that is tried, bytes.
  int longest = 4096;
};

std::vector<FuzzTarget> message_targets();
std::vector<FuzzTarget> file_targets();
std::vector<FuzzTarget> mesh_targets();
std::vector<FuzzTarget> text_targets();

/// All of them.
std::vector<FuzzTarget> fuzz_targets();

/// The input as a file with this ending, in memory where the machine has such a folder; the same file each time.
std::string as_file(ByteView input, const std::string& ending);

inline Bytes bytes_of_text(const std::string& text) {
  return {text.begin(), text.end()};
}

}  // namespace houghstream::fuzz
