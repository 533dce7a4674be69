#include "tools/teach/show/camera_take.hpp"

#include "pipeline/base/stop_signal.hpp"

namespace houghstream::teach {

bool is_live(const std::string& source) {
  return source.rfind("openni2", 0) == 0 || source.rfind("stream:", 0) == 0;
}

std::optional<RgbdFrame> CameraTake::next() {
  std::optional<RgbdFrame> frame;
  if (!is_over_) frame = frames_();
  if (!frame) release_stop_signals();
  return frame;
}

void CameraTake::progress(const ShowProgress& now) {
  if (now.state == ShowState::kTracking && enough_(now)) is_over_ = true;
  if (observer_ != nullptr) observer_->progress(now);
}

}  // namespace houghstream::teach
