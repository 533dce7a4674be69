#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "pose/model/surface_colour.hpp"

namespace houghstream {

/// Stores the colours of a surface by position: small cubes, and in each of them the sides that the surface shows. It
/// yields the colour at any point of the surface without rendering. An empty one has no colours. The lists have equal
/// lengths and are sorted by cube.
struct SurfaceTexture {
  float detail_m = 1.0F;                 ///< edge of a cube: what is smaller is averaged
  std::vector<std::int64_t> cubes;       ///< once for each of its sides
  std::vector<Eigen::Vector3f> normals;  ///< mean over the side, outwards
  std::vector<Eigen::Vector3f> colours;  ///< mean over the side, CIE L*a*b* on the 8-bit scale

  bool empty() const { return cubes.empty(); }

  /// Returns the colour at or next to a point, object frame, metres, of the side that faces `towards` (any length)
  /// best; nothing where the surface is not there, or turns away.
  std::optional<Eigen::Vector3f> find(const Eigen::Vector3f& point, const Eigen::Vector3f& towards) const;
};

/// Collects points of the surface and makes a SurfaceTexture of them.
class SurfaceTextureBuilder {
 public:
  explicit SurfaceTextureBuilder(double detail_m) : detail_m_(static_cast<float>(detail_m)) {}

  /// Adds a point of the surface, object frame, metres; `normal` has unit length and points outwards.
  void add(const Eigen::Vector3f& point, const Eigen::Vector3f& normal, const LabColour& colour);

  SurfaceTexture make() const;

 private:
  struct Sum {
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    Eigen::Vector3f colour = Eigen::Vector3f::Zero();
    float count = 0.0F;
  };

  float detail_m_;
  /// Sums by cube, and by the axis to which the normal is nearest, with its sign.
  std::map<std::pair<std::int64_t, int>, Sum> sums_;
};

// The names of before, for one release.
using SurfacePrint [[deprecated("is SurfaceTexture now")]] = SurfaceTexture;
using SurfacePrintMaker [[deprecated("is SurfaceTextureBuilder now")]] = SurfaceTextureBuilder;

}  // namespace houghstream
