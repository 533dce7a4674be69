#include "pipeline/geometry/renderer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

const Camera kVga{640, 480, 525.0, 525.0, 319.5, 239.5};
const Camera kSmall{64, 48, 50.0, 52.0, 31.5, 23.5};

Mesh quad(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c, const Eigen::Vector3f& d) {
  Mesh mesh;
  mesh.vertices = {a, b, c, d};
  mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

Mesh square(float half, float z) {
  return quad({-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z});
}

bool same_bits(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && std::memcmp(a.data, b.data, a.total() * a.elemSize()) == 0;
}

TEST(Renderer, PlaneAtKnownDepthHasItAndItsExactExtent) {
  const Mesh mesh = square(0.1F, 1.0F);
  const RenderedGeometry rendered = render_geometry({{&mesh, Eigen::Isometry3d::Identity(), 7}}, kVga);
  int count = 0;
  for (int y = 0; y < rendered.depth.rows; ++y) {
    for (int x = 0; x < rendered.depth.cols; ++x) {
      // The square's edges are at 319.5 +- 52.5 = 267 and 372 exactly: one of the two borders belongs to it.
      const bool inside = x > 267 && x < 372 && y > 187 && y < 292;
      const bool border =
          (x == 267 || x == 372 || y == 187 || y == 292) && x >= 267 && x <= 372 && y >= 187 && y <= 292;
      const bool hit = rendered.id.at<std::uint16_t>(y, x) == 7;
      count += hit ? 1 : 0;
      ASSERT_EQ(hit, border ? hit : inside) << x << "," << y;
      ASSERT_EQ(hit, !std::isnan(rendered.depth.at<float>(y, x)));
      ASSERT_EQ(hit, rendered.triangle.at<std::int32_t>(y, x) >= 0);
      ASSERT_NEAR(hit ? rendered.depth.at<float>(y, x) : 1.0F, 1.0F, 1e-6F);
    }
  }
  EXPECT_EQ(count, 105 * 105);
}

TEST(Renderer, TiltedQuadHasTheAnalyticDepth) {
  // The plane is z = 1 + 0.8 x: along the ray (u, v, 1) z = 1 / (1 - 0.8 u).
  const Mesh mesh = quad({-0.5F, -0.5F, 0.6F}, {0.5F, -0.5F, 1.4F}, {0.5F, 0.5F, 1.4F}, {-0.5F, 0.5F, 0.6F});
  const cv::Mat depth = render_geometry({{&mesh, Eigen::Isometry3d::Identity(), 1}}, kVga).depth;
  int count = 0;
  for (int x = 0; x < depth.cols; ++x) {
    const float seen = depth.at<float>(200, x);
    if (std::isnan(seen)) continue;
    ++count;
    EXPECT_NEAR(seen, 1.0 / (1.0 - 0.8 * (x - kVga.cx) / kVga.fx), 1e-5);
  }
  EXPECT_GT(count, 400);
}

TEST(Renderer, BarycentricsInterpolateTextureInPerspective) {
  const Mesh mesh = quad({-0.5F, -0.5F, 0.6F}, {0.5F, -0.5F, 1.4F}, {0.5F, 0.5F, 1.4F}, {-0.5F, 0.5F, 0.6F});
  const RenderedGeometry rendered = render_geometry({{&mesh, Eigen::Isometry3d::Identity(), 1}}, kVga);
  int count = 0;
  for (int y = 0; y < rendered.depth.rows; y += 7) {
    for (int x = 0; x < rendered.depth.cols; x += 5) {
      const int index = rendered.triangle.at<std::int32_t>(y, x);
      if (index < 0) continue;
      ++count;
      const auto bary = rendered.bary.at<cv::Vec2f>(y, x);
      const auto& t = mesh.triangles[static_cast<std::size_t>(index)];
      const Eigen::Vector2f uv =
          (1.0F - bary[0] - bary[1]) * mesh.uvs[t[0]] + bary[0] * mesh.uvs[t[1]] + bary[1] * mesh.uvs[t[2]];
      const Eigen::Vector3d point = kVga.backproject(x, y, rendered.depth.at<float>(y, x));
      ASSERT_NEAR(uv.x(), point.x() + 0.5, 1e-4);
      ASSERT_NEAR(uv.y(), point.y() + 0.5, 1e-4);
    }
  }
  EXPECT_GT(count, 1000);
}

TEST(Renderer, NeighbouringTrianglesLeaveNoGapAndShareNoPixel) {
  // Returns a jittered grid whose vertices partly lie exactly on pixel centres, each triangle drawn on its own.
  std::mt19937_64 generator(5);
  constexpr int kCells = 12;
  Mesh grid;
  for (int j = 0; j <= kCells; ++j) {
    for (int i = 0; i <= kCells; ++i) {
      const double jitter = (i + j) % 3 == 0 ? 0.0 : static_cast<double>(generator() % 1000) / 500.0 - 1.0;
      const bool rim = i == 0 || j == 0 || i == kCells || j == kCells;
      const double x_px = 4.0 + 4.0 * i + (rim ? 0.0 : jitter);
      const double y_px = 2.0 + 3.5 * j + (rim ? 0.0 : -0.7 * jitter);
      grid.vertices.push_back(kSmall.backproject(x_px, y_px, 1.0 + 0.1 * jitter).cast<float>());
    }
  }
  const auto at = [](int i, int j) { return static_cast<std::uint32_t>(j * (kCells + 1) + i); };
  for (int j = 0; j < kCells; ++j) {
    for (int i = 0; i < kCells; ++i) {
      grid.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      grid.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});  // other winding on purpose
    }
  }
  cv::Mat hits(kSmall.height, kSmall.width, CV_32SC1, cv::Scalar(0));
  for (const auto& triangle : grid.triangles) {
    Mesh alone = grid;
    alone.triangles = {triangle};
    const cv::Mat depth = render_depth(alone, Eigen::Isometry3d::Identity(), kSmall, {0, 0, 64, 48});
    for (int y = 0; y < depth.rows; ++y) {
      for (int x = 0; x < depth.cols; ++x) hits.at<int>(y, x) += std::isnan(depth.at<float>(y, x)) ? 0 : 1;
    }
  }
  for (int y = 3; y < 44; ++y) {
    for (int x = 5; x < 52; ++x) ASSERT_EQ(hits.at<int>(y, x), 1) << x << "," << y;
  }
}

