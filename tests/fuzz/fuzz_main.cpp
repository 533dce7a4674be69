#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "pipeline/base/checks.hpp"
#include "pipeline/base/log_line.hpp"
#include "tests/fuzz/fuzz_targets.hpp"

// This is one program for all targets under libFuzzer: HOUGHSTREAM_FUZZ_TARGET names the target to run. With
// HOUGHSTREAM_FUZZ_SEEDS=FOLDER it writes FOLDER/TARGET/* and FOLDER/TARGET.dict for all of them, prints a line for
// each with its name and the longest input, and ends. tools/test --fuzz starts it.

namespace {

using namespace houghstream;
using fuzz::FuzzTarget;

const FuzzTarget* target = nullptr;

void write_seeds(const std::filesystem::path& folder) {
  for (const FuzzTarget& each : fuzz::fuzz_targets()) {
    std::filesystem::create_directories(folder / each.name);
    int number = 0;
    for (const fuzz::Bytes& seed : each.seeds()) {
      std::ofstream(folder / each.name / std::to_string(number++), std::ios::binary)
          .write(reinterpret_cast<const char*>(seed.data()), static_cast<std::streamsize>(seed.size()));
    }
    std::ofstream dictionary(folder / (each.name + ".dict"));
    for (const std::string& word : each.words) {
      dictionary << '"';
      for (const char c : word) dictionary << fmt::format("\\x{:02X}", static_cast<unsigned char>(c));
      dictionary << "\"\n";
    }
    fmt::print("{} {}\n", each.name, each.max_length);
  }
}

}  // namespace

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_length);

extern "C" int LLVMFuzzerInitialize(int* /*argc*/, char*** /*argv*/) {
  start_log("fuzz", LogLevel::kError);
  if (const char* folder = std::getenv("HOUGHSTREAM_FUZZ_SEEDS")) {
    write_seeds(folder);
    std::exit(0);
  }
  static const std::vector<FuzzTarget> kTargets = fuzz::fuzz_targets();
  const char* name = std::getenv("HOUGHSTREAM_FUZZ_TARGET");
  for (const FuzzTarget& each : kTargets) {
    if (name != nullptr && each.name == name) target = &each;
  }
  if (target == nullptr) {
    fmt::print(stderr, "HOUGHSTREAM_FUZZ_TARGET names no target\n");
    std::exit(2);
  }
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    target->run({data, size});
  } catch (const InputError&) {
  }
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_length,
                                               unsigned /*seed*/) {
  const std::size_t mutated = LLVMFuzzerMutate(data, size, max_length);
  if (target->repair == nullptr) return mutated;
  fuzz::Bytes bytes(data, data + mutated);
  target->repair(bytes);
  std::copy(bytes.begin(), bytes.end(), data);
  return mutated;
}
