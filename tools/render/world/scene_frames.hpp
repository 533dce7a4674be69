#pragma once

#include <string>
#include <vector>

#include "drivers/datasets/bop_dataset.hpp"
#include "pipeline/types/frame.hpp"
#include "tools/render/world/optics/shading.hpp"
#include "tools/render/world/scenes.hpp"

namespace houghstream::world {

/// Holds a rendered frame with the ground truth of the taught objects in it.
struct RenderedFrame {
  RgbdFrame frame;
  std::vector<GroundTruthObject> objects;  ///< in the order of their ids; only those that are visible enough
  std::vector<cv::Mat> visible_masks;      ///< CV_8UC1 0/255, one per object
};

/// Kind of the depth sensor. All training views are rendered with the first; the second shows how much a result depends
/// on the sensor.
enum class SensorKind : std::uint8_t {
  kStructuredLight,  ///< optics/depth_sensor.hpp, and an image in plain sRGB
  kTimeOfFlight      ///< optics/time_of_flight.hpp, and the image of other_colour_camera() (optics/photo.hpp)
};

/// Parses "structured_light" or "time_of_flight". Throws InputError naming them for another.
SensorKind parse_sensor(const std::string& name);

/// Renders colour and measured depth seen from a camera. `noise_seed` names the frame's noise.
RenderedFrame render_frame(const LitWorld& lit_world, const Eigen::Isometry3d& T_camera_world, std::uint64_t noise_seed,
                           SensorKind sensor = SensorKind::kStructuredLight);

/// Renders the sensors' images of a view of the world, structured light unless `sensor` is another one, with the ground
/// truth.
RenderedFrame record_view(const LitWorld& lit_world, const Eigen::Isometry3d& T_camera_world, const ShadedView& view,
                          std::uint64_t noise_seed, SensorKind sensor = SensorKind::kStructuredLight);

/// Renders frame `index` of `count` along the scene's camera path. The utime is left 0: sources stamp their frames.
RenderedFrame render_scene_frame(const Scene& scene, const LitWorld& lit_world, int index, int count,
                                 SensorKind sensor = SensorKind::kStructuredLight);

}  // namespace houghstream::world
