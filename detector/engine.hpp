#pragma once

#include <functional>

namespace houghstream {

struct FeatureInput;
struct FeatureMemory;
class FeatureImage;
struct LeafInput;
struct LeafMemory;
struct RunLeaves;

/// Who computes the two stages that take most of the time. Engines find the same features and the same leaves, bit for
/// bit: fast_engine() in tiles and vectors, baseline::reference_engine() plane by plane and patch by patch, to hold the
/// fast one against.
struct Engine {
  void (*features)(const FeatureInput& input, int threads, FeatureMemory& memory, FeatureImage& image);
  void (*leaves)(const LeafInput& input, int threads, LeafMemory& memory,
                 const std::function<void(const RunLeaves&)>& visit);
};

/// compute_features and find_leaves.
const Engine& fast_engine();

}  // namespace houghstream
