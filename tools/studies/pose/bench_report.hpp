#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tools/studies/pose/pose_bench.hpp"

namespace houghstream {

// The variants. The unchecked one is ours with a verification that accepts everything: what it publishes beyond ours is
// what ours withholds.
constexpr const char* kOurs = "ours";
constexpr const char* kPcl = "pcl";
constexpr const char* kUnchecked = "unchecked";
constexpr const char* kPrerejective = "prerejective";
constexpr const char* kPpf = "ppf";

/// results.json and poses.csv in the folder, which is made. Throws InputError where they cannot be written.
void write_bench(const PoseBench& bench, const std::filesystem::path& folder);

/// worst_1.png to worst_10.png, those of an earlier run removed. Throws InputError as above.
void write_worst(const std::vector<PoseTrial>& trials, const std::map<std::string, BopScene>& scenes,
                 const std::map<std::string, Mesh>& meshes, const std::filesystem::path& folder);

/// Lines for the terminal.
std::string bench_summary(const PoseBench& bench);

}  // namespace houghstream
