#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "detector/detector.hpp"
#include "drivers/datasets/bop_dataset.hpp"
#include "pipeline/geometry/mesh.hpp"
#include "pose/pose_settings.hpp"
#include "tools/evaluate/metrics/evaluated_frame.hpp"

namespace houghstream {

/// Finds the objects in a frame, with memory of its own that it uses again. For one frame at a time.
using FrameSearch = std::function<Detections(const RgbdFrame&)>;

/// Makes a search of the forests of a store's groups: detector_search, or what a study puts in its place.
using MakeSearch = std::function<FrameSearch(std::vector<Forest> groups, const DetectionSettings& settings)>;

/// Returns a search by Detector.
FrameSearch detector_search(std::vector<Forest> groups, const DetectionSettings& settings);

/// Rules of publication.
struct PublishingRules {
  float score = 0.0F;            ///< lowest score of a detection that is reported by itself
  float candidates_from = 1.0F;  ///< see EvidenceSettings
  PoseSettings pose = {};        ///< score from which poses are estimated, and quality from which they are published
  std::map<std::string, float> class_scores = {};  ///< `score` of single classes, by name

  /// Returns the lowest score of a detection of this class that is reported by itself.
  float score_of(const std::string& class_name) const {
    const auto known = class_scores.find(class_name);
    return known != class_scores.end() ? known->second : score;
  }
};

/// Detects, and estimates poses where there are models, without LCM.
class InProcess {
 public:
  /// Makes a search and an estimation. `settings` may find detections of lower score than those that would be
  /// published, to rank and judge them too. Models are by class name.
  InProcess(std::vector<Forest> groups, const DetectionSettings& settings, const MakeSearch& make_search,
            const std::map<std::string, Mesh>& models, const PublishingRules& rules);
  ~InProcess();

  /// Returns the least score of the detections that run() lists.
  float ranked_from() const;

  /// Fills in the results of these frames of the scene: all detections, without their rotations, and whether each would
  /// be reported or be a candidate; the poses that would be published, those of detections that would not be sent being
  /// kLowScore; the poses of all from PoseSettings::min_score on.
  /// Where there are models, the stages' times are those of a search for what would be published.
  void run(const BopScene& scene, std::vector<EvaluatedFrame>& frames);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace houghstream
