#pragma once

#include <optional>
#include <string>

#include "pipeline/channels.hpp"
#include "tools/view/frame_matcher.hpp"
#include "tools/view/frame_view.hpp"
#include "tools/view/view_outputs.hpp"

namespace houghstream {

/// What hs-view does.
struct ViewerSettings {
  std::string lcm_url;                          ///< "" = LCM's default
  std::string frame_channel = channel::kFrame;  ///< images_t
  std::optional<Camera> camera;                 ///< of frames that carry none of their own
  std::string models;                           ///< folder of models for outlines; "" = none
  double model_unit_m = 1e-3;                   ///< unit of the models' coordinates
  double duration = 0.0;                        ///< seconds; 0 = until asked to end
  FrameViewSettings picture;
  bool preview = false;  ///< send each picture on the preview channel
  OutputSettings outputs;

  /// Files or the preview are asked for: then there is no window.
  bool headless() const {
    return preview || !outputs.snapshot.empty() || !outputs.video.empty() || !outputs.pictures.empty();
  }
};

/// Shows the stream until a stop signal, the end of the duration, the closing of the window, or until the snapshot is
/// there and nothing else was asked for. Throws InputError.
void run_viewer(const ViewerSettings& settings);

}  // namespace houghstream
