#include "pose/fusion/view_shading.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "pipeline/base/random.hpp"
#include "pose/fusion/view_colours.hpp"
#include "tests/pose/fusion/turntable_views.hpp"

namespace houghstream::fusion {
namespace {

const Eigen::Vector3d kBlue(0.4, 0.12, 0.03), kYellow(0.05, 0.5, 0.6), kBlack(0.02, 0.02, 0.02);

Eigen::Vector3d direction(Random& random) {
  for (;;) {
    const Eigen::Vector3d d(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5);
    if (d.norm() > 0.05 && d.norm() < 0.5) return d.normalized();
  }
}

/// Returns ambient light and the light of a lamp.
double light_on(const Eigen::Vector3d& normal) {
  return 0.25 + std::max(0.0, normal.dot(Eigen::Vector3d(0.6, -0.2, 0.77)));
}

/// Points all around, with blue and yellow sides and black print on both.
struct Ball {
  std::vector<Eigen::Vector3d> normals, paints;

  Ball() {
    Random random(5);
    for (int i = 0; i < 3000; ++i) {
      normals.push_back(direction(random));
      const bool is_black = random.uniform() < 0.2;
      paints.push_back(is_black ? kBlack : normals.back().y() > 0.0 ? kBlue : kYellow);
    }
  }
};

TEST(ShadingModel, LightIsPartedFromPaint) {
  const Ball ball;
  std::vector<Eigen::Vector3d> colours;
  colours.reserve(ball.normals.size());
  for (std::size_t i = 0; i < ball.normals.size(); ++i)
    colours.emplace_back(ball.paints[i] * light_on(ball.normals[i]));
  const ShadingModel shade = fit_shading(colours, ball.normals);
  double darkest = 1e9, brightest = -1e9;
  for (const Eigen::Vector3d& normal : ball.normals) {
    const double rest = std::log(light_on(normal)) - shade(normal);
    darkest = std::min(darkest, rest);
    brightest = std::max(brightest, rest);
  }
  EXPECT_LT(brightest - darkest, 0.6) << "log; the light itself spans " << std::log(1.25 / 0.25);
}

TEST(ShadingModel, PaintsOfDifferentBrightnessAreNoShade) {
  const Ball ball;
  const ShadingModel shade = fit_shading(ball.paints, ball.normals);
  for (const Eigen::Vector3d& normal : ball.normals) ASSERT_NEAR(shade(normal), 0.0, 0.05);
}

TEST(ShadingModel, NothingSeenIsNoShade) {
  EXPECT_EQ(fit_shading({}, {})(Eigen::Vector3d::UnitX()), 0.0);
}

TEST(Exposures, OfARingOfViewsAreFound) {
  constexpr int kViews = 20, kVertices = 200;
  Random random(3);
  std::vector<double> truth(kViews), level(kVertices);
  for (double& t : truth) t = 0.8 * random.uniform();
  for (double& l : level) l = -2.0 * random.uniform();
  std::vector<ColourSample> samples;
  for (int v = 0; v < kVertices; ++v) {
    for (int near = 0; near < 6; ++near) {
      const int view = (v * kViews / kVertices + near) % kViews;
      const double shine = random.uniform() < 0.1 ? 1.5 : 0.0;
      samples.push_back(
          {v, view, level[static_cast<std::size_t>(v)] + truth[static_cast<std::size_t>(view)] + shine, 1.0});
    }
  }
  const std::vector<double> found = estimate_exposures(samples, kVertices, kViews);
  for (int k = 1; k < kViews; ++k) {
    const auto at = static_cast<std::size_t>(k);
    EXPECT_NEAR(found[at] - found[0], truth[at] - truth[0], 0.15) << k;
  }
}

TEST(Exposures, AViewAloneHasNone) {
  EXPECT_EQ(estimate_exposures({{0, 0, -1.0, 1.0}}, 1, 2), std::vector<double>(2, 0.0));
}

/// Returns the fraction by which the darkest tenth of the coloured vertices is darker than the brightest tenth.
double unevenness(const std::vector<DepthView>& views, Mesh mesh) {
  const std::vector<bool> seen = colour_mesh(views, 0.004, 1, mesh);
  std::vector<double> greens;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (seen[i]) greens.push_back(srgb_to_linear(mesh.colours[i])[1]);
  }
  std::sort(greens.begin(), greens.end());
  return 1.0 - greens[greens.size() / 10] / greens[9 * greens.size() / 10];
}

TEST(ViewColours, StandingLightAndExposureAreTakenOut) {
  test_scene::TurntableScene scene;
  scene.mesh = test_scene::mug();
  scene.views = 16;
  scene.elevation = 0.2;
  int view = 0;
  scene.paint = [&](const Eigen::Vector3d& p) {
    const Eigen::Vector3d normal = Eigen::Vector3d(p.x(), p.y(), 0.0).normalized();
    return linear_to_srgb((view % 2 == 0 ? 0.7 : 1.0) * light_on(normal) * kBlue);
  };
  std::vector<DepthView> views;
  for (; view < scene.views; ++view) {
    views.push_back(make_depth_view(turntable_view(scene, view)));
    views.back().lighting_id = 0;
  }
  Mesh side;
  for (int i = 0; i < 64; ++i) {
    const auto angle = static_cast<float>(2.0 * M_PI * (i + 0.5) / 64);
    side.normals.emplace_back(std::cos(angle), std::sin(angle), 0.0F);
    side.vertices.emplace_back(0.0419F * side.normals.back() + Eigen::Vector3f(0.0F, 0.0F, 0.04F));
  }
  EXPECT_LT(unevenness(views, side), 0.25);
  Mesh coloured = side;
  colour_mesh(views, 0.004, 1, coloured);
  EXPECT_NEAR(srgb_to_linear(coloured.colours[3])[0], 0.3, 0.05) << "as bright as where the lamp shone on it";
  for (DepthView& one : views) one.lighting_id = -1;
  EXPECT_GT(unevenness(views, side), 0.5) << "who knows where the light was: it stays";
}

}  // namespace
}  // namespace houghstream::fusion
