#include <gtest/gtest.h>

#include "tools/doctor/machine.hpp"

namespace houghstream::doctor {
namespace {

TEST(LcmProbe, MessagesOfAnySizeComeBackOnABusOfThisProcess) {
  for (const std::size_t bytes : {std::size_t{1}, std::size_t{1'536'000}}) {
    const SelfTest test = self_test("memq://", bytes);
    EXPECT_EQ(test.sent, 5) << bytes;
    EXPECT_EQ(test.received, 5) << bytes;
    EXPECT_EQ(test.error, "") << bytes;
  }
}

TEST(LcmProbe, ABusThatCannotBeUsedIsSaidToBeSoAndIsSilent) {
  const SelfTest test = self_test("file:///nowhere", 10);
  EXPECT_EQ(test.received, 0);
  EXPECT_NE(test.error, "");
  EXPECT_EQ(heard_bytes("file:///nowhere", "FRAMES"), 0U);
}

TEST(LcmProbe, NothingIsHeardWhereNobodySpeaks) {
  EXPECT_EQ(heard_bytes("memq://", "FRAMES"), 0U);
  EXPECT_TRUE(heard_frame_channels("memq://").empty());
}

}  // namespace
}  // namespace houghstream::doctor
