#pragma once

#include "pipeline/types/frame.hpp"

namespace houghstream {

/// A made-up frame of VGA size, a wavy, patterned surface about a metre away, that has been encoded and decoded as
/// frames are that come off the bus. What a process works on before it subscribes, so that its memory, its threads and
/// the codecs' are there when the first real frame comes.
RgbdFrame frame_to_warm_up();

}  // namespace houghstream
