#include "tools/render/take_jobs.hpp"

#include <gtest/gtest.h>

#include "drivers/datasets/bop_dataset.hpp"
#include "drivers/files/json_file.hpp"
#include "pipeline/base/checks.hpp"
#include "tests/test_files.hpp"

namespace houghstream::render {
namespace {

namespace fs = std::filesystem;

RenderOptions takes_into(const fs::path& folder) {
  RenderOptions options;
  options.out = folder;
  options.threads = 1;
  return options;
}

TakesJob two_frames(const std::vector<std::string>& objects) {
  TakesJob job;
  job.objects = objects;
  job.frames = 2;
  job.fps = 1.0;
  job.development = true;
  return job;
}

TEST(TakeJobs, ObjectsAreWrittenUnderTheirNumbersWithTruthOfEveryFrame) {
  const fs::path folder = fresh_folder("take_jobs");
  TakesJob job = two_frames({"coffee_mug", "bowl"});
  job.take = 2;
  render_takes(takes_into(folder), job);
  const nlohmann::json takes = read_json_list(folder / "takes.json");
  ASSERT_EQ(takes.size(), 2U);
  EXPECT_EQ(takes[0], (nlohmann::json{{"scene", 2},
                                      {"object", "bowl"},
                                      {"id", 1},
                                      {"kind", "hand_held"},
                                      {"take", 2},
                                      {"frames", 2},
                                      {"fps", 1.0}}));
  EXPECT_EQ(takes[1].at("scene"), 6);
  EXPECT_EQ(read_bop_models(folder / "models").names, (std::map<int, std::string>{{1, "bowl"}, {3, "coffee_mug"}}));
  const BopScene scene(folder / "test" / "000006");
  ASSERT_EQ(scene.images().size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    ASSERT_EQ(scene.images()[i].objects.size(), 1U);
    EXPECT_EQ(scene.images()[i].objects[0].object_id, 3);
    EXPECT_GT(cv::countNonZero(scene.read_mask(i, 0)), 1000);
  }
}

TEST(TakeJobs, WhatIsNotShownOrTooShortIsRefused) {
  const RenderOptions options = takes_into(fresh_folder("take_jobs_refused"));
  EXPECT_NE(error_of([&] {
              render_takes(options, two_frames({"plate"}));
            }).find("object \"plate\": expected all or one of bowl"),
            std::string::npos);
  TakesJob job = two_frames({"bowl"});
  job.frames = 1;
  EXPECT_THROW(render_takes(options, job), InputError);
  job = two_frames({"bowl"});
  job.fps = 0.0;
  EXPECT_THROW(render_takes(options, job), InputError);
  EXPECT_FALSE(fs::exists(options.out / "takes.json"));
}

}  // namespace
}  // namespace houghstream::render
