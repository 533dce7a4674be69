#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace houghstream::view {

/// Views of a frame, and of the world after it, on a page.
enum class PageView { kColour, kDepth, k3d, kWorld };
constexpr std::size_t kPageViews = 4;

using Jpeg = std::shared_ptr<const std::vector<std::uint8_t>>;

/// Holds an encoded image and the number of the frame that it was drawn of.
struct PageImage {
  Jpeg jpeg;  ///< nothing while none was drawn; empty where it cannot be drawn
  std::int64_t frame_number = 0;
};

/// Holds the commands of the page's buttons.
struct PageCommands {
  std::optional<bool> paused;
  std::optional<float> min_score;
  bool next_camera = false;

  bool empty() const { return !paused && !min_score && !next_camera; }
};

/// Holds the state that pages receive as numbered JSON: an update that a page does not have yet has a higher number
/// than its last one.
struct PageUpdates {
  std::int64_t frame_number = 0;
  std::string frame;
  std::int64_t stream_number = 0;
  std::string stream;
};

/// Connects the thread that draws with those that serve pages: it holds the latest of each view, the views that are
/// open, and the commands of their buttons. Any function may be called from any thread.
class PageBoard {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr int kMaxViewers = 8;
  static constexpr std::chrono::seconds kViewTimeout{2};  ///< after a request its view is drawn for so long

  /// The thread that draws calls these. Returns whether a page listens, or requested an image recently.
  bool has_viewers() const;
  /// Views that were asked for of late.
  std::vector<PageView> wanted() const;
  /// Returns views that a viewer waits for, and that were not drawn of the frame that is shown.
  std::vector<PageView> missing() const;
  /// Puts the next frame. Its images follow.
  void put_frame(std::string json);
  void put_image(PageView view, std::vector<std::uint8_t> jpeg);
  void put_stream(std::string json);
  PageCommands pop_commands();

  /// The threads that serve pages call these. Returns false where kMaxViewers listen already.
  bool join();
  void leave();
  /// Waits until there is more than `seen`, or for `timeout`; what is not new is empty. Nothing once it is closed.
  std::optional<PageUpdates> updates_after(const PageUpdates& seen, std::chrono::milliseconds timeout);
  /// The image of the frame that is shown, waited for if need be; an older one, or nothing, after `timeout`.
  PageImage image(PageView view, std::chrono::milliseconds timeout);
  void push_command(const PageCommands& commands);

  /// Ends all waiting.
  void close();

 private:
  struct Image {
    Jpeg jpeg;
    std::int64_t frame_number = 0;
    Clock::time_point asked = Clock::time_point::min();
    int waiting = 0;
  };
  bool is_wanted(const Image& image) const { return Clock::now() - kViewTimeout < image.asked; }

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::array<Image, kPageViews> images_;
  PageUpdates updates_;
  PageCommands commands_;
  int viewers_ = 0;
  bool closed_ = false;
};

}  // namespace houghstream::view
