#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "pipeline/base/checks.hpp"
#include "tests/fuzz/fuzz_targets.hpp"

namespace houghstream::fuzz {
namespace {

namespace fs = std::filesystem;

/// Whether the target takes the input; anything but taking it or refusing it in one line is a fault.
bool takes(const FuzzTarget& target, const Bytes& input, const std::string& what) {
  try {
    target.run({input.data(), input.size()});
    return true;
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << target.name << ", " << what << error.what();
  } catch (const std::exception& error) {
    ADD_FAILURE() << target.name << ", " << what << ": " << error.what();
  }
  return false;
}

TEST(FuzzReplay, WholeInputsAreTaken) {
  for (const FuzzTarget& target : fuzz_targets()) {
    for (const Bytes& seed : target.seeds()) EXPECT_TRUE(takes(target, seed, "a seed")) << target.name;
  }
}

TEST(FuzzReplay, CutAndDamagedInputsAreRefusedInOneLineOrTaken) {
  for (const FuzzTarget& target : fuzz_targets()) {
    for (const Bytes& seed : target.seeds()) {
      for (std::size_t i = 0; i < 30; ++i) {
        const std::size_t length = seed.size() * i / 30;
        takes(target, {seed.begin(), seed.begin() + static_cast<std::ptrdiff_t>(length)},
              fmt::format("cut to {}", length));
      }
      std::mt19937 random(11);
      for (int i = 0; i < 100; ++i) {
        Bytes damaged = seed;
        damaged[random() % damaged.size()] ^= static_cast<std::uint8_t>(1U << random() % 8);
        if (target.repair != nullptr && i % 2 == 0) target.repair(damaged);
        takes(target, damaged, fmt::format("flip {}", i));
      }
    }
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
      takes(target, bytes_of_text(text.str()), entry.path().string());
    }
  }
}

}  // namespace
}  // namespace houghstream::fuzz
