#include "pipeline/types/object_pose.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace houghstream {
namespace {

TEST(PoseStatus, EachHasWordsOfItsOwn) {
  std::set<std::string> words;
  for (int status = 0; status <= static_cast<int>(PoseStatus::kOccluded); ++status) {
    words.insert(to_string(static_cast<PoseStatus>(status)));
  }
  EXPECT_EQ(words.size(), 11U);
  EXPECT_EQ(words.count("unknown"), 0U);
  EXPECT_STREQ(to_string(static_cast<PoseStatus>(99)), "unknown");
}

}  // namespace
}  // namespace houghstream
