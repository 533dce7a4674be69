#include "tools/render/world/optics/shading.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/geometry/renderer.hpp"
#include "tools/render/world/objects/pixel_noise.hpp"

namespace houghstream::world {
namespace {

constexpr double kMapPxPerM = 430.0;  // resolution of the map, which shows a part of the world
constexpr float kBiasM = 0.006F;
constexpr int kTaps = 8;
constexpr int kRotations = 64;

using Taps = std::array<std::array<Eigen::Vector2f, kTaps>, kRotations>;

// Returns Vogel's spiral in the unit disc, from the rim inwards, for each rotation of the pattern.
Taps make_taps() {
  Taps taps;
  for (int angle_rad = 0; angle_rad < kRotations; ++angle_rad) {
    for (int i = 0; i < kTaps; ++i) {
      const double radius = std::sqrt((kTaps - i - 0.5) / kTaps);
      const double angle = 2.399963 * i + 2.0 * M_PI * angle_rad / kRotations;  // golden angle
      taps[static_cast<std::size_t>(angle_rad)][static_cast<std::size_t>(i)] =
          Eigen::Vector2d(radius * std::cos(angle), radius * std::sin(angle)).cast<float>();
    }
  }
  return taps;
}

constexpr std::uint64_t kPatternSeed = 77;

// Returns the table from sRGB to linear (IEC 61966-2-1).
std::array<float, 256> make_linear_table() {
  std::array<float, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double value = static_cast<double>(i) / 255.0;
    table[i] = static_cast<float>(value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4));
  }
  return table;
}

Eigen::Vector3f linear(const cv::Vec3b& bgr) {
  static const std::array<float, 256> kLinear = make_linear_table();
  return {kLinear[bgr[0]], kLinear[bgr[1]], kLinear[bgr[2]]};
}

Eigen::Vector3f sample_level(const cv::Mat& level, const Eigen::Vector2f& uv) {
  const float x =
      std::clamp(uv.x() * static_cast<float>(level.cols) - 0.5F, 0.0F, static_cast<float>(level.cols) - 1.001F);
  const float y =
      std::clamp(uv.y() * static_cast<float>(level.rows) - 0.5F, 0.0F, static_cast<float>(level.rows) - 1.001F);
  const int x0 = static_cast<int>(x);
  const int y0 = static_cast<int>(y);
  const float fx = x - static_cast<float>(x0);
  const float fy = y - static_cast<float>(y0);
  const auto texel = [&level](int row, int column) { return linear(level.at<cv::Vec3b>(row, column)); };
  return (1.0F - fy) * ((1.0F - fx) * texel(y0, x0) + fx * texel(y0, x0 + 1)) +
         fy * ((1.0F - fx) * texel(y0 + 1, x0) + fx * texel(y0 + 1, x0 + 1));
}

// The level whose texels are about as large as the pixel on the surface.
const cv::Mat& mip_level(const Asset& thing, int triangle, float pixel_on_surface_m) {
  const float texels = std::max(1.0F, thing.texels_per_m[static_cast<std::size_t>(triangle)] * pixel_on_surface_m);
  const int level = std::ilogb(1.23F * texels);  // rounds log2 up from seven tenths
  return thing.mip_levels[std::min(static_cast<std::size_t>(level), thing.mip_levels.size() - 1)];
}

struct LightInView {
  Eigen::Vector3f position_camera;
  Eigen::Vector3f colour_bgr;
  ShadowLookup shadow;
};

struct Point {
  Eigen::Vector3f position;  // camera frame
  Eigen::Vector3f normal;
  Eigen::Vector3f to_eye;
  Eigen::Vector3f reflectance_bgr;
  float specular;
  float angle_rad;
};

// Returns Lambert's diffuse and Blinn's (1977) specular term.
Eigen::Vector3f reflected(const Point& point, const std::vector<LightInView>& lights, const Eigen::Vector3f& ambient) {
  Eigen::Vector3f sum = ambient.cwiseProduct(point.reflectance_bgr);
  for (const LightInView& light : lights) {
    const Eigen::Vector3f to_light = (light.position_camera - point.position).normalized();
    const float facing = point.normal.dot(to_light);
    if (facing <= 0.0F) continue;
    const float lit = light.shadow.lit(point.position + 0.003F * point.normal, point.angle_rad);
    if (lit <= 0.0F) continue;
    const float half = std::max(0.0F, point.normal.dot((to_light + point.to_eye).normalized()));
    const float half_4 = half * half * half * half;
    const float half_16 = half_4 * half_4 * half_4 * half_4;
    const float mirror = 1.2F * point.specular * half_16 * half_16 * half_16;
    sum += lit * light.colour_bgr.cwiseProduct(facing * point.reflectance_bgr + Eigen::Vector3f::Constant(mirror));
  }
  return sum;
}

