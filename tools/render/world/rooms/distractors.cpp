#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "pipeline/base/checks.hpp"
#include "tools/render/world/objects/materials.hpp"
#include "tools/render/world/objects/objects.hpp"
#include "tools/render/world/objects/pixel_noise.hpp"
#include "tools/render/world/objects/taught_colours.hpp"
#include "tools/render/world/objects/vessels.hpp"

namespace houghstream::world {
namespace {

// Draws colours of the distractors: random, or with some probability those of the taught objects.
class Dyes {
 public:
  explicit Dyes(double taught_fraction) : taught_fraction_(taught_fraction) {}

  cv::Scalar plain(Random& random) const {
    if (taught(random)) return taught_colour(random);
    return hsv(random.uniform(0, 360), random.uniform(0.05, 0.8), random.uniform(0.2, 0.92));
  }

  Palette print(Random& random) const {
    Palette palette = random_palette(random);
    if (taught(random)) {
      palette.base = taught_colour(random);
      palette.accent = taught_colour(random);
    }
    return palette;
  }

 private:
  bool taught(Random& random) const { return taught_fraction_ > 0.0 && chance(random, taught_fraction_); }

  static cv::Scalar taught_colour(Random& random) {
    const ClassColours& colours = class_colours(1 + random.below(kClassCount));
    return near_colour(chance(random, 0.75) ? colours.base : colours.accent, random);
  }

