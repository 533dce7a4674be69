#include "tools/view/view_keys.hpp"

#include <algorithm>

namespace houghstream::view {

KeyAction apply_key(int key, FrameViewSettings& settings) {
  constexpr int kEscape = 27;
  constexpr float kStep = 0.05F;
  switch (key) {
    case 'q':
    case kEscape: return KeyAction::kEnd;
    case ' ': settings.paused = !settings.paused; break;
    case 'c': return KeyAction::kNextCamera;
    case 't': return KeyAction::kTeach;
    case 'd': settings.show_depth = !settings.show_depth; break;
    case 'w': settings.show_world = !settings.show_world; break;
    case '3': settings.show_3d = !settings.show_3d; break;
    case '+':
    case '=':  // the same key without shift
      settings.min_score = std::min(settings.min_score + kStep, 1.0F);
      break;
    case '-': settings.min_score = std::max(settings.min_score - kStep, 0.0F); break;
    default: return KeyAction::kNone;
  }
  return KeyAction::kRedraw;
}

void apply_mark(const cv::Rect& dragged, FrameViewSettings& settings) {
  constexpr int kClick_px = 4;
  const bool is_click = dragged.width < kClick_px && dragged.height < kClick_px;
  settings.box = is_click ? cv::Rect() : dragged;
  settings.at = is_click ? std::optional<cv::Point>(dragged.tl()) : std::nullopt;
}

}  // namespace houghstream::view
