#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/base/checks.hpp"
#include "tests/fuzz/fuzz_targets.hpp"

namespace houghstream::fuzz {
namespace {

namespace fs = std::filesystem;

/// Returns the items that the target takes from the input; nothing where it refuses it in one line. Any other result is
/// a failure.
std::optional<Taken> taken_of(const FuzzTarget& target, const Bytes& input, const std::string& what) {
  try {
    return target.run({input.data(), input.size()});
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << target.name << ", " << what << error.what();
  } catch (const std::exception& error) {
    ADD_FAILURE() << target.name << ", " << what << ": " << error.what();
  }
  return std::nullopt;
}

/// Expects that at least these items are taken from a damaged input, or a warning.
void expect_no_less(const std::optional<Taken>& taken, std::size_t items, const std::string& what) {
  if (taken && !taken->tells_loss) {
    EXPECT_GE(taken->items, items) << what << ": taken without a word";
  }
}

/// Returns even cuts, and those behind a line: a text that ends there may look whole.
std::vector<std::size_t> cuts_of(const Bytes& seed) {
  std::vector<std::size_t> cuts;
  for (std::size_t i = 0; i < 30; ++i) cuts.push_back(seed.size() * i / 30);
  for (std::size_t i = 1; i < seed.size(); ++i) {
    if (seed[i - 1] == '\n') cuts.push_back(i);
  }
  return cuts;
}

TEST(FuzzReplay, WholeInputsAreTaken) {
  for (const FuzzTarget& target : fuzz_targets()) {
    for (const Bytes& seed : target.seeds()) {
      const std::optional<Taken> taken = taken_of(target, seed, "a seed");
      ASSERT_TRUE(taken.has_value()) << target.name;
      EXPECT_FALSE(taken->tells_loss) << target.name;
      EXPECT_TRUE(taken->items > 0 || !(target.known.cuts || target.known.flips)) << target.name << " counts nothing";
    }
  }
}

TEST(FuzzReplay, CutInputsAreRefusedInOneLineOrNotReadInPartWithoutAWord) {
  for (const FuzzTarget& target : fuzz_targets()) {
    for (const Bytes& seed : target.seeds()) {
      const std::size_t whole = taken_of(target, seed, "a seed").value_or(Taken{}).items;
      for (const std::size_t cut : cuts_of(seed)) {
        const std::string what = fmt::format("{}, cut to {} of {}", target.name, cut, seed.size());
        const auto taken = taken_of(target, {seed.begin(), seed.begin() + static_cast<std::ptrdiff_t>(cut)}, what);
        if (target.known.cuts) expect_no_less(taken, whole, what);
      }
    }
  }
}

TEST(FuzzReplay, DamagedInputsAreRefusedInOneLineOrNotReadInPartWithoutAWord) {
  for (const FuzzTarget& target : fuzz_targets()) {
    for (const Bytes& seed : target.seeds()) {
      const std::size_t whole = taken_of(target, seed, "a seed").value_or(Taken{}).items;
      std::mt19937 random(11);
      for (int i = 0; i < 100; ++i) {
        const auto bit = static_cast<unsigned>(random() % 8);
        const std::size_t place = random() % seed.size();
        Bytes damaged = seed;
        damaged[place] ^= static_cast<std::uint8_t>(1U << bit);
        const std::string what = fmt::format("{}, bit {} of byte {}", target.name, bit, place);
        const std::optional<Taken> taken = taken_of(target, damaged, what);
        if (target.known.flips) expect_no_less(taken, whole - std::min(whole, *target.known.flips), what);
        if (target.repair == nullptr) continue;
        target.repair(damaged);
        taken_of(target, damaged, what + ", repaired");
      }
    }
  }
}

std::string repeated(const std::string& text) {
  constexpr int kTimes = 3000;
  std::string out;
  for (int i = 0; i < kTimes; ++i) out += text;
  return out;
}

// The texts are long repetitions of one word, by target.
TEST(FuzzReplay, NestingWithoutEndThatOnceFailedDoesNotFailAgain) {
  const std::vector<std::pair<std::string, std::string>> inputs = {
      {"places", "cameras:\n  A:" + repeated(" [\n") + " "},
      {"calibration", "image_width: 640\na: " + repeated("[\n")},
      {"calibration", "image_width: 640\na:\n  " + repeated("- ") + "1\n"}};
  for (const auto& [name, text] : inputs) {
    const std::vector<FuzzTarget> targets = fuzz_targets();
    const auto target =
        std::find_if(targets.begin(), targets.end(), [&](const FuzzTarget& it) { return it.name == name; });
    ASSERT_NE(target, targets.end()) << name;
    EXPECT_FALSE(taken_of(*target, bytes_of_text(text), text.substr(0, 24)).has_value());
  }
}

// Inputs that once crashed, hung or ate memory: regressions/TARGET/*.
TEST(FuzzReplay, WhatOnceFailedDoesNotFailAgain) {
  const fs::path folder = fs::path(__FILE__).parent_path() / "regressions";
  for (const FuzzTarget& target : fuzz_targets()) {
    if (!fs::is_directory(folder / target.name)) continue;
    for (const auto& entry : fs::directory_iterator(folder / target.name)) {
      std::ostringstream text;
      text << std::ifstream(entry.path(), std::ios::binary).rdbuf();
      taken_of(target, bytes_of_text(text.str()), entry.path().string());
    }
  }
}

}  // namespace
}  // namespace houghstream::fuzz
