#include "tools/render/world/objects/asset.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "pipeline/base/checks.hpp"

namespace houghstream::world {
namespace {

constexpr int kMinMipPx = 4;

float texel_density(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  const auto& [a, b, c] = triangle;
  const float area = (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).norm();
  const Eigen::Vector2f size(static_cast<float>(mesh.texture.cols), static_cast<float>(mesh.texture.rows));
  const Eigen::Vector2f ab = (mesh.uvs[b] - mesh.uvs[a]).cwiseProduct(size);
  const Eigen::Vector2f ac = (mesh.uvs[c] - mesh.uvs[a]).cwiseProduct(size);
  const float texels = std::abs(ab.x() * ac.y() - ab.y() * ac.x());
  return area > 0.0F ? std::sqrt(texels / area) : 0.0F;
}

}  // namespace

std::shared_ptr<const Asset> make_asset(std::string name, Mesh mesh, float specular, float emission) {
  const bool textured = mesh.uvs.size() == mesh.vertices.size() && !mesh.texture.empty();
  const bool coloured = mesh.texture.empty() && mesh.colours.size() == mesh.vertices.size();
  require(mesh.normals.size() == mesh.vertices.size() && (textured || coloured),
          "{}: mesh without normals, or with neither texture (and its coordinates) nor colours", name);
  auto thing = std::make_shared<Asset>();
  thing->name = std::move(name);
  thing->mesh = std::move(mesh);
  thing->specular = specular;
  thing->emission = emission;
  if (coloured) return thing;
  thing->mip_levels = {thing->mesh.texture};
  while (std::min(thing->mip_levels.back().cols, thing->mip_levels.back().rows) >= 2 * kMinMipPx) {
    const cv::Mat& finer = thing->mip_levels.back();
    cv::Mat coarser;
    cv::resize(finer, coarser, {finer.cols / 2, finer.rows / 2}, 0, 0, cv::INTER_AREA);
    thing->mip_levels.push_back(coarser);
  }
  for (const auto& triangle : thing->mesh.triangles)
    thing->texels_per_m.push_back(texel_density(thing->mesh, triangle));
  return thing;
}

double thing_height(const Asset& thing) {
  return mesh_bounds(thing.mesh).sizes().z();
}

}  // namespace houghstream::world
