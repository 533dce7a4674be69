#include "tools/evaluate/metrics/search_times.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "pipeline/base/checks.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

EvaluatedFrame frame(int image_id) {
  EvaluatedFrame out;
  out.scene = "000050";
  out.image_id = image_id;
  return out;
}

TEST(SearchTimes, StagesAreSummedByTheProgramAndSkippedFramesHaveNone) {
  EvaluatedFrame both = frame(5);
  both.detections.emplace();
  both.detections->detections.resize(2);
  both.poses.emplace();
  both.poses->poses.resize(2);
  both.poses->poses[1].T_camera_object = Eigen::Isometry3d::Identity();
  both.poses->stages = {{"detect.leaves", 1500}, {"pose.choice", 400}, {"detect.votes", 250}, {"pose.region", 100}};
  EvaluatedFrame detected = frame(9);
  detected.detections.emplace();
  detected.detections->stages = {{"detect.leaves", 2000}};
  const std::filesystem::path file = fresh_folder("search_times") / "frames.csv";
  write_search_times({both, frame(7), detected}, file);
  std::ifstream in(file);
  std::stringstream text;
  text << in.rdbuf();
  EXPECT_EQ(text.str(),
            "scene,image_id,detect_ms,pose_ms,detections,poses\n"
            "000050,5,1.750,0.500,2,1\n"
            "000050,9,2.000,,0,0\n");
}

TEST(SearchTimes, AFolderThatIsNotThereIsRefused) {
  EXPECT_THROW(write_search_times({}, "/no/such/folder/frames.csv"), InputError);
}

}  // namespace
}  // namespace houghstream
