#include "tools/finder/object_finder.hpp"

#include <algorithm>
#include <utility>

#include "detector/stages.hpp"
#include "drivers/store/object_store.hpp"
#include "pipeline/base/checks.hpp"
#include "pose/motion/pose_covariance.hpp"
#include "pose/pose_estimator.hpp"
#include "tools/finder/search_options.hpp"
#include "tools/finder/stored_forest.hpp"
#include "tools/finder/stored_precision.hpp"
#include "tools/finder/stored_quality.hpp"

namespace houghstream {
namespace {

Detector make_detector(const store::ObjectStore& store, const FinderOptions& options) {
  SearchOptions search;
  search.threads = options.threads;
  search.threshold = options.threshold;
  search.candidates_from = kCandidatesFrom;
  return detector_of(load_store_forests(store, options.threads), with_precision(search, store, options.precision));
}

PoseEstimator make_estimator(const store::ObjectStore& store, const FinderOptions& options) {
  PoseSettings common;
  common.threads = options.threads;
  PoseSettings settings = pose_settings_of(common, store, options.min_quality);
  if (options.precision) set_precision(*options.precision, store, settings);
  return PoseEstimator(store::load_store_meshes(store), std::move(settings));
}

const FinderOptions& checked(const FinderOptions& options) {
  require(!options.precision || (!options.threshold && !options.min_quality),
          "precision beside threshold or min_quality, expected it in their place");
  return options;
}

std::vector<FinderObject> objects_of(const PoseEstimator& estimator) {
  std::vector<FinderObject> objects;
  for (const auto& [name, model] : estimator.models())
    objects.push_back({name, mesh_bounds(model.mesh).cast<double>()});
  return objects;
}

}  // namespace

struct ObjectFinder::State {
  State(const store::ObjectStore& store, const FinderOptions& options)
      : detector(make_detector(store, options)),
        estimator(make_estimator(store, options)),
        objects(objects_of(estimator)) {}

  Detector detector;
  PoseEstimator estimator;
  std::vector<FinderObject> objects;
  DetectorWorkspace workspace;
};

ObjectFinder::ObjectFinder(const std::filesystem::path& store, const FinderOptions& options)
    : state_(std::make_unique<State>(store::read_store(store), checked(options))) {}
ObjectFinder::~ObjectFinder() = default;
ObjectFinder::ObjectFinder(ObjectFinder&&) noexcept = default;

FoundObjects ObjectFinder::find(const RgbdFrame& frame) {
  FoundObjects found;
  found.detections = state_->detector.detect(frame, state_->workspace);
  found.poses = state_->estimator.estimate(frame, found.detections);
  return found;
}

const std::vector<FinderObject>& ObjectFinder::objects() const {
  return state_->objects;
}

Covariance6 ObjectFinder::covariance(const ObjectPose& pose) const {
  require(pose.T_camera_object.has_value(), "{}: found {}, expected a pose", pose.class_name, to_string(pose.status));
  const auto object = std::find_if(state_->objects.begin(), state_->objects.end(),
                                   [&](const FinderObject& known) { return known.name == pose.class_name; });
  require(object != state_->objects.end(), "{}: found no such object in the finder's store", pose.class_name);
  const ObjectExtent extent{object->bounds.center(), 0.5 * object->bounds.sizes().norm()};
  return measured_pose_covariance(pose, Eigen::Isometry3d::Identity(), extent);
}

}  // namespace houghstream
