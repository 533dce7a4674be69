#include "tools/view/http/page_board.hpp"

#include <algorithm>
#include <utility>

namespace houghstream::view {

bool PageBoard::is_looked_at() const {
  const std::lock_guard lock(mutex_);
  return viewers_ > 0 ||
         std::any_of(pictures_.begin(), pictures_.end(), [this](const Picture& picture) { return is_wanted(picture); });
}

std::vector<PageView> PageBoard::wanted() const {
  const std::lock_guard lock(mutex_);
  std::vector<PageView> views;
  for (std::size_t i = 0; i < kPageViews; ++i) {
    if (is_wanted(pictures_[i])) views.push_back(static_cast<PageView>(i));
  }
  return views;
}

std::vector<PageView> PageBoard::missing() const {
  const std::lock_guard lock(mutex_);
  std::vector<PageView> views;
  for (std::size_t i = 0; i < kPageViews; ++i) {
    if (pictures_[i].waiting > 0 && pictures_[i].frame_number < news_.frame_number)
      views.push_back(static_cast<PageView>(i));
  }
  return views;
}

void PageBoard::put_frame(std::string json) {
  const std::lock_guard lock(mutex_);
  ++news_.frame_number;
  news_.frame = std::move(json);
  changed_.notify_all();
}

void PageBoard::put_picture(PageView view, std::vector<std::uint8_t> jpeg) {
  const std::lock_guard lock(mutex_);
  Picture& picture = pictures_[static_cast<std::size_t>(view)];
  picture.jpeg = std::make_shared<const std::vector<std::uint8_t>>(std::move(jpeg));
  picture.frame_number = news_.frame_number;
  changed_.notify_all();
}

void PageBoard::put_stream(std::string json) {
  const std::lock_guard lock(mutex_);
  ++news_.stream_number;
  news_.stream = std::move(json);
  changed_.notify_all();
}

PageCommands PageBoard::take_orders() {
  const std::lock_guard lock(mutex_);
  return std::exchange(orders_, {});
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

std::optional<PageUpdates> PageBoard::news_after(const PageUpdates& seen, std::chrono::milliseconds timeout) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, timeout, [&] {
    return closed_ || news_.frame_number > seen.frame_number || news_.stream_number > seen.stream_number;
  });
  if (closed_) return std::nullopt;
  PageUpdates fresh = news_;
  if (news_.frame_number <= seen.frame_number) fresh.frame.clear();
  if (news_.stream_number <= seen.stream_number) fresh.stream.clear();
  return fresh;
}

Jpeg PageBoard::picture(PageView view, std::chrono::milliseconds timeout) {
  std::unique_lock lock(mutex_);
  Picture& picture = pictures_[static_cast<std::size_t>(view)];
  picture.asked = Clock::now();
  ++picture.waiting;
  const std::int64_t wanted = std::max<std::int64_t>(news_.frame_number, 1);
  changed_.wait_for(lock, timeout, [&] { return closed_ || picture.frame_number >= wanted; });
  --picture.waiting;
  return picture.jpeg;
}

void PageBoard::order(const PageCommands& orders) {
  const std::lock_guard lock(mutex_);
  if (orders.paused) orders_.paused = orders.paused;
  if (orders.min_score) orders_.min_score = orders.min_score;
  orders_.next_camera = orders_.next_camera || orders.next_camera;
}

void PageBoard::close() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  changed_.notify_all();
}

}  // namespace houghstream::view
