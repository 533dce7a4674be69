#include "tools/finder/object_finder.hpp"

#include "detector/stages.hpp"
#include "drivers/store/object_store.hpp"
#include "pose/pose_estimator.hpp"
#include "tools/finder/search_options.hpp"
#include "tools/finder/stored_forest.hpp"
#include "tools/finder/stored_quality.hpp"

namespace houghstream {
namespace {

Detector make_detector(const store::ObjectStore& store, const FinderOptions& options) {
  SearchOptions search;
  search.threads = options.threads;
  search.threshold = options.threshold;
  search.candidates_from = kCandidatesFrom;
  return detector_of(load_store_forests(store), search);
}

PoseEstimator make_estimator(const store::ObjectStore& store, const FinderOptions& options) {
  PoseSettings common;
  common.threads = options.threads;
  return PoseEstimator(store::load_store_meshes(store), pose_settings_of(common, store, options.min_quality));
}

}  // namespace

struct ObjectFinder::State {
  State(const store::ObjectStore& store, const FinderOptions& options)
      : detector(make_detector(store, options)), estimator(make_estimator(store, options)) {}

  Detector detector;
  PoseEstimator estimator;
  DetectorWorkspace workspace;
};

ObjectFinder::ObjectFinder(const std::filesystem::path& store, const FinderOptions& options)
    : state_(std::make_unique<State>(store::read_store(store), options)) {}
ObjectFinder::~ObjectFinder() = default;
ObjectFinder::ObjectFinder(ObjectFinder&&) noexcept = default;

FoundObjects ObjectFinder::find(const RgbdFrame& frame) {
  FoundObjects found;
  found.detections = state_->detector.detect(frame, state_->workspace);
  found.poses = state_->estimator.estimate(frame, found.detections);
  return found;
}

}  // namespace houghstream
