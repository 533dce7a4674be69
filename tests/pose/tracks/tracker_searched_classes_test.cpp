#include <gtest/gtest.h>

#include <vector>

#include "pose/tracks/tracker.hpp"

namespace houghstream::tracks {
namespace {

constexpr std::int64_t kSecond = 1000000;

ObjectPoses telling(std::int64_t utime, const std::vector<std::string>& names, PoseStatus status = PoseStatus::kValid) {
  ObjectPoses poses;
  poses.frame = {"CAMERA", utime};
  for (const std::string& name : names) {
    ObjectPose pose;
    pose.class_name = name;
    pose.status = status;
    poses.poses.push_back(pose);
  }
  return poses;
}

TEST(SearchedClasses, OneDetectorsResultsSpeakOfEverything) {
  SearchedClasses searched;
  searched.note(telling(1, {"can", "mug"}));
  searched.note(telling(2, {"bowl"}));
  EXPECT_TRUE(searched.has_searched(telling(2, {"bowl"}), "can"));
  EXPECT_TRUE(searched.has_searched(telling(2, {}), "can"));
  EXPECT_TRUE(searched.has_searched(telling(2, {"bowl"}), "never heard of"));
}

TEST(SearchedClasses, OfSeveralDetectorsEachSpeaksOfItsOwnClasses) {
  SearchedClasses searched;
  searched.note(telling(1, {"can", "mug"}));
  searched.note(telling(1, {"bowl"}));
  const ObjectPoses mug = telling(2, {"mug"});
  searched.note(mug);
  EXPECT_TRUE(searched.has_searched(mug, "mug"));
  EXPECT_TRUE(searched.has_searched(mug, "can")) << "told of together once";
  EXPECT_FALSE(searched.has_searched(mug, "bowl"));
  EXPECT_FALSE(searched.has_searched(telling(2, {}), "bowl")) << "its own detector may say that, and will again";
  EXPECT_FALSE(searched.has_searched(telling(2, {"bowl"}, PoseStatus::kNoModel), "bowl")) << "another host's hs-pose";
  EXPECT_TRUE(searched.has_searched(telling(2, {"bowl"}, PoseStatus::kNotConverged), "bowl"));
}

TEST(SearchedClasses, ADetectorThatIsSilentLeavesItsClassesToTheOthers) {
  SearchedClasses searched;
  searched.note(telling(kSecond, {"can"}));
  searched.note(telling(kSecond, {"bowl"}));
  for (std::int64_t utime = kSecond; utime <= 3 * kSecond; utime += kSecond / 10)
    searched.note(telling(utime, {"can"}));
  EXPECT_FALSE(searched.has_searched(telling(2 * kSecond, {"can"}), "bowl"));
  EXPECT_TRUE(searched.has_searched(telling(3 * kSecond, {"can"}), "bowl"));
}

TEST(SearchedClasses, ClassesThatNothingIsKnownOfAreForgotten) {
  SearchedClasses searched;
  searched.note(telling(1, {"can"}));
  searched.note(telling(1, {"bowl"}));
  EXPECT_FALSE(searched.has_searched(telling(1, {"can"}), "bowl"));
  searched.keep_only({"can"});
  EXPECT_TRUE(searched.has_searched(telling(1, {"can"}), "bowl"));
}

}  // namespace
}  // namespace houghstream::tracks
