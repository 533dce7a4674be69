#include "tools/view/shown_camera.hpp"

namespace houghstream::view {

void ShownCamera::note(const std::string& channel) {
  const std::lock_guard lock(mutex_);
  if (heard_.empty()) shown_ = channel;
  heard_.insert(channel);
}

void ShownCamera::next() {
  const std::lock_guard lock(mutex_);
  if (heard_.empty()) return;
  const auto after = heard_.upper_bound(shown_);
  shown_ = after == heard_.end() ? *heard_.begin() : *after;
}

bool ShownCamera::is_shown(const std::string& channel) const {
  const std::lock_guard lock(mutex_);
  return heard_.empty() || channel == shown_;
}

std::vector<std::string> ShownCamera::heard() const {
  const std::lock_guard lock(mutex_);
  return {heard_.begin(), heard_.end()};
}

}  // namespace houghstream::view
