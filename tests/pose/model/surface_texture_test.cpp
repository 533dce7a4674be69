#include "pose/model/surface_texture.hpp"

#include <gtest/gtest.h>

#include "pose/model/object_model.hpp"
#include "tests/pose/printed_box.hpp"

namespace houghstream {
namespace {

const LabColour kRed = {100, 200, 190};
const LabColour kBlue = {80, 130, 60};

TEST(SurfaceTexture, KnowsTheSidesOfAThinSheet) {
  SurfaceTextureBuilder maker(0.01);
  maker.add({0.001F, 0.002F, 0.003F}, Eigen::Vector3f::UnitZ(), kRed);
  maker.add({0.002F, 0.001F, 0.003F}, -Eigen::Vector3f::UnitZ(), kBlue);
  const SurfaceTexture texture = maker.make();
  const Eigen::Vector3f point(0.005F, 0.005F, 0.005F);
  ASSERT_TRUE(texture.find(point, Eigen::Vector3f::UnitZ()).has_value());
  EXPECT_EQ(*texture.find(point, Eigen::Vector3f::UnitZ()), Eigen::Vector3f(100, 200, 190));
  EXPECT_EQ(*texture.find(point, {0.3F, 0.0F, -2.0F}), Eigen::Vector3f(80, 130, 60));
}

TEST(SurfaceTexture, AveragesWhatIsSmallerThanACube) {
  SurfaceTextureBuilder maker(0.01);
  maker.add({0.001F, 0.0F, 0.0F}, Eigen::Vector3f::UnitX(), {10, 20, 30});
  maker.add({0.009F, 0.0F, 0.0F}, Eigen::Vector3f::UnitX(), {30, 40, 50});
  EXPECT_EQ(*maker.make().find({0.005F, 0.0F, 0.0F}, Eigen::Vector3f::UnitX()), Eigen::Vector3f(20, 30, 40));
}

TEST(SurfaceTexture, FindsNothingWhereNoSurfaceIs) {
  SurfaceTextureBuilder maker(0.01);
  maker.add({0.005F, 0.005F, 0.005F}, Eigen::Vector3f::UnitX(), kRed);
  const SurfaceTexture texture = maker.make();
  EXPECT_TRUE(texture.find({0.015F, 0.005F, 0.005F}, Eigen::Vector3f::UnitX()).has_value()) << "next to it";
  EXPECT_FALSE(texture.find({0.025F, 0.005F, 0.005F}, Eigen::Vector3f::UnitX()).has_value());
  EXPECT_FALSE(texture.find({0.005F, 0.005F, 0.005F}, -Eigen::Vector3f::UnitX()).has_value()) << "it turns away";
  EXPECT_FALSE(SurfaceTexture().find({0.0F, 0.0F, 0.0F}, Eigen::Vector3f::UnitX()).has_value());
}

TEST(SurfaceTexture, OfAModelIsThatOfItsSurface) {
  const ObjectModel model = make_object_model("box", test_scene::printed_box(), {});
  ASSERT_FALSE(model.texture.empty());
  for (const ModelView& view : model.views) {
    int found = 0;
    for (std::size_t i = 0; i < view.points.size(); ++i)
      found += model.texture.find(view.points[i], view.direction).has_value() ? 1 : 0;
    EXPECT_GE(found, static_cast<int>(0.97 * static_cast<double>(view.points.size())));
  }
  EXPECT_TRUE(make_object_model("box", test_scene::cereal_box(), {}).texture.empty());
}

}  // namespace
}  // namespace houghstream
