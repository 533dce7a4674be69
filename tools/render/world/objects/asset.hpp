#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "pipeline/geometry/mesh.hpp"

namespace houghstream::world {

/// Something that stands in a rendered world: its surface, and what shading needs to know of it beforehand.
struct Asset {
  std::string name;
  Mesh mesh;
  float specular = 0.1F;  ///< strength of the mirror-like part of the reflection, 0 = matt to 1
  float emission = 0.0F;  ///< share of its texture that it emits by itself (screens, windows), 0 to 1
  /// Texture, CV_8UC3, each level half the size of the one before. It is empty where vertices have colours instead.
  std::vector<cv::Mat> mip_levels;
  std::vector<float> texels_per_m;  ///< per triangle, of level 0; empty without texture
};

/// Prepares a finished mesh for shading: it has normals, and a texture with its coordinates or a colour per vertex.
std::shared_ptr<const Asset> make_asset(std::string name, Mesh mesh, float specular, float emission = 0.0F);

using AssetPtr = std::shared_ptr<const Asset>;

/// Returns the extent of its mesh along z, metres.
double thing_height(const Asset& thing);

}  // namespace houghstream::world
