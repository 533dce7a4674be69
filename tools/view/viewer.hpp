#pragma once

#include <string>

#include "pipeline/messages/channels.hpp"
#include "tools/view/frame_renderer.hpp"

namespace houghstream::view {

/// Settings of hs-view.
struct ViewerSettings {
  std::string lcm_url;                           ///< "" = LCM's default
  std::string frame_channels = channel::kFrame;  ///< a ChannelPattern; of several cameras one is shown at a time
  double duration = 0.0;                         ///< seconds; 0 = until asked to end
  FrameRendererSettings show;
};

/// Shows the stream until a stop signal, the end of the duration, the closing of the window, or until the snapshot is
/// there and nothing else was asked for. Throws InputError.
void run_viewer(const ViewerSettings& settings);

}  // namespace houghstream::view
