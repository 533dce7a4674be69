#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <array>
#include <optional>

#include "tools/finder/object_finder.hpp"
#include "tools/python/result_listener.hpp"

// C++ values become Python's here, and back. All functions want the interpreter's lock, but for make_frame().

namespace houghstream {

/// Pixels of a frame as numpy holds them, in rows without gaps.
struct FrameArrays {
  const void* colour = nullptr;  ///< uint8, three to a pixel
  bool is_bgr = false;           ///< else RGB
  const void* depth = nullptr;   ///< uint16 millimetres or float32 metres
  bool is_depth_in_mm = false;
  Camera camera;
};

/// Makes a frame of copies of the arrays. Depth that is no positive number is none. Throws InputError for a camera that
/// is none, and where more than half of the metres are more than 65.535, as millimetres are.
RgbdFrame make_frame(const FrameArrays& arrays);

/// Returns {"utime": , "camera": , "poses": [{...}], "without_pose": [{...}]}, with the names of houghstream.results.
/// Candidates that no pose has confirmed are left out.
pybind11::dict to_python(const FoundObjects& found, const ObjectFinder& finder);

/// Returns such a dict for results that came over a bus; boxes are those of the detections that are known.
pybind11::dict to_python(const PosedDetections& posed);

pybind11::dict to_python(const PlacedWorld& placed_world);

}  // namespace houghstream
