#include "tools/view/http/live_page.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "pipeline/base/log_line.hpp"
#include "pipeline/messages/codecs.hpp"
#include "tools/view/drawing/rotated_view.hpp"
#include "tools/view/drawing/world_view.hpp"
#include "tools/view/http/page_json.hpp"

namespace houghstream::view {
namespace {

constexpr int kJpegQuality = 75;
constexpr std::chrono::seconds kUpdateInterval(1);

// Returns small depth, which is shown beside the colour image: of a large image every second or third pixel is drawn,
// and encoded.
cv::Mat small_depth(const cv::Mat& depth, const FrameViewSettings& settings) {
  constexpr int kWidth = 320;  // pixels, about
  const int step = std::max(depth.cols / kWidth, 1);
  cv::Mat small;
  cv::resize(depth, small, {std::max(depth.cols / step, 1), std::max(depth.rows / step, 1)}, 0.0, 0.0,
             cv::INTER_NEAREST);
  return colour_depth(small, settings.depth_near, settings.depth_far);
}

// The image has about the shape of the frame, but is smaller than one: it is small beside the colour image, and its
// words must be legible. A frame may be a single row or column of pixels.
cv::Mat world_from_above(const std::optional<WorldState>& world, const cv::Size& frame) {
  constexpr int kWidth = 440;      // pixels
  constexpr int kMinHeight = 110;  // pixels
  constexpr int kMaxHeight = 880;  // pixels
  const int height = std::clamp(kWidth * frame.height / frame.width, kMinHeight, kMaxHeight);
  return draw_world_from_above(world.value_or(WorldState{}), {kWidth, height});
}

cv::Mat drawn(PageView view, const PageContent& content) {
  const ViewedFrame& viewed = content.viewed;
  switch (view) {
    case PageView::kDepth: return small_depth(viewed.frame.depth, content.settings);
    case PageView::k3d: return draw_rotated_view(viewed.frame, viewed.poses, content.models);
    case PageView::kWorld: return world_from_above(content.stream.state.world, viewed.frame.colour.size());
    case PageView::kColour: break;
  }
  return draw_over_colour(viewed, content.models, content.settings, content.stream);
}

HttpAddress address_of(const std::string& text, const std::vector<std::string>& names) {
  HttpAddress address = parse_http_address(text);
  for (const std::string& name : names) address.names.push_back(parse_host_name(name));
  return address;
}

}  // namespace

LivePage::LivePage(const std::string& address, const std::vector<std::string>& names)
    : server_(address_of(address, names), board_) {
  log_info("page: {}", server_.url());
  for (const std::string& url : server_.network_urls()) log_info("page for phones and other machines: {}", url);
}

void LivePage::draw(const std::vector<PageView>& views, const PageContent& content) {
  for (const PageView view : views) {
    std::vector<std::uint8_t> jpeg;
    try {
      jpeg = encode_jpeg(drawn(view, content), kJpegQuality);
    } catch (const std::exception&) {  // OpenCV's too
      board_.put_image(view, {});
      throw;
    }
    board_.put_image(view, std::move(jpeg));
  }
}

void LivePage::show(const PageContent& content) {
  const auto now = PageBoard::Clock::now();
  if (content.viewed.frame.id != shown_) first_shown_ = now;
  shown_ = content.viewed.frame.id;
  const std::chrono::duration<double, std::milli> since = now - first_shown_;
  const ViewedFrame viewed = without_weak(content.viewed, content.settings.min_score);
  const double latency_ms = viewed.pose_latency_ms.value_or(viewed.detect_latency_ms.value_or(0.0));
  board_.put_frame(frame_json(viewed, latency_ms + since.count(), content.stream.state.world));
  draw(board_.wanted(), {viewed, content.models, content.settings, content.stream});
}

bool LivePage::is_due() const {
  return has_viewers() && (PageBoard::Clock::now() - updated_ >= kUpdateInterval || !board_.missing().empty());
}

void LivePage::catch_up(const std::optional<ViewedFrame>& viewed, const ClassModels& models,
                        const FrameViewSettings& settings, const StreamView& stream) {
  updated_ = PageBoard::Clock::now();
  board_.put_stream(stream_json(stream, settings));
  if (const auto missing = board_.missing(); viewed && !missing.empty())
    draw(missing, {without_weak(*viewed, settings.min_score), models, settings, stream});
}

}  // namespace houghstream::view
