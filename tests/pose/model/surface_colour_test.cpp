#include "pose/model/surface_colour.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

namespace houghstream {
namespace {

/// Returns a square of 0.1 m, two triangles.
Mesh square() {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {0.1F, 0, 0}, {0.1F, 0.1F, 0}, {0, 0.1F, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

LabColour lab_of(const cv::Vec3b& bgr) {
  cv::Mat pixel(1, 1, CV_8UC3, cv::Scalar(bgr[0], bgr[1], bgr[2]));
  cv::cvtColor(pixel, pixel, cv::COLOR_BGR2Lab);
  const auto& lab = pixel.at<cv::Vec3b>(0, 0);
  return {lab[0], lab[1], lab[2]};
}

TEST(SurfaceColour, VertexColoursAreMixed) {
  Mesh mesh = square();
  mesh.colours = {{0, 0, 200}, {0, 200, 0}, {200, 0, 0}, {0, 0, 0}};
  const SurfaceColour colour(mesh, 0.002);
  ASSERT_TRUE(colour.has_colour());
  EXPECT_EQ(colour.at(0, {0.0F, 0.0F}), lab_of({0, 0, 200}));
  EXPECT_EQ(colour.at(0, {1.0F, 0.0F}), lab_of({0, 200, 0}));
  EXPECT_EQ(colour.at(0, {0.0F, 0.5F}), lab_of({100, 0, 100}));
}

TEST(SurfaceColour, ATextureIsReadWhereItIsMappedAndFineTextureIsAveraged) {
  Mesh mesh = square();
  mesh.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};  // v down
  mesh.texture = cv::Mat(200, 200, CV_8UC3, cv::Scalar(0, 0, 200));
  mesh.texture.rowRange(0, 100).setTo(cv::Scalar(200, 0, 0));
  EXPECT_EQ(SurfaceColour(mesh, 0.002).at(0, {0.5F, 0.0F}), lab_of({0, 0, 200}));  // the lower edge
  EXPECT_EQ(SurfaceColour(mesh, 0.002).at(1, {0.1F, 0.85F}), lab_of({200, 0, 0}));
  for (int x = 0; x < 200; x += 2) mesh.texture.col(x).setTo(cv::Scalar(0, 0, 0));
  mesh.texture.rowRange(0, 200).setTo(cv::Scalar(100, 100, 100));
  for (int x = 0; x < 200; x += 2) mesh.texture.col(x).setTo(cv::Scalar(0, 0, 0));
  const LabColour averaged = SurfaceColour(mesh, 0.01).at(0, {0.5F, 0.25F});
  EXPECT_NEAR(averaged[0], lab_of({50, 50, 50})[0], 8);
}

TEST(SurfaceColour, AMeshWithoutColoursHasNone) {
  const Mesh mesh = square();
  EXPECT_FALSE(SurfaceColour(mesh, 0.002).has_colour());
}

}  // namespace
}  // namespace houghstream
