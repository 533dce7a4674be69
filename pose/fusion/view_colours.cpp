#include "pose/fusion/view_colours.hpp"

#include <cmath>

#include "pipeline/base/parallel.hpp"

namespace houghstream::fusion {
namespace {

struct Sum {
  Eigen::Vector3d colour = Eigen::Vector3d::Zero();  // BGR
  double weight = 0.0;
};

void add_view(const DepthView& view, const Eigen::Vector3d& vertex, const Eigen::Vector3d& normal, double tolerance_m,
              Sum& sum) {
  const Eigen::Vector3d p = view.T_camera_object * vertex;
  const double facing = -(view.T_camera_object.linear() * normal).dot(p.normalized());
  const auto px = view.pixel_of(p);
  if (facing <= 0.0 || !px || !(std::abs(view.depth.at<float>(*px) - p.z()) < tolerance_m)) return;
  // The few most frontal views decide: with all of them, errors of a pixel would blur the print.
  const double weight = std::pow(facing, 8);
  const cv::Vec3b& colour = view.colour.at<cv::Vec3b>(*px);
  sum.colour += weight * Eigen::Vector3d(colour[0], colour[1], colour[2]);
  sum.weight += weight;
}

/// From the seen to the unseen, ring by ring.
void spread(const Mesh& mesh, std::vector<Sum>& sums) {
  for (bool grew = true; grew;) {
    grew = false;
    std::vector<Sum> more(sums.size());
    for (const auto& t : mesh.triangles) {
      for (int k = 0; k < 3; ++k) {
        const Sum& from = sums[t[k]];
        if (from.weight <= 0.0) continue;
        for (const std::uint32_t to : t) {
          if (sums[to].weight > 0.0) continue;
          more[to].colour += from.colour / from.weight;
          more[to].weight += 1.0;
          grew = true;
        }
      }
    }
    for (std::size_t i = 0; i < sums.size(); ++i) {
      if (more[i].weight > 0.0) sums[i] = more[i];
    }
  }
}

}  // namespace

std::vector<bool> colour_mesh(const std::vector<DepthView>& views, double tolerance_m, int threads, Mesh& mesh) {
  std::vector<Sum> sums(mesh.vertices.size());
  parallel_for(threads, static_cast<int>(sums.size()), [&](int i) {
    for (const DepthView& view : views) {
      add_view(view, mesh.vertices[i].cast<double>(), mesh.normals[i].cast<double>(), tolerance_m, sums[i]);
    }
  });
  std::vector<bool> seen;
  seen.reserve(sums.size());
  for (const Sum& sum : sums) seen.push_back(sum.weight > 0.0);
  spread(mesh, sums);
  mesh.colours.clear();
  for (const Sum& sum : sums) {
    const Eigen::Vector3d c = sum.weight > 0.0 ? Eigen::Vector3d(sum.colour / sum.weight) : Eigen::Vector3d::Zero();
    mesh.colours.emplace_back(cv::saturate_cast<std::uint8_t>(c[0]), cv::saturate_cast<std::uint8_t>(c[1]),
                              cv::saturate_cast<std::uint8_t>(c[2]));
  }
  return seen;
}

}  // namespace houghstream::fusion
