#pragma once

#include <functional>
#include <string>

#include "tools/render/world/scene_frames.hpp"

namespace houghstream::render {

/// Renders `count` frames on `threads` threads and hands them to `write` one at a time, in order; shows progress on
/// standard error under `title`. An exception of either ends the loop and is rethrown.
void render_in_order(const std::string& title, int threads, int count,
                     const std::function<world::RenderedFrame(int)>& render,
                     const std::function<void(const world::RenderedFrame&)>& write);

}  // namespace houghstream::render
