#include "pose/fusion/view_colours.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "pipeline/base/parallel.hpp"
#include "pose/fusion/view_shading.hpp"

namespace houghstream::fusion {
namespace {

struct Sum {
  Eigen::Vector3d colour = Eigen::Vector3d::Zero();  // BGR, linear
  double weight = 0.0;
};

/// Holds the observation of a vertex in a view.
struct Sight {
  cv::Vec3b colour;
  double facing = 0.0;  ///< cosine between surface and line of sight; 0: it does not see it
};

Sight sight(const DepthView& view, const Eigen::Vector3d& vertex, const Eigen::Vector3d& normal, double tolerance_m) {
  const Eigen::Vector3d p = view.T_camera_object * vertex;
  const double facing = -(view.T_camera_object.linear() * normal).dot(p.normalized());
  const auto px = view.pixel_of(p);
  if (facing <= 0.0 || !px || !(std::abs(view.depth.at<float>(*px) - p.z()) < tolerance_m)) return {};
  return {view.colour.at<cv::Vec3b>(*px), facing};
}

bool is_clipped(const cv::Vec3b& colour) {
  return std::max({colour[0], colour[1], colour[2]}) > 250 || std::max({colour[0], colour[1], colour[2]}) < 8;
}

/// Models the effect of exposure and lighting on the colours of a mesh's vertices.
class Lighting {
 public:
  Lighting(const std::vector<DepthView>& views, double tolerance_m, const Mesh& mesh);

  /// Returns the logarithm of a surface's brightness over its albedo in a view, for this normal.
  double operator()(int view, const Eigen::Vector3d& normal) const {
    const auto at = static_cast<std::size_t>(view);
    return exposures_[at] +
           (lighting_ids_[at] >= 0 ? shadings_[static_cast<std::size_t>(lighting_ids_[at])](normal) : 0.0);
  }

 private:
  void add_samples(const std::vector<DepthView>& views, double tolerance_m, const Mesh& mesh);
  void remove_shading(const Mesh& mesh, int lighting_id);

  std::vector<int> lighting_ids_;  ///< lighting of each view
  std::vector<int> vertices_;      ///< sampled vertices
  std::vector<ColourSample> samples_;
  std::vector<Eigen::Vector3d> colours_;  ///< colours of the samples
  std::vector<double> exposures_;
  std::vector<ShadingModel> shadings_;
};

Lighting::Lighting(const std::vector<DepthView>& views, double tolerance_m, const Mesh& mesh) {
  int lightings = 0;
  for (const DepthView& view : views) {
    lighting_ids_.push_back(view.lighting_id);
    lightings = std::max(lightings, view.lighting_id + 1);
  }
  add_samples(views, tolerance_m, mesh);
  exposures_.assign(views.size(), 0.0);
  shadings_.resize(static_cast<std::size_t>(lightings));
  for (int id = 0; id < lightings; ++id) remove_shading(mesh, id);
  // Views of several lights agree on the paint only now.
  for (ColourSample& sample : samples_) {
    if (lighting_ids_[static_cast<std::size_t>(sample.view)] < 0) continue;
    const int vertex = vertices_[static_cast<std::size_t>(sample.vertex)];
    sample.level -= shadings_[static_cast<std::size_t>(lighting_ids_[static_cast<std::size_t>(sample.view)])](
        mesh.normals[static_cast<std::size_t>(vertex)].cast<double>());
  }
  exposures_ = estimate_exposures(samples_, static_cast<int>(vertices_.size()), static_cast<int>(views.size()));
}

void Lighting::add_samples(const std::vector<DepthView>& views, double tolerance_m, const Mesh& mesh) {
  constexpr std::size_t kMax = 4000;
  constexpr double kMinFacing = 0.3;
  const std::size_t step = std::max<std::size_t>(mesh.vertices.size() / kMax, 1);
  for (std::size_t v = 0; v < mesh.vertices.size(); v += step) vertices_.push_back(static_cast<int>(v));
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    const auto v = static_cast<std::size_t>(vertices_[i]);
    for (std::size_t k = 0; k < views.size(); ++k) {
      const Sight seen = sight(views[k], mesh.vertices[v].cast<double>(), mesh.normals[v].cast<double>(), tolerance_m);
      if (seen.facing < kMinFacing || is_clipped(seen.colour)) continue;
      const Eigen::Vector3d colour = srgb_to_linear(seen.colour);
      samples_.push_back(
          {static_cast<int>(i), static_cast<int>(k), std::log(colour.mean()), seen.facing * seen.facing});
      colours_.push_back(colour);
    }
  }
}

void Lighting::remove_shading(const Mesh& mesh, int lighting_id) {
  std::vector<ColourSample> lit;
  for (const ColourSample& sample : samples_) {
    if (lighting_ids_[static_cast<std::size_t>(sample.view)] == lighting_id) lit.push_back(sample);
  }
  const std::vector<double> exposed =
      estimate_exposures(lit, static_cast<int>(vertices_.size()), static_cast<int>(lighting_ids_.size()));
  std::vector<Sum> sums(vertices_.size());
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const ColourSample& sample = samples_[i];
    const auto view = static_cast<std::size_t>(sample.view);
    if (lighting_ids_[view] != lighting_id) continue;
    Sum& sum = sums[static_cast<std::size_t>(sample.vertex)];
    sum.colour += sample.weight * std::exp(-exposed[view]) * colours_[i];
    sum.weight += sample.weight;
  }
  std::vector<Eigen::Vector3d> colours, normals;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (sums[i].weight <= 0.0) continue;
    colours.emplace_back(sums[i].colour / sums[i].weight);
    normals.push_back(mesh.normals[static_cast<std::size_t>(vertices_[i])].cast<double>());
  }
  shadings_[static_cast<std::size_t>(lighting_id)] = fit_shading(colours, normals);
}

