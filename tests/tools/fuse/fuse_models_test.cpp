#include "tools/fuse/fuse_models.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "drivers/datasets/bop_dataset.hpp"
#include "drivers/files/image_file.hpp"
#include "pipeline/base/checks.hpp"
#include "tests/pose/fusion/turntable_views.hpp"
#include "tests/test_files.hpp"
#include "tools/fuse/model_image.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

TrainingView named_view(int class_id, const std::string& class_name, const std::string& object_frame) {
  TrainingView view;
  view.class_id = class_id;
  view.class_name = class_name;
  view.object_frame = object_frame;
  return view;
}

TEST(GroupViews, AClassTakesTheFrameWithTheMostViews) {
  const std::vector<ObjectViews> objects =
      group_views({named_view(2, "mug", ""), named_view(0, "", ""), named_view(1, "can", "can_1_1"),
                   named_view(1, "can", "can_2_1"), named_view(1, "can", "can_2_1"), named_view(2, "mug", "")});
  ASSERT_EQ(objects.size(), 2U);
  EXPECT_EQ(objects[0].class_name, "can");
  EXPECT_EQ(objects[0].views.size(), 2U);
  EXPECT_EQ(objects[0].views.front().object_frame, "can_2_1");
  EXPECT_EQ(objects[0].unused, std::vector<std::string>{"can_1_1"});
  EXPECT_FALSE(objects[0].exact_poses);
  EXPECT_EQ(objects[1].class_name, "mug");
  EXPECT_EQ(objects[1].views.size(), 2U);
  EXPECT_TRUE(objects[1].unused.empty());
  EXPECT_TRUE(objects[1].exact_poses);
}

TEST(GroupViews, BackgroundAloneIsRefused) {
  EXPECT_THROW(group_views({named_view(0, "", "")}), InputError);
  EXPECT_THROW(group_views({}), InputError);
}

TEST(FuseModels, WritesWhatTheOtherToolsRead) {
  const fs::path folder = fresh_folder("fuse_models");
  test_scene::TurntableScene scene{test_scene::cereal_box()};
  fusion::FusionSettings settings;
  settings.grid.voxel = 0.004;
  fuse_models(group_views(turntable_views(scene)), settings, {folder / "models", folder / "pictures"});
  const std::map<std::string, Mesh> models = load_class_models(folder / "models");
  ASSERT_EQ(models.count("toy"), 1U);
  const Mesh& mesh = models.at("toy");
  EXPECT_EQ(mesh.colours.size(), mesh.vertices.size());
  EXPECT_NEAR(mesh_diameter(mesh), mesh_diameter(scene.mesh), 0.016);
  EXPECT_NEAR(read_bop_models(folder / "models").diameters.at(1), mesh_diameter(mesh), 1e-5);
  EXPECT_FALSE(read_colour_image(folder / "pictures" / "toy.png").empty());
}

TEST(FuseModels, TheViewsFolderAndOtherModelsStayAsTheyAre) {
  const fs::path folder = fresh_folder("fuse_models_there");
  fs::create_directories(folder / "views" / "models");
  fs::create_directories(folder / "scanned");
  write_text(folder / "scanned" / "mug.ply", "scanned");
  const std::vector<std::string> views = {"bop:" + (folder / "views").string()};
  EXPECT_NO_THROW(check_outputs({folder / "models", {}}, views));
  EXPECT_NO_THROW(check_outputs({folder / "models", folder / "pictures"}, views));
  EXPECT_THROW(check_outputs({folder / "views" / "models", {}}, views), InputError);
  EXPECT_THROW(check_outputs({folder / "views" / "models", {}, true}, views), InputError) << "never";
  EXPECT_THROW(check_outputs({folder / "models", folder / "views"}, views), InputError);
  EXPECT_THROW(check_outputs({folder / "scanned", {}}, views), InputError);
  EXPECT_NO_THROW(check_outputs({folder / "scanned", {}, true}, views));
  write_text(folder / "file", "");
  EXPECT_THROW(check_outputs({folder / "file", {}}, views), InputError);
  EXPECT_THROW(check_outputs({folder / "models", folder / "file" / "pictures"}, views), InputError);
}

TEST(ModelImage, ShowsTheModelFromAllSides) {
  Mesh mesh = test_scene::cereal_box();
  mesh.colours.assign(mesh.vertices.size(), cv::Vec3b(10, 20, 200));
  compute_normals(mesh);
  const cv::Mat image = draw_model(mesh);
  constexpr int kViews = 6;
  ASSERT_EQ(image.cols % kViews, 0);
  const int size = image.cols / kViews;
  ASSERT_EQ(image.rows, 2 * size);
  for (int k = 0; k < kViews; ++k) {
    EXPECT_EQ(image.at<cv::Vec3b>(size / 2, k * size + size / 2), cv::Vec3b(10, 20, 200)) << "view " << k;
    EXPECT_EQ(image.at<cv::Vec3b>(3, k * size + 3), cv::Vec3b::all(255)) << "view " << k;
  }
  cv::Mat seen;
  cv::inRange(image(cv::Rect(0, 0, size, size)), cv::Scalar(10, 20, 200), cv::Scalar(10, 20, 200), seen);
  EXPECT_GT(cv::boundingRect(seen).height, cv::boundingRect(seen).width) << "upright";
}

}  // namespace
}  // namespace houghstream
