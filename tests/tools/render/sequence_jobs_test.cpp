#include "tools/render/sequence_jobs.hpp"

#include <gtest/gtest.h>

#include "drivers/datasets/bop_dataset.hpp"
#include "drivers/files/json_file.hpp"
#include "pipeline/base/checks.hpp"
#include "tests/test_files.hpp"

namespace houghstream::render {
namespace {

namespace fs = std::filesystem;

TEST(SequenceJobs, EveryFrameHasTheTruthOfAllInstancesAndOfTheCamera) {
  const fs::path folder = fresh_folder("sequence_jobs");
  RenderOptions options;
  options.out = folder;
  options.threads = 1;
  SequencesJob job;
  job.names = {"removed"};
  job.fps = 1.0;
  job.development = true;
  render_sequences(options, job);
  const nlohmann::json json = read_json_object(folder / "removed" / "sequence.json");
  ASSERT_EQ(json["objects"].size(), 4U);
  EXPECT_EQ(json["objects"][3]["name"], "soda_can");
  ASSERT_EQ(json["frames"].size(), 13U);
  const BopScene scene(folder / "removed" / "000001");
  ASSERT_EQ(scene.images().size(), 13U);
  EXPECT_EQ(json["frames"][1]["utime"], dataset_utime(0) + 1000000);
  EXPECT_TRUE(json["frames"][6]["objects"][3].is_null());  // the can has been taken away
  EXPECT_FALSE(json["frames"][11]["objects"][3].is_null());
  EXPECT_EQ(json["frames"][6]["cameras"][0]["visible"][3], 0.0);
  EXPECT_GT(json["frames"][0]["cameras"][0]["visible"][3], 0.5);
  for (const GroundTruthObject& object : scene.images()[6].objects) EXPECT_NE(object.object_id, 4);
  EXPECT_EQ(json["frames"][0]["cameras"][0]["T_world_camera"].size(), 7U);
}

TEST(SequenceJobs, UnknownSequencesAreRefused) {
  RenderOptions options;
  options.out = fresh_folder("sequence_jobs_refused");
  SequencesJob job;
  job.names = {"dance"};
  EXPECT_NE(
      error_of([&] { render_sequences(options, job); }).find("sequence \"dance\": expected all or one of walk, pushed"),
      std::string::npos);
  job.names = {"walk"};
  job.fps = 0.0;
  EXPECT_THROW(render_sequences(options, job), InputError);
}

}  // namespace
}  // namespace houghstream::render