TEST(Renderer, NearerSurfaceHidesTheFarther) {
  const Mesh near = square(0.05F, 0.8F);
  const Mesh far = square(0.2F, 1.2F);
  const Eigen::Isometry3d here = Eigen::Isometry3d::Identity();
  for (const bool near_first : {true, false}) {
    const std::vector<RenderItem> items = near_first ? std::vector<RenderItem>{{&near, here, 1}, {&far, here, 2}}
                                                     : std::vector<RenderItem>{{&far, here, 2}, {&near, here, 1}};
    const RenderedGeometry rendered = render_geometry(items, kVga);
    EXPECT_EQ(rendered.id.at<std::uint16_t>(240, 320), 1);
    EXPECT_NEAR(rendered.depth.at<float>(240, 320), 0.8F, 1e-6F);
    EXPECT_EQ(rendered.id.at<std::uint16_t>(240, 380), 2);
    EXPECT_EQ(rendered.id.at<std::uint16_t>(10, 10), 0);
  }
}

TEST(Renderer, TrianglesAcrossTheNearPlaneAreClipped) {
  // The floor is a square 1 m below the camera, standing on its corner, reaching from 11 m behind to 9 m in front.
  const Mesh floor = quad({0, 1, 9}, {10, 1, -1}, {0, 1, -11}, {-10, 1, -1});
  const RenderedGeometry rendered = render_geometry({{&floor, Eigen::Isometry3d::Identity(), 3}}, kVga);
  int count = 0;
  for (int y = 240; y < 480; ++y) {
    for (int x = 0; x < 640; x += 3) {
      const Eigen::Vector3d point = kVga.backproject(x, y, kVga.fy / (y - kVga.cy));
      const double beyond_edge = std::abs(point.x()) + std::abs(point.z() + 1.0) - 10.0;
      if (std::abs(beyond_edge) < 0.1) continue;
      ASSERT_EQ(rendered.id.at<std::uint16_t>(y, x) == 3, beyond_edge < 0.0) << x << "," << y;
      if (beyond_edge > 0.0) continue;
      ASSERT_NEAR(rendered.depth.at<float>(y, x), point.z(), 1e-5 * point.z());
      ++count;
    }
  }
  EXPECT_GT(count, 5000);
  const Mesh behind = square(1.0F, -1.0F);
  EXPECT_EQ(cv::countNonZero(render_geometry({{&behind, Eigen::Isometry3d::Identity(), 1}}, kVga).id), 0);
  const Mesh too_near = square(0.01F, 0.04F);
  EXPECT_EQ(cv::countNonZero(render_geometry({{&too_near, Eigen::Isometry3d::Identity(), 1}}, kVga).id), 0);
}

