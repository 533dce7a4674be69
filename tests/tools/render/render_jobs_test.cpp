#include "tools/render/render_jobs.hpp"

#include <gtest/gtest.h>

#include "drivers/datasets/bop_dataset.hpp"
#include "pipeline/base/checks.hpp"
#include "tests/test_files.hpp"

namespace houghstream::render {
namespace {

namespace fs = std::filesystem;
using namespace world;

TurntableSettings one_view() {
  TurntableSettings turntable;
  turntable.azimuths = 1;
  turntable.pitches = 1;
  return turntable;
}

RenderOptions into(const fs::path& folder) {
  RenderOptions options;
  options.out = folder;
  options.threads = 1;
  return options;
}

TEST(RenderJobs, AllTwentyAreTaughtUnderTheirOwnIdsAndNames) {
  const fs::path folder = fresh_folder("render_jobs_all_20");
  render_training(into(folder), {"all_20"}, one_view());
  const std::vector<int> ids = twenty_class_ids();
  EXPECT_EQ(read_bop_models(folder / "models").names.size(), ids.size());
  for (const int id : ids) {
    const BopScene scene(folder / fmt::format("{:06d}", id));
    ASSERT_EQ(scene.images().size(), 1U);
    EXPECT_EQ(scene.images()[0].objects.at(0).object_id, id);
    EXPECT_EQ(find_bop_names(scene.folder()).at(id), make_taught_object(id).name);
  }
}

TEST(RenderJobs, AllMeansTheFourClassesAndNamesMayBeAny) {
  const fs::path four = fresh_folder("render_jobs_all");
  render_training(into(four), {"all"}, one_view());
  EXPECT_EQ(read_bop_models(four / "models").names.size(), 4U);
  const fs::path named = fresh_folder("render_jobs_named");
  render_training(into(named), {"teapot", "bowl_2"}, one_view());
  EXPECT_EQ(read_bop_models(named / "models").names, (std::map<int, std::string>{{5, "bowl_2"}, {102, "teapot"}}));
  EXPECT_THROW(render_training(into(named), {"bathtub"}, one_view()), InputError);
}

TEST(RenderJobs, ASceneBringsTheModelsOfWhatItMayHold) {
  const fs::path folder = fresh_folder("render_jobs_scene");
  render_scene(into(folder), {"objects_20_b", 1, 1});
  const BopModels models = read_bop_models(folder / "models");
  EXPECT_EQ(models.names.size(), 20U);
  ASSERT_EQ(models.symmetries.at(104).continuous.size(), 1U) << "a tumbler";
  EXPECT_EQ(models.symmetries.at(104).continuous[0].axis, Eigen::Vector3d::UnitZ());
  EXPECT_TRUE(models.symmetries.at(102).empty()) << "a teapot";
  const BopScene scene(folder);
  EXPECT_GE(scene.images().at(0).objects.size(), 8U);
  for (const GroundTruthObject& object : scene.images().at(0).objects)
    EXPECT_EQ(models.names.count(object.object_id), 1U) << object.object_id;
  const fs::path demo = fresh_folder("render_jobs_demo");
  render_scene(into(demo), {"table_small_1", 1, 1});
  EXPECT_EQ(read_bop_models(demo / "models").names.size(), 4U);
}

TEST(RenderJobs, ASceneMayBeSeenByAnotherSensor) {
  const fs::path usual = fresh_folder("render_jobs_usual");
  const fs::path other = fresh_folder("render_jobs_other");
  render_scene(into(usual), {"table_small_1", 2, 2});
  render_scene(into(other), {"table_small_1", 2, 2, SensorKind::kTimeOfFlight});
  for (const char* same : {"scene_gt.json", "scene_camera.json", "scene_gt_info.json", "models/models_info.json"})
    EXPECT_EQ(read_text(usual / same), read_text(other / same)) << same;
  EXPECT_NE(read_text(usual / "depth/000000.png"), read_text(other / "depth/000000.png"));
  EXPECT_NE(read_text(usual / "rgb/000000.png"), read_text(other / "rgb/000000.png"));
}

TEST(RenderJobs, WhatIsThereGivesWayOnlyWhereThatIsAskedFor) {
  const fs::path folder = fresh_folder("render_jobs_there");
  fs::create_directories(folder / "rgb");
  write_text(folder / "rgb/000007.png", "recorded");
  RenderOptions options = into(folder);
  EXPECT_NE(error_of([&] { render_background(options, 1); }).find(folder.string() + ": holds pictures"),
            std::string::npos);
  EXPECT_THROW(render_scene(options, {"table_small_1", 1, 1}), InputError);
  EXPECT_FALSE(fs::exists(folder / "models"));
  EXPECT_EQ(read_text(folder / "rgb/000007.png"), "recorded");
  options.replace = true;
  render_background(options, 1);
  EXPECT_FALSE(fs::exists(folder / "rgb/000007.png"));
  EXPECT_EQ(BopScene(folder).images().size(), 1U);

  const fs::path scanned = fresh_folder("render_jobs_scanned");
  fs::create_directories(scanned / "models");
  write_text(scanned / "models/obj_000001.ply", "scanned");
  EXPECT_THROW(render_training(into(scanned), {"bowl"}, one_view()), InputError);
  EXPECT_EQ(read_text(scanned / "models/obj_000001.ply"), "scanned");
}

}  // namespace
}  // namespace houghstream::render
