#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/render/world/training_views.hpp"

namespace houghstream::render {

/// Options of all jobs.
struct RenderOptions {
  std::filesystem::path out;  ///< folder to write to
  std::uint64_t seed = 1;     ///< seed of training rooms; test scenes have seeds of their own
  int threads = 2;
  bool replace = false;  ///< images and models that are there give way; else they are a reason to refuse
};

/// Writes the objects as a BOP models folder, OUT/models. Throws InputError where models exist that may not be
/// replaced.
void write_models(const RenderOptions& options, const std::vector<world::TaughtObject>& objects);

/// Empties a scene's folder of images, since frames of an earlier, longer run must not stay behind, and returns it.
/// Throws InputError where images exist that may not be replaced, since their owner is unknown.
std::filesystem::path fresh_scene(const RenderOptions& options, const std::filesystem::path& folder);

/// Renders OUT/00000I/ for each object id I, and OUT/models/. `objects` holds names, or only "all" (the demo's four
/// classes) or only "all_20" (twenty_class_ids()) or "all_40" (forty_object_ids()).
void render_training(const RenderOptions& options, const std::vector<std::string>& objects,
                     const world::TurntableSettings& turntable);

/// Renders one BOP scene of `count` frames of training rooms without the objects into OUT/.
void render_background(const RenderOptions& options, int count);

/// Selects images of a test scene.
struct SceneJob {
  std::string name;  ///< see world/scenes.hpp
  int frames = 300;  ///< along the camera's whole way
  int every = 1;     ///< only every so-many-th of them is written
  world::SensorKind sensor = world::SensorKind::kStructuredLight;
};

/// Renders one BOP scene into OUT/; OUT/models/ has the demo's four classes or, where the scene holds others, all
/// twenty.
void render_scene(const RenderOptions& options, const SceneJob& job);

}  // namespace houghstream::render
