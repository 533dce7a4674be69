#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/types/training_view.hpp"

namespace houghstream::teach {

/// Rooms without the objects, to teach what they are not.
struct BackgroundSettings {
  std::filesystem::path cache;        ///< folder in which rendered rooms are kept; empty = cache_folder()
  std::vector<std::string> further;   ///< a user's own, beside the rendered ones: "bop:DIR" or "images:DIR"
  std::optional<std::string> camera;  ///< of images:DIR, see parse_camera
  int count = 215;                    ///< rendered frames
  int threads = 2;
};

/// The rendered rooms, which are rendered into the cache where it lacks them, and the user's. Throws InputError where a
/// folder cannot be written or read.
std::vector<TrainingView> read_backgrounds(const BackgroundSettings& settings);

}  // namespace houghstream::teach
