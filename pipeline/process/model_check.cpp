#include "pipeline/process/model_check.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace houghstream {

std::optional<std::string> ModelCheck::note(const Detections& detections) {
  constexpr int kMinSamples = 10;
  if (is_done_ || models_.empty() || detections.detections.empty()) return std::nullopt;
  for (const Detection& detection : detections.detections) {
    detected_.insert(detection.class_name);
    is_done_ = is_done_ || models_.count(detection.class_name) > 0;
  }
  return ++checked_ < kMinSamples ? std::nullopt : finish();
}

std::optional<std::string> ModelCheck::finish() {
  if (is_done_ || checked_ == 0) return std::nullopt;
  is_done_ = true;
  return fmt::format("none of what was detected has a model: detected are {}; there are models of {}",
                     fmt::join(detected_, ", "), fmt::join(models_, ", "));
}

}  // namespace houghstream