TEST(Renderer, RegionShowsTheSameDepthAsTheWholeImageEveryTime) {
  Mesh mesh = square(0.15F, 0.0F);
  Eigen::Isometry3d T_camera_object = Eigen::Isometry3d::Identity();
  T_camera_object.translation() = Eigen::Vector3d(0.05, -0.1, 1.1);
  T_camera_object.rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()));
  const RenderedGeometry whole = render_geometry({{&mesh, T_camera_object, 1}}, kVga);
  const RenderedGeometry again = render_geometry({{&mesh, T_camera_object, 1}}, kVga);
  EXPECT_TRUE(same_bits(whole.depth, again.depth));
  EXPECT_TRUE(same_bits(whole.bary, again.bary));
  const cv::Rect region(230, 150, 90, 70);
  const cv::Mat part = render_depth(mesh, T_camera_object, kVga, region);
  ASSERT_EQ(part.size(), region.size());
  int count = 0;
  for (int y = 0; y < region.height; ++y) {
    for (int x = 0; x < region.width; ++x) {
      const float expected = whole.depth.at<float>(y + region.y, x + region.x);
      ASSERT_EQ(std::isnan(part.at<float>(y, x)), std::isnan(expected));
      if (std::isnan(expected)) continue;
      ++count;
      ASSERT_NEAR(part.at<float>(y, x), expected, 1e-6F);
    }
  }
  EXPECT_GT(count, 100);
  EXPECT_LT(count, region.area());
}

TEST(Renderer, ThePartThatShowsAMeshHasTheWholeImagesDepthBitForBit) {
  const Mesh mesh = square(0.15F, 0.0F);
  for (const Eigen::Vector3d& place : {Eigen::Vector3d(0.05, -0.1, 1.1), Eigen::Vector3d(-0.6, 0.4, 1.0),
                                       Eigen::Vector3d(0.0, 0.02, 0.1), Eigen::Vector3d(3.0, 0.0, 1.0)}) {
    Eigen::Isometry3d T_camera_object = Eigen::Isometry3d::Identity();
    T_camera_object.translation() = place;
    T_camera_object.rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()));
    const cv::Mat whole = render_depth(mesh, T_camera_object, kVga, cv::Rect(0, 0, kVga.width, kVga.height));
    const RenderedRegion part = render_depth_region(mesh, T_camera_object, kVga);
    ASSERT_EQ(part.depth.size(), part.region_px.size()) << place.transpose();
    cv::Mat placed(whole.size(), CV_32FC1, cv::Scalar(std::numeric_limits<float>::quiet_NaN()));
    if (!part.depth.empty()) part.depth.copyTo(placed(part.region_px));
    EXPECT_TRUE(same_bits(placed, whole)) << place.transpose();
    EXPECT_EQ(part.region_px.empty(), place.x() == 3.0) << "out of the image";
    if (place.x() == 0.05) {
      EXPECT_LT(part.region_px.area(), 250 * 250);
    }
    if (place.z() == 0.1) {
      EXPECT_EQ(part.region_px.size(), whole.size()) << "reaches the near plane";
    }
  }
}

TEST(Renderer, AbsurdInputNeitherCrashesNorShowsAnything) {
  Mesh broken = square(0.1F, 1.0F);
  broken.vertices[0].x() = std::numeric_limits<float>::quiet_NaN();
  broken.vertices[3].x() = std::numeric_limits<float>::infinity();
  EXPECT_EQ(cv::countNonZero(render_geometry({{&broken, Eigen::Isometry3d::Identity(), 1}}, kVga).id), 0);
  const Mesh huge = square(1e12F, 1.0F);
  EXPECT_EQ(cv::countNonZero(render_geometry({{&huge, Eigen::Isometry3d::Identity(), 1}}, kVga).id), 640 * 480);
  EXPECT_THROW(render_geometry({{nullptr, Eigen::Isometry3d::Identity(), 1}}, kVga), InputError);
  Camera bad = kVga;
  bad.fx = -1.0;
  EXPECT_THROW(render_geometry({}, bad), InputError);
}

}  // namespace
}  // namespace houghstream
