#include "tools/pose/model_cache.hpp"

#include <gtest/gtest.h>

#include "drivers/store/store_stamp.hpp"
#include "pose/pose_estimator.hpp"
#include "tests/drivers/store/small_store.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

bool same_bytes(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && (a.empty() || cv::norm(a, b, cv::NORM_INF) == 0.0);
}

void expect_same(const ObjectModel& a, const ObjectModel& b) {
  EXPECT_EQ(a.mesh.vertices, b.mesh.vertices);
  EXPECT_EQ(a.mesh.normals, b.mesh.normals);
  EXPECT_EQ(a.mesh.colours, b.mesh.colours);
  EXPECT_EQ(a.mesh.uvs, b.mesh.uvs);
  EXPECT_EQ(a.mesh.triangles, b.mesh.triangles);
  EXPECT_TRUE(same_bytes(a.mesh.texture, b.mesh.texture));
  EXPECT_EQ(a.centre, b.centre);
  EXPECT_EQ(a.vote_centre, b.vote_centre);
  EXPECT_EQ(a.surface_median, b.surface_median);
  EXPECT_EQ(a.axes, b.axes);
  EXPECT_EQ(a.radius, b.radius);
  ASSERT_EQ(a.shape_symmetries.discrete.size(), b.shape_symmetries.discrete.size());
  for (std::size_t i = 0; i < a.shape_symmetries.discrete.size(); ++i)
    EXPECT_EQ(a.shape_symmetries.discrete[i].matrix(), b.shape_symmetries.discrete[i].matrix());
  ASSERT_EQ(a.shape_symmetries.continuous.size(), b.shape_symmetries.continuous.size());
  ASSERT_EQ(a.nearly_round.has_value(), b.nearly_round.has_value());
  if (a.nearly_round) {
    EXPECT_EQ(a.nearly_round->axis, b.nearly_round->axis);
    EXPECT_EQ(a.nearly_round->offset, b.nearly_round->offset);
  }
  ASSERT_EQ(a.views.size(), b.views.size());
  for (std::size_t i = 0; i < a.views.size(); ++i) {
    EXPECT_EQ(a.views[i].direction, b.views[i].direction);
    EXPECT_EQ(a.views[i].points, b.views[i].points);
    EXPECT_EQ(a.views[i].normals, b.views[i].normals);
    EXPECT_EQ(a.views[i].colours, b.views[i].colours);
    EXPECT_EQ(a.views[i].area, b.views[i].area);
  }
}

/// A store whose mug has a texture, and what is made of its meshes.
struct MadeOfStore {
  explicit MadeOfStore(const std::string& name) : folder(store::whole_store(name)) {
    Mesh textured = load_mesh(folder / "models/obj_000002.ply");
    for (const Eigen::Vector3f& vertex : textured.vertices) textured.uvs.emplace_back(vertex.x(), vertex.y());
    textured.colours.clear();
    textured.texture = cv::Mat(8, 6, CV_8UC3, cv::Scalar(10, 20, 200));
    textured.texture.at<cv::Vec3b>(2, 3) = {1, 2, 3};
    save_ply(textured, folder / "models/obj_000002.ply");
    list = store::read_store(folder);
    models = PoseEstimator(store::load_store_meshes(list), PoseSettings()).models();
  }

  std::string state_for(const ModelCache& kept) const {
    return kept.state_of(store::mesh_stamp(list), ModelSettings());
  }

  fs::path folder;
  store::ObjectStore list;
  std::map<std::string, ObjectModel> models;
};

fs::path only_file_in(const fs::path& folder) {
  return fs::directory_iterator(folder)->path();
}

TEST(ModelCache, ComeBackBitForBit) {
  const MadeOfStore made("kept_models");
  const ModelCache kept(fresh_folder("kept_models_cache") / "models");
  EXPECT_FALSE(kept.find(made.folder, made.state_for(kept)).has_value());
  kept.keep(made.folder, made.state_for(kept), made.models);
  const auto found = kept.find(made.folder, made.state_for(kept));
  ASSERT_TRUE(found.has_value());
  ASSERT_EQ(found->size(), 2U);
  EXPECT_FALSE(found->at("mug").mesh.texture.empty());
  for (const auto& [name, model] : made.models) expect_same(found->at(name), model);
}