  double taught_fraction_;
};

AssetPtr bottle(Random& random, const Dyes& dyes) {
  const double r = random.uniform(0.028, 0.042);
  const double h = random.uniform(0.19, 0.29);
  cv::Mat texture = plain({768, 512}, dyes.plain(random), 0.05, random);
  can_label({768, 190}, dyes.print(random), random).copyTo(texture.rowRange(250, 440));
  const Mesh mesh = rotated_mesh({{0.97 * r, 0.0},
                                  {r, 0.01},
                                  {r, 0.6 * h},
                                  {0.85 * r, 0.7 * h},
                                  {0.38 * r, 0.83 * h},
                                  {0.36 * r, 0.97 * h},
                                  {0.4 * r, h}},
                                 texture);
  return make_asset("bottle", mesh, 0.4F);
}

AssetPtr book(Random& random, const Dyes& dyes) {
  const Palette palette = dyes.print(random);
  const Eigen::Vector3d size(random.uniform(0.13, 0.2), random.uniform(0.19, 0.27), random.uniform(0.015, 0.05));
  BoxFaces faces;
  faces.top = book_cover({320, 440}, palette, random);
  faces.bottom = plain({64, 64}, palette.base, 0.05, random);
  faces.left = carton_side({400, 80}, palette, random);
  faces.front = plain({320, 80}, {210, 225, 232}, 0.1, random);
  faces.right = faces.front;
  return make_asset("book", finish_object(box(size, faces)), 0.08F);
}

AssetPtr jug(Random& random, const Dyes& dyes) {
  const double r = random.uniform(0.055, 0.075);
  const double h = random.uniform(0.14, 0.2);
  const cv::Mat glaze = plain({128, 128}, dyes.plain(random), 0.05, random);
  const Mesh body = lathe(with_arc_length({{0, 0},
                                           {0.7 * r, 0},
                                           {0.7 * r, 0},
                                           {0.95 * r, 0.2 * h},
                                           {r, 0.4 * h},
                                           {0.85 * r, 0.7 * h},
                                           {0.6 * r, 0.9 * h},
                                           {0.62 * r, h},
                                           {0, h}}),
                          glaze);
  const Mesh handle =
      tube({{0.75 * r, 0, 0.8 * h}, {1.45 * r, 0, 0.75 * h}, {1.5 * r, 0, 0.45 * h}, {0.9 * r, 0, 0.25 * h}}, 0.1 * r,
           glaze);
  const Mesh spout = tube({{-0.7 * r, 0, 0.4 * h}, {-1.3 * r, 0, 0.65 * h}, {-1.6 * r, 0, 0.95 * h}}, 0.14 * r, glaze);
  const Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  return make_asset("jug", finish_object(compose({at(body, origin), at(handle, origin), at(spout, origin)})), 0.35F);
}

AssetPtr plates(Random& random, const Dyes& /*dyes*/) {
  const double r = random.uniform(0.085, 0.13);
  const cv::Mat glaze = plain({256, 128}, hsv(random.uniform(0, 360), random.uniform(0, 0.3), 0.85), 0.04, random);
  const Mesh plate = lathe(
      with_arc_length(
          {{0, 0}, {0.6 * r, 0}, {0.6 * r, 0}, {r, 0.016}, {r, 0.02}, {0.97 * r, 0.02}, {0.6 * r, 0.006}, {0, 0.006}}),
      glaze);
  std::vector<Part> parts;
  const int count = random.between(1, 6);
  parts.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) parts.push_back(at(plate, {0, 0, 0.0075 * i}));
  return make_asset("plates", finish_object(compose(parts)), 0.3F);
}

AssetPtr lamp(Random& random, const Dyes& dyes) {
  const cv::Mat shade = fabric({256, 128}, dyes.plain(random), random);
  const cv::Mat stand = metal({64, 64}, random);
  const double h = random.uniform(0.3, 0.42);
  const double r = random.uniform(0.07, 0.1);
  const Mesh foot =
      lathe(with_arc_length(
                {{0, 0}, {0.7 * r, 0}, {0.7 * r, 0}, {0.6 * r, 0.02}, {0.012, 0.035}, {0.012, 0.7 * h}, {0, 0.7 * h}}),
            stand);
  const Mesh hood =
      lathe(with_arc_length({{0, 0.6 * h}, {1.1 * r, 0.6 * h}, {1.1 * r, 0.6 * h}, {0.7 * r, h}, {0.7 * r, h}, {0, h}}),
            shade);
  return make_asset("lamp", finish_object(compose({at(foot, {0, 0, 0}), at(hood, {0, 0, 0})})), 0.1F);
}

AssetPtr plant(Random& random, const Dyes& /*dyes*/) {
  const double r = random.uniform(0.045, 0.07);
  const cv::Mat clay = plain({128, 128}, hsv(random.uniform(8, 40), 0.5, random.uniform(0.4, 0.8)), 0.1, random);
  const cv::Mat leaf = plain({64, 64}, hsv(random.uniform(80, 140), 0.6, random.uniform(0.25, 0.55)), 0.2, random);
  std::vector<Part> parts = {at(cup_mesh({r, 0.75 * r, 1.6 * r, 0.005}, clay), {0, 0, 0.8 * r})};
  const int leaves = random.between(14, 24);
  for (int i = 0; i < leaves; ++i) {
    const double length = random.uniform(0.07, 0.14);
    Part part{box({length, 0.3 * length, 0.003}, leaf), Eigen::Isometry3d::Identity()};
    part.T_object_part.translate(Eigen::Vector3d(0, 0, 1.5 * r));
    part.T_object_part.rotate(Eigen::AngleAxisd(random.uniform(0, 2 * M_PI), Eigen::Vector3d::UnitZ()));
    part.T_object_part.rotate(Eigen::AngleAxisd(-random.uniform(0.4, 1.4), Eigen::Vector3d::UnitY()));
    part.T_object_part.translate(Eigen::Vector3d(0.5 * length, 0, 0));
    parts.push_back(part);
  }
  return make_asset("plant", finish_object(compose(parts)), 0.08F);
}

AssetPtr stapler(Random& random, const Dyes& dyes) {
  const cv::Mat shell = plain({128, 64}, dyes.plain(random), 0.08, random);
  const cv::Mat steel = metal({64, 64}, random);
  return make_asset("stapler",
                    finish_object(compose({at(box({0.15, 0.035, 0.012}, shell), {0, 0, 0.006}),
                                           at(box({0.13, 0.02, 0.008}, steel), {0, 0, 0.016}),
                                           at(box({0.14, 0.03, 0.025}, shell), {-0.004, 0, 0.0325})})),
                    0.2F);
}

AssetPtr cup(Random& random, const Dyes& dyes) {
  const cv::Mat texture = mug_print({512, 256}, dyes.print(random), random);
  const double r = random.uniform(0.033, 0.045);
  return make_asset("cup", cup_mesh({r, random.uniform(0.7, 1.0) * r, random.uniform(0.08, 0.14), 0.003}, texture),
                    0.35F);
}

AssetPtr fruit(Random& random, const Dyes& /*dyes*/) {
  const double r = random.uniform(0.03, 0.05);
  const double flat = random.uniform(0.8, 1.1);
  std::vector<Eigen::Vector2d> outline;
  for (int i = 1; i < 12; ++i) {
    const double angle = M_PI * (i / 12.0 - 0.5);
    outline.emplace_back(r * std::cos(angle), flat * r * std::sin(angle));
  }
  const cv::Mat skin = plain({128, 128}, hsv(random.uniform(-10, 110), 0.8, random.uniform(0.5, 0.9)), 0.25, random);
  return make_asset("fruit", rotated_mesh(outline, skin), 0.2F);
}

AssetPtr keyboard(Random& random, const Dyes& /*dyes*/) {
  BoxFaces faces;
  faces.top = keyboard_top({900, 280}, random);
  faces.front = faces.top.rowRange(0, 12).clone();
  return make_asset("keyboard", finish_object(box({0.42, 0.135, 0.018}, faces)), 0.08F);
}

AssetPtr tissue_box(Random& random, const Dyes& dyes) {
  const Palette palette = dyes.print(random);
  BoxFaces faces;
  faces.front = chance(random, 0.5) ? poster({460, 180}, random) : carton_front({460, 180}, palette, random);
  faces.top = fabric({460, 240}, palette.base, random);
  cv::ellipse(faces.top, {230, 120}, {130, 40}, 0, 0, 360, {235, 240, 242}, cv::FILLED, cv::LINE_AA);
  return make_asset("tissue_box", finish_object(box({0.23, 0.115, random.uniform(0.06, 0.11)}, faces)), 0.06F);
}

AssetPtr tin(Random& random, const Dyes& dyes) {
  const double r = random.uniform(0.036, 0.052);
  const double h = random.uniform(0.07, 0.15);
  cv::Mat texture = metal({768, 512}, random);
  can_label({768, 300}, dyes.print(random), random).copyTo(texture.rowRange(110, 410));
  return make_asset(
      "tin",
      rotated_mesh({{r, 0}, {r, 0.004}, {0.985 * r, 0.005}, {0.985 * r, h - 0.005}, {r, h - 0.004}, {r, h}}, texture),
      0.4F);
}

AssetPtr vase(Random& random, const Dyes& dyes) {
  const double r = random.uniform(0.04, 0.065);
  const double h = random.uniform(0.16, 0.26);
  const cv::Mat glaze = mug_print({512, 384}, dyes.print(random), random);
  return make_asset(
      "vase",
      rotated_mesh(
          {{0.55 * r, 0}, {0.9 * r, 0.2 * h}, {r, 0.45 * h}, {0.7 * r, 0.7 * h}, {0.4 * r, 0.88 * h}, {0.5 * r, h}},
          glaze),
      0.35F);
}

AssetPtr monitor(Random& random, const Dyes& /*dyes*/) {
  BoxFaces faces;
  faces.back = plain({128, 96}, {40, 40, 40}, 0.05, random);
  faces.left = faces.right = faces.top = faces.bottom = faces.back;
  faces.front = screen_image({960, 600}, random);
  const double width = random.uniform(0.4, 0.55);
  const double height = 0.6 * width;
  return make_asset("monitor",
                    finish_object(compose({at(box({width, 0.03, height}, faces), {0, 0, 0.1 + 0.5 * height}),
                                           at(box({0.05, 0.03, 0.12}, faces.back), {0, 0.03, 0.06}),
                                           at(box({0.24, 0.17, 0.012}, faces.back), {0, 0.03, 0.006})})),
                    0.25F, 0.35F);
}

AssetPtr small_carton(Random& random, const Dyes& dyes) {
  const Eigen::Vector3d size(random.uniform(0.06, 0.16), random.uniform(0.04, 0.08), random.uniform(0.08, 0.22));
  return make_asset("carton", carton_mesh(size, dyes.print(random), random), 0.12F);
}

AssetPtr jar(Random& random, const Dyes& dyes) {
  const double r = random.uniform(0.035, 0.055);
  const double h = random.uniform(0.08, 0.15);
  const cv::Mat body = plain({256, 256}, dyes.plain(random), 0.08, random);
  const cv::Mat lid = plain({64, 64}, dyes.plain(random), 0.05, random);
  const Mesh pot = rotated_mesh({{r, 0}, {r, 0.85 * h}, {0.85 * r, 0.92 * h}}, body);
  const Mesh top = rotated_mesh({{0.9 * r, 0}, {0.9 * r, 0.14 * h}}, lid);
  return make_asset("jar", finish_object(compose({at(pot, {0, 0, 0.46 * h}), at(top, {0, 0, 0.98 * h})})), 0.3F);
}

}  // namespace

AssetPtr make_distractor(int kind, std::uint64_t seed, double taught_colours) {
  constexpr std::array<AssetPtr (*)(Random&, const Dyes&), kDistractorKinds> kMakers = {
      bottle, book,     jug,        plates, lamp, plant,   stapler,      cup,
      fruit,  keyboard, tissue_box, tin,    vase, monitor, small_carton, jar};
  require(kind >= 0 && kind < kDistractorKinds, "distractor: kind {}, expected 0 to {}", kind, kDistractorKinds - 1);
  Random random(seed);
  return kMakers[static_cast<std::size_t>(kind)](random, Dyes(taught_colours));
}

}  // namespace houghstream::world
