#pragma once

#include <future>

#include "pipeline/types/frame.hpp"

namespace houghstream {

/// Makes a synthetic frame of VGA size, a wavy, textured surface about a metre away, that has been encoded and decoded
/// as frames off the bus are. A process works on it before it subscribes, so that its memory, its threads and the
/// codecs' are ready when the first real frame comes.
RgbdFrame make_warm_up_frame();

/// Makes it in a thread of its own while the caller reads forest or models, and has OpenCV's tables for L*a*b*, which
/// take a tenth of a second, made there too: before several threads ask for them at once.
std::shared_future<RgbdFrame> start_warm_up();

/// Threads for what is done once, before the first frame: all cores, however many the work on frames is given.
int warm_up_threads(int threads_of_work);

}  // namespace houghstream
