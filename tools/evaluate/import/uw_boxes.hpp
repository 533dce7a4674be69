#pragma once

namespace houghstream {

/// uw_boxes.py, which Python runs; it lies in the program, which needs no file of it when it runs.
extern const char* const kUwBoxesScript;

}  // namespace houghstream