/// Brightness that one vertex in twenty exceeds.
double bright_level(const std::vector<Sum>& sums) {
  std::vector<double> levels;
  for (const Sum& sum : sums) {
    if (sum.weight > 0.0) levels.push_back(sum.colour.mean() / sum.weight);
  }
  if (levels.empty()) return 0.0;
  const auto bright = levels.begin() + static_cast<std::ptrdiff_t>(19 * levels.size() / 20);
  std::nth_element(levels.begin(), bright, levels.end());
  return *bright;
}

/// Spreads colours from observed vertices to unobserved ones, ring by ring.
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
  const Lighting lighting(views, tolerance_m, mesh);
  std::vector<Sum> sums(mesh.vertices.size());
  std::vector<Sum> as_seen(mesh.vertices.size());
  parallel_for(threads, static_cast<int>(sums.size()), [&](int i) {
    const Eigen::Vector3d normal = mesh.normals[i].cast<double>();
    for (std::size_t k = 0; k < views.size(); ++k) {
      const Sight seen = sight(views[k], mesh.vertices[i].cast<double>(), normal, tolerance_m);
      if (seen.facing <= 0.0) continue;
      // The few most frontal views dominate: with all of them, errors of a pixel would blur the texture.
      const double weight = std::pow(seen.facing, 8);
      sums[i].colour += weight * std::exp(-lighting(static_cast<int>(k), normal)) * srgb_to_linear(seen.colour);
      sums[i].weight += weight;
      as_seen[i].colour += weight * srgb_to_linear(seen.colour);
      as_seen[i].weight += weight;
    }
  });
  // Albedo and shading are known up to a common factor, which is chosen so that bright surfaces keep their observed
  // brightness.
  const double level = bright_level(sums);
  const double factor = level > 0.0 ? bright_level(as_seen) / level : 1.0;
  for (Sum& sum : sums) sum.colour *= factor;
  std::vector<bool> seen;
  seen.reserve(sums.size());
  for (const Sum& sum : sums) seen.push_back(sum.weight > 0.0);
  spread(mesh, sums);
  mesh.colours.clear();
  for (const Sum& sum : sums) {
    mesh.colours.push_back(
        linear_to_srgb(sum.weight > 0.0 ? Eigen::Vector3d(sum.colour / sum.weight) : Eigen::Vector3d::Zero()));
  }
  return seen;
}

}  // namespace houghstream::fusion
