#include "tools/render/world/objects/shape_variants.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "tools/render/world/objects/pixel_noise.hpp"

namespace houghstream::world {
namespace {

/// Displaces smoothly by a few waves of random directions, none of which is much shorter than the asset.
class Bending {
 public:
  /// Returns the deformation of an object with this diameter, by this displacement at its centre, metres.
  Bending(double across_m, double by_m, Random& random) {
    for (Wave& wave : waves_) {
      const auto direction = [&random] {
        return Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized();
      };
      wave.way = by_m / std::sqrt(0.5 * static_cast<double>(waves_.size())) * direction();
      wave.radians_per_m = 2.0 * M_PI / (across_m * random.uniform(0.7, 2.0)) * direction();
      wave.phase = random.uniform(0.0, 2.0 * M_PI);
    }
  }

  Eigen::Vector3d at(const Eigen::Vector3d& point) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Wave& wave : waves_) sum += std::sin(wave.radians_per_m.dot(point) + wave.phase) * wave.way;
    return sum;
  }

 private:
  struct Wave {
    Eigen::Vector3d way = Eigen::Vector3d::Zero();
    Eigen::Vector3d radians_per_m = Eigen::Vector3d::Zero();
    double phase = 0.0;
  };
  std::array<Wave, 4> waves_;
};

/// Returns an image with rotated hues, or nearly without saturation; darker or brighter.
cv::Mat recoloured(const cv::Mat& bgr, Random& random) {
  constexpr double kGreyed = 0.35;
  constexpr double kColourful = 80.0;  // mean saturation, of 255
  cv::Mat hsv_image;
  cv::cvtColor(bgr, hsv_image, cv::COLOR_BGR2HSV);
  const bool is_grey = chance(random, kGreyed) && cv::mean(hsv_image)[1] > kColourful;
  const int angle = random.between(40, 140);
  const double strength = random.uniform(0.0, 0.4);
  const double lightness = random.uniform(is_grey ? 0.15 : 0.5, 1.2);
  for (int y = 0; y < hsv_image.rows; ++y) {
    for (int x = 0; x < hsv_image.cols; ++x) {
      cv::Vec3b& pixel = hsv_image.at<cv::Vec3b>(y, x);
      if (is_grey) {
        pixel[1] = cv::saturate_cast<std::uint8_t>(strength * pixel[1]);
      } else {
        pixel[0] = static_cast<std::uint8_t>((pixel[0] + angle) % 180);
        pixel[1] = std::max<std::uint8_t>(pixel[1], 60);  // grey gets a colour
      }
      pixel[2] = cv::saturate_cast<std::uint8_t>(lightness * pixel[2]);
    }
  }
  cv::Mat out;
  cv::cvtColor(hsv_image, out, cv::COLOR_HSV2BGR);
  return out;
}

/// Shifts the texture cyclically, so that it lies elsewhere on the surface.
cv::Mat moved_round(const cv::Mat& image, Random& random) {
  const int right = static_cast<int>(image.cols * random.uniform(0.2, 0.8));
  const int down = static_cast<int>(image.rows * random.uniform(0.2, 0.8));
  cv::Mat out(image.size(), image.type());
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x)
      out.at<cv::Vec3b>((y + down) % image.rows, (x + right) % image.cols) = image.at<cv::Vec3b>(y, x);
  }
  return out;
}

/// Paints the mesh in other colours, and with another texture or not. Another texture alone would leave uniform
/// surfaces as they are.
void repaint(bool other_print, Random& random, Mesh& mesh) {
  const auto painted = [&](const cv::Mat& image) {
    return recoloured(other_print ? moved_round(image, random) : image, random);
  };
  if (!mesh.texture.empty()) {
    mesh.texture = painted(mesh.texture);
    return;
  }
  const cv::Mat colours = painted(cv::Mat(1, static_cast<int>(mesh.colours.size()), CV_8UC3, mesh.colours.data()));
  std::copy_n(colours.clone().ptr<cv::Vec3b>(), mesh.colours.size(), mesh.colours.begin());
}

}  // namespace

AssetPtr make_hard_negative(const Asset& thing, Random& random) {
  Mesh mesh = thing.mesh;
  const double sort = random.uniform();
  if (sort < 0.25) {
    const auto size = static_cast<float>(chance(random, 0.5) ? random.uniform(0.55, 0.75) : random.uniform(1.33, 1.7));
    for (Eigen::Vector3f& vertex : mesh.vertices) vertex *= size;
  } else if (sort < 0.5) {
    const Eigen::Vector3f sizes(static_cast<float>(random.uniform(0.5, 1.6)),
                                static_cast<float>(random.uniform(0.5, 1.6)),
                                static_cast<float>(random.uniform(0.5, 1.6)));
    for (Eigen::Vector3f& vertex : mesh.vertices) vertex = vertex.cwiseProduct(sizes);
    compute_normals(mesh);
  } else {
    repaint(chance(random, 0.6), random, mesh);
  }
  return make_asset(thing.name, std::move(mesh), thing.specular);
}

AssetPtr make_instance_variant(const Asset& thing, Random& random) {
  constexpr double kMaxScale = 0.015;
  constexpr double kMaxBent_m = 0.003;
  constexpr double kMaxBent = 0.02;  // fraction of its extent
  Mesh mesh = thing.mesh;
  const Eigen::AlignedBox3f bounds = mesh_bounds(mesh);
  const Eigen::Vector3d middle = bounds.center().cast<double>();
  const double across_m = bounds.diagonal().norm();
  const double scale = 1.0 + random.uniform(-kMaxScale, kMaxScale);
  const Bending bending(across_m, random.uniform() * std::min(kMaxBent_m, kMaxBent * across_m), random);
  for (Eigen::Vector3f& vertex : mesh.vertices) {
    const Eigen::Vector3d point = vertex.cast<double>() - middle;
    vertex = (middle + scale * point + bending.at(point)).cast<float>();
  }
  Asset next = thing;
  next.mesh = std::move(mesh);
  return std::make_shared<const Asset>(std::move(next));
}

}  // namespace houghstream::world
