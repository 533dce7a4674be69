#pragma once

#include <filesystem>
#include <map>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "pipeline/geometry/mesh.hpp"
#include "pipeline/types/frame.hpp"
#include "tools/studies/pose/pose_bench.hpp"
#include "tools/studies/pose/pose_trials.hpp"

namespace houghstream {

/// The published poses that are worst, at most `count`: those of false detections before those of true ones, each by
/// ADD-S, the largest first and unknown before all. Ignored detections are left out.
std::vector<PoseTrial> worst_poses(const std::vector<PoseTrial>& trials, std::size_t count);

/// Draws the surroundings of a trial's box in its frame with the outline of its model, and a description below. The
/// trial has a pose. Images of all trials have one size, CV_8UC3.
cv::Mat draw_trial(const PoseTrial& trial, const RgbdFrame& frame, const Mesh& mesh);

// Names of the variants. The unchecked one is ours with a verification that accepts everything: the poses that it
// publishes beyond ours are those that ours rejects.
constexpr const char* kOurs = "ours";
constexpr const char* kPcl = "pcl";
constexpr const char* kUnchecked = "unchecked";
constexpr const char* kPrerejective = "prerejective";
constexpr const char* kPpf = "ppf";

/// Writes results.json and poses.csv in the folder, which is made. Throws InputError where they cannot be written.
void write_bench(const PoseBench& bench, const std::filesystem::path& folder);

/// Writes worst_1.png to worst_10.png, and removes those of an earlier run. Throws InputError as above.
void write_worst(const std::vector<PoseTrial>& trials, const std::map<std::string, BopScene>& scenes,
                 const std::map<std::string, Mesh>& meshes, const std::filesystem::path& folder);

/// Returns lines for the terminal.
std::string bench_summary(const PoseBench& bench);

}  // namespace houghstream
