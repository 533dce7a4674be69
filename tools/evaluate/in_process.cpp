#include "tools/evaluate/in_process.hpp"

#include "detector/detector.hpp"
#include "pipeline/base/log_line.hpp"
#include "pose/pose_estimator.hpp"

namespace houghstream {

PublishedResults run_in_process(const BopScene& scene, Forest forest, const DetectionSettings& settings, int every,
                                const std::map<std::string, Mesh>& models) {
  const Detector detector(std::move(forest), settings);
  PoseSettings pose_settings;
  pose_settings.threads = settings.threads;
  const PoseEstimator estimator(models, pose_settings);
  PublishedResults results;
  for (std::size_t i = 0; i < scene.images().size(); i += static_cast<std::size_t>(every)) {
    const RgbdFrame frame = scene.read_frame(i);
    results.detections.push_back(detector.detect(frame));
    if (!models.empty()) results.poses.push_back(estimator.estimate(frame, results.detections.back()));
    log_debug("frame {} of {}: {} detections", i + 1, scene.images().size(),
              results.detections.back().detections.size());
  }
  return results;
}

}  // namespace houghstream