TEST(ModelCache, ShapeSymmetriesComeBackAndMakeAnotherState) {
  const MadeOfStore made("kept_models_shape");
  const ModelCache kept(fresh_folder("kept_models_shape_cache") / "models");
  std::map<std::string, ObjectModel> models = made.models;
  ObjectModel& mug = models.at("mug");
  mug.shape_symmetries.discrete.assign(2, Eigen::Isometry3d(Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitX())));
  mug.nearly_round = ContinuousSymmetry{Eigen::Vector3d::UnitX(), {0.1, 0.2, 0.3}};
  kept.keep(made.folder, made.state_for(kept), models);
  const auto found = kept.find(made.folder, made.state_for(kept));
  ASSERT_TRUE(found.has_value());
  for (const auto& [name, model] : models) expect_same(found->at(name), model);
  ModelSettings other;
  other.shape_symmetries["mug"].nearly_round = ContinuousSymmetry{};
  EXPECT_FALSE(kept.find(made.folder, kept.state_of(store::mesh_stamp(made.list), other)).has_value());
}

TEST(ModelCache, OfAnotherStateAreNone) {
  const MadeOfStore made("kept_models_state");
  const ModelCache kept(fresh_folder("kept_models_state_cache"));
  const std::string before = made.state_for(kept);
  kept.keep(made.folder, before, made.models);
  ModelSettings fewer;
  fewer.points_per_view = 50;
  EXPECT_FALSE(kept.find(made.folder, kept.state_of(store::mesh_stamp(made.list), fewer)).has_value());
  write_text(made.folder / "models/obj_000005.ply", read_text(made.folder / "models/obj_000005.ply"));
  EXPECT_NE(made.state_for(kept), before) << "written anew, if with the same bytes";
  EXPECT_FALSE(kept.find(made.folder, made.state_for(kept)).has_value());
}

TEST(ModelCache, DamagedOnesOrThoseThatOthersMayWriteAreNone) {
  const MadeOfStore made("kept_models_damaged");
  const fs::path folder = fresh_folder("kept_models_damaged_cache");
  const ModelCache kept(folder);
  kept.keep(made.folder, made.state_for(kept), made.models);
  const fs::path file = only_file_in(folder);
  const std::string whole = read_text(file);
  for (std::size_t i = 0; i < 60; ++i) {
    std::ofstream(file, std::ios::binary) << whole.substr(0, whole.size() * i / 60);
    EXPECT_FALSE(kept.find(made.folder, made.state_for(kept)).has_value()) << "cut to " << whole.size() * i / 60;
    std::string flipped = whole;
    flipped[(i * 7919) % flipped.size()] ^= 4;
    std::ofstream(file, std::ios::binary) << flipped;
    EXPECT_FALSE(kept.find(made.folder, made.state_for(kept)).has_value()) << "flip " << i;
  }
  std::ofstream(file, std::ios::binary) << whole;
  EXPECT_TRUE(kept.find(made.folder, made.state_for(kept)).has_value());
  fs::permissions(file, fs::perms::others_write, fs::perm_options::add);
  EXPECT_FALSE(kept.find(made.folder, made.state_for(kept)).has_value());
}

TEST(ModelCache, AreOfFewStoresAndNeedNoPlace) {
  const MadeOfStore made("kept_models_few");
  const fs::path folder = fresh_folder("kept_models_few_cache");
  const ModelCache kept(folder);
  for (int i = 0; i < 12; ++i) kept.keep(made.folder.parent_path() / std::to_string(i), "state", made.models);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 8);
  write_text(folder / "file", "");
  EXPECT_NO_THROW(ModelCache(folder / "file").keep(made.folder, "state", made.models));
  EXPECT_FALSE(ModelCache("").find(made.folder, "state").has_value());
}

}  // namespace
}  // namespace houghstream
