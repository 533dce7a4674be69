#pragma once

namespace houghstream {

/// Text of uw_boxes.py, which Python runs; the program holds it, so that it needs no file when it runs.
extern const char* const kUwBoxesScript;

}  // namespace houghstream