class Shader {
 public:
  Shader(const LitWorld& lit_world, const Camera& camera, const Eigen::Isometry3d& T_camera_world,
         const cv::Point& first_px)
      : world_(lit_world.world),
        camera_(camera),
        first_px_(first_px),
        up_((T_camera_world.linear() * Eigen::Vector3d::UnitZ()).cast<float>()) {
    for (std::size_t i = 0; i < world_.lights.size(); ++i) {
      const Light& light = world_.lights[i];
      lights_.push_back({(T_camera_world * light.position_world).cast<float>(), light.colour_bgr,
                         ShadowLookup(lit_world.shadows[i], T_camera_world.inverse(), light.penumbra_m)});
    }
    for (const PlacedAsset& placed : world_.items)
      R_camera_object_.push_back((T_camera_world * placed.T_world_object).linear().cast<float>());
  }

  /// Shades the view's pixel (x, y), which is the image's (x, y) + first_px.
  void shade_pixel(int x, int y, ShadedView& view) const {
    const std::uint16_t id = view.geometry.id.at<std::uint16_t>(y, x);
    if (id == 0) return;
    const std::size_t item = id - 1U;
    const Asset& thing = *world_.items[item].thing;
    const int triangle = view.geometry.triangle.at<std::int32_t>(y, x);
    const auto& [a, b, c] = thing.mesh.triangles[static_cast<std::size_t>(triangle)];
    const cv::Vec2f bary = view.geometry.bary.at<cv::Vec2f>(y, x);
    const float first = 1.0F - bary[0] - bary[1];
    const float z = view.geometry.depth.at<float>(y, x);

    Point point;
    const int image_x = x + first_px_.x;
    const int image_y = y + first_px_.y;
    point.position = camera_.backproject(image_x, image_y, z).cast<float>();
    point.to_eye = -point.position.normalized();
    point.normal = (R_camera_object_[item] *
                    (first * thing.mesh.normals[a] + bary[0] * thing.mesh.normals[b] + bary[1] * thing.mesh.normals[c]))
                       .normalized();
    const float incidence = std::clamp(point.normal.dot(point.to_eye), 0.0F, 1.0F);
    if (thing.mip_levels.empty()) {
      const std::vector<cv::Vec3b>& colours = thing.mesh.colours;
      point.reflectance_bgr = first * linear(colours[a]) + bary[0] * linear(colours[b]) + bary[1] * linear(colours[c]);
    } else {
      const Eigen::Vector2f uv = first * thing.mesh.uvs[a] + bary[0] * thing.mesh.uvs[b] + bary[1] * thing.mesh.uvs[c];
      const float pixel_m = static_cast<float>(camera_.metres_per_px(z)) / std::sqrt(std::max(incidence, 0.05F));
      point.reflectance_bgr = sample_level(mip_level(thing, triangle, pixel_m), uv);
    }
    point.specular = thing.specular;
    const auto number = static_cast<std::uint64_t>(image_y) * 4096U + static_cast<std::uint64_t>(image_x);
    point.angle_rad = pixel_uniform(kPatternSeed, number);

    // Ambient light is stronger from above.
    const Eigen::Vector3f ambient = world_.ambient_bgr * (0.72F + 0.28F * point.normal.dot(up_));
    const Eigen::Vector3f light =
        (1.0F - thing.emission) * reflected(point, lights_, ambient) + thing.emission * point.reflectance_bgr;
    view.radiance.at<cv::Vec3f>(y, x) = {light.x(), light.y(), light.z()};
    view.cos_incidence.at<float>(y, x) = incidence;
    view.reflectance.at<float>(y, x) = point.reflectance_bgr.mean();
    view.specular.at<float>(y, x) = thing.specular;
  }

 private:
  const World& world_;
  const Camera& camera_;
  cv::Point first_px_;
  Eigen::Vector3f up_;
  std::vector<LightInView> lights_;
  std::vector<Eigen::Matrix3f> R_camera_object_;
};

}  // namespace

