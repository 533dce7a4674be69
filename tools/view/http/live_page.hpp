#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "tools/view/drawing/frame_view.hpp"
#include "tools/view/http/page_server.hpp"

namespace houghstream::view {

/// Refers to a frame and the contents of its page.
struct PageContent {
  const ViewedFrame& viewed;
  const ClassModels& models;
  const FrameViewSettings& settings;
  const StreamView& stream;
};

/// Serves the stream as a page for browsers. It draws and encodes the views that viewers have open, in the calling
/// thread; without viewers it draws nothing.
class LivePage {
 public:
  /// Serves at "[ADDRESS:]PORT", which may be asked for by these names too, and logs where. Throws InputError.
  explicit LivePage(const std::string& address, const std::vector<std::string>& names = {});

  bool has_viewers() const { return board_.has_viewers(); }
  PageCommands pop_commands() { return board_.pop_commands(); }

  /// Publishes a frame to the page and draws the requested views of it. Throws InputError as draw_overlay does.
  void show(const PageContent& content);
  /// Returns whether a viewer waits for an image of the frame that was shown last, or the stream was not reported for a
  /// second.
  bool is_due() const;
  /// Draws that image, and publishes the state of the stream. Throws where an image cannot be drawn; its viewers then
  /// stop waiting.
  void catch_up(const std::optional<ViewedFrame>& viewed, const ClassModels& models, const FrameViewSettings& settings,
                const StreamView& stream);

  const PageServer& server() const { return server_; }

 private:
  void draw(const std::vector<PageView>& views, const PageContent& content);

  PageBoard board_;
  PageServer server_;
  FrameId shown_;
  PageBoard::Clock::time_point first_shown_;
  PageBoard::Clock::time_point updated_;
};

}  // namespace houghstream::view
