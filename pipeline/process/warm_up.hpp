#pragma once

#include <future>

#include "pipeline/types/frame.hpp"

namespace houghstream {

/// Makes a synthetic frame of VGA size, a wavy, textured surface about a metre away, that has been encoded and decoded
/// as frames off the bus are. A process works on it before it subscribes, so that its memory, its threads and the
/// codecs' are ready when the first real frame comes.
RgbdFrame make_warm_up_frame();

/// Makes that frame in a thread of its own while the caller reads forest or models. The thread also initialises
/// OpenCV's tables for L*a*b*, which takes a tenth of a second, before several threads need them at once.
std::shared_future<RgbdFrame> start_warm_up();

/// Returns the number of threads for work before the first frame: all cores up to eight, even where the work on frames
/// has fewer.
int warm_up_threads(int threads_of_work);

}  // namespace houghstream