ShadowMap make_shadow_map(const World& world, const Light& light) {
  ShadowMap map;
  if (!light.casts_shadow) return map;
  const double distance = light.position_world.norm();
  const int size = static_cast<int>(std::lround(2.0 * world.focus_radius_m * kMapPxPerM));
  const double focal = 0.5 * size * distance / world.focus_radius_m;
  const double centre = 0.5 * (size - 1);
  map.camera = Camera{size, size, focal, focal, centre, centre};
  map.T_light_world = look_at(light.position_world, Eigen::Vector3d::Zero());
  map.inverse_depth = cv::Mat::zeros(size, size, CV_32FC1);
  std::vector<RenderItem> items;
  for (const PlacedAsset& placed : world.items) {
    if (placed.casts_shadow) items.push_back({&placed.thing->mesh, map.T_light_world * placed.T_world_object, 1});
  }
  const cv::Mat depth = render_depth(items, map.camera, {0, 0, size, size});
  for (int y = 0; y < depth.rows; ++y) {
    for (int x = 0; x < depth.cols; ++x) {
      const float z = depth.at<float>(y, x);
      map.inverse_depth.at<float>(y, x) = std::isnan(z) ? 0.0F : 1.0F / z;
    }
  }
  return map;
}

ShadowLookup::ShadowLookup(const ShadowMap& map, const Eigen::Isometry3d& T_world_camera, double penumbra_m)
    : map_(map),
      T_light_camera_((map.T_light_world * T_world_camera).cast<float>()),
      penumbra_m_(static_cast<float>(penumbra_m)) {}

float ShadowLookup::lit(const Eigen::Vector3f& point_camera, float angle_rad) const {
  static const Taps kPatterns = make_taps();
  if (map_.camera.width == 0) return 1.0F;
  const Eigen::Vector3f point = T_light_camera_ * point_camera;
  if (point.z() <= 0.1F) return 1.0F;
  const auto focal = static_cast<float>(map_.camera.fx);
  const auto centre = static_cast<float>(map_.camera.cx);
  // Half a pixel and the first pixel's row of safety are added, so that cutting off rounds.
  const float u = focal * point.x() / point.z() + centre + 1.5F;
  const float v = focal * point.y() / point.z() + centre + 1.5F;
  const float radius = penumbra_m_ * focal / point.z();
  const auto last = static_cast<float>(map_.camera.width + 1) - radius;
  if (!(u > 1.0F + radius && v > 1.0F + radius && u < last && v < last)) return 1.0F;
  const float limit = 1.0F / (point.z() - kBiasM - 0.25F * penumbra_m_);
  const auto& taps = kPatterns[static_cast<std::size_t>(angle_rad * kRotations) % kRotations];
  int lit = 0;
  for (int i = 0; i < kTaps; ++i) {
    // Where the outer half agrees, the inner one will not differ.
    if (i == kTaps / 2 && (lit == 0 || lit == i)) return lit == 0 ? 0.0F : 1.0F;
    const Eigen::Vector2f& tap = taps[static_cast<std::size_t>(i)];
    const int x = static_cast<int>(u + radius * tap.x()) - 1;
    const int y = static_cast<int>(v + radius * tap.y()) - 1;
    if (map_.inverse_depth.at<float>(y, x) <= limit) ++lit;
  }
  return static_cast<float>(lit) / kTaps;
}

LitWorld light_world(World world) {
  LitWorld lit_world{std::move(world), {}};
  for (const Light& light : lit_world.world.lights)
    lit_world.shadows.push_back(make_shadow_map(lit_world.world, light));
  return lit_world;
}

ShadedView shade_view(const LitWorld& lit_world, const Camera& camera, const Eigen::Isometry3d& T_camera_world) {
  return shade_view(lit_world, camera, T_camera_world, cv::Rect(0, 0, camera.width, camera.height));
}

ShadedView shade_view(const LitWorld& lit_world, const Camera& camera, const Eigen::Isometry3d& T_camera_world,
                      const cv::Rect& region_px) {
  std::vector<RenderItem> items;
  for (std::size_t i = 0; i < lit_world.world.items.size(); ++i) {
    const PlacedAsset& placed = lit_world.world.items[i];
    items.push_back({&placed.thing->mesh, T_camera_world * placed.T_world_object, static_cast<int>(i) + 1});
  }
  ShadedView view;
  view.geometry = render_geometry(items, camera, region_px);
  const cv::Size size = region_px.size();
  view.radiance = cv::Mat::zeros(size, CV_32FC3);
  view.cos_incidence = cv::Mat::zeros(size, CV_32FC1);
  view.reflectance = cv::Mat::zeros(size, CV_32FC1);
  view.specular = cv::Mat::zeros(size, CV_32FC1);
  const Shader shader(lit_world, camera, T_camera_world, region_px.tl());
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) shader.shade_pixel(x, y, view);
  }
  return view;
}

}  // namespace houghstream::world
