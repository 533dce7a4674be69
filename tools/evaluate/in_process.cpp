#include "tools/evaluate/in_process.hpp"

#include "detector/stages.hpp"
#include "pipeline/base/log_line.hpp"
#include "pose/pose_estimator.hpp"

namespace houghstream {

PublishedResults run_in_process(const BopScene& scene, const Detector& detector, int every,
                                const std::map<std::string, Mesh>& models) {
  PoseSettings pose_settings;
  pose_settings.threads = detector.settings().threads;
  const PoseEstimator estimator(models, pose_settings);
  DetectorWorkspace workspace;
  PublishedResults results;
  for (std::size_t i = 0; i < scene.images().size(); i += static_cast<std::size_t>(every)) {
    const RgbdFrame frame = scene.read_frame(i);
    results.detections.push_back(detector.detect(frame, workspace));
    if (!models.empty()) results.poses.push_back(estimator.estimate(frame, results.detections.back()));
    log_debug("frame {} of {}: {} detections", i + 1, scene.images().size(),
              results.detections.back().detections.size());
  }
  return results;
}

}  // namespace houghstream
