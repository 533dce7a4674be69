#pragma once

#include <optional>
#include <string>

#include "tools/view/drawing/frame_view.hpp"

namespace houghstream::view {

/// Why an object has no pose and what helps, in a sentence for people; "" where it has one.
std::string why_no_pose(const ObjectPose* pose);

/// A frame's results as the page reads them: one line of JSON. Lengths are metres, boxes pixels of the colour image,
/// quaternions (w, x, y, z); what is not known is null. `age_ms` is from the frame's arrival until now. `world` is the
/// world of hs-track at that moment, with the poses of its cameras and objects and the boxes about these.
std::string frame_json(const ViewedFrame& viewed, double age_ms, const std::optional<WorldState>& world);

/// Returns the state of the stream as a whole, and of its display in hs-view.
std::string stream_json(const StreamView& stream, const FrameViewSettings& settings);

}  // namespace houghstream::view
