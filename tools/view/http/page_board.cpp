#include "tools/view/http/page_board.hpp"

#include <algorithm>
#include <utility>

namespace houghstream::view {

bool PageBoard::has_viewers() const {
  const std::lock_guard lock(mutex_);
  return viewers_ > 0 ||
         std::any_of(images_.begin(), images_.end(), [this](const Image& image) { return is_wanted(image); });
}

std::vector<PageView> PageBoard::wanted() const {
  const std::lock_guard lock(mutex_);
  std::vector<PageView> views;
  for (std::size_t i = 0; i < kPageViews; ++i) {
    if (is_wanted(images_[i])) views.push_back(static_cast<PageView>(i));
  }
  return views;
}

std::vector<PageView> PageBoard::missing() const {
  const std::lock_guard lock(mutex_);
  std::vector<PageView> views;
  for (std::size_t i = 0; i < kPageViews; ++i) {
    if (images_[i].waiting > 0 && images_[i].frame_number < updates_.frame_number)
      views.push_back(static_cast<PageView>(i));
  }
  return views;
}

void PageBoard::put_frame(std::string json) {
  const std::lock_guard lock(mutex_);
  ++updates_.frame_number;
  updates_.frame = std::move(json);
  changed_.notify_all();
}

void PageBoard::put_image(PageView view, std::vector<std::uint8_t> jpeg) {
  const std::lock_guard lock(mutex_);
  Image& image = images_[static_cast<std::size_t>(view)];
  image.jpeg = std::make_shared<const std::vector<std::uint8_t>>(std::move(jpeg));
  image.frame_number = updates_.frame_number;
  changed_.notify_all();
}

void PageBoard::put_stream(std::string json) {
  const std::lock_guard lock(mutex_);
  ++updates_.stream_number;
  updates_.stream = std::move(json);
  changed_.notify_all();
}

PageCommands PageBoard::pop_commands() {
  const std::lock_guard lock(mutex_);
  return std::exchange(commands_, {});
}

bool PageBoard::join() {
  const std::lock_guard lock(mutex_);
  if (viewers_ >= kMaxViewers) return false;
  ++viewers_;
  return true;
}

void PageBoard::leave() {
  const std::lock_guard lock(mutex_);
  --viewers_;
}

std::optional<PageUpdates> PageBoard::updates_after(const PageUpdates& seen, std::chrono::milliseconds timeout) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, timeout, [&] {
    return closed_ || updates_.frame_number > seen.frame_number || updates_.stream_number > seen.stream_number;
  });
  if (closed_) return std::nullopt;
  PageUpdates fresh = updates_;
  if (updates_.frame_number <= seen.frame_number) fresh.frame.clear();
  if (updates_.stream_number <= seen.stream_number) fresh.stream.clear();
  return fresh;
}

PageImage PageBoard::image(PageView view, std::chrono::milliseconds timeout) {
  std::unique_lock lock(mutex_);
  Image& image = images_[static_cast<std::size_t>(view)];
  image.asked = Clock::now();
  ++image.waiting;
  const std::int64_t wanted = std::max<std::int64_t>(updates_.frame_number, 1);
  changed_.wait_for(lock, timeout, [&] { return closed_ || image.frame_number >= wanted; });
  --image.waiting;
  return {image.jpeg, image.frame_number};
}

void PageBoard::push_command(const PageCommands& commands) {
  const std::lock_guard lock(mutex_);
  if (commands.paused) commands_.paused = commands.paused;
  if (commands.min_score) commands_.min_score = commands.min_score;
  commands_.next_camera = commands_.next_camera || commands.next_camera;
}

void PageBoard::close() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  changed_.notify_all();
}

}  // namespace houghstream::view
