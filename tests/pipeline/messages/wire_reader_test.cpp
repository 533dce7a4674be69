#include "pipeline/messages/wire_reader.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "pipeline/base/checks.hpp"

namespace houghstream {
namespace {

TEST(WireReader, ReadsBigEndianNumbersAndStrings) {
  const std::vector<std::uint8_t> bytes = {0xFF, 0xFF, 0xFF, 0xFE, 0, 0, 0, 0, 0, 0, 1, 2, 0, 0, 0, 3, 'o', 'k', 0};
  WireReader reader({bytes.data(), bytes.size()}, "test");
  EXPECT_EQ(reader.read_int32(), -2);
  EXPECT_EQ(reader.read_int64(), 258);
  EXPECT_EQ(reader.read_string(), "ok");
  EXPECT_EQ(reader.left(), 0U);
  EXPECT_THROW(reader.skip(1), InputError);
}

TEST(WireReader, RefusesStringsWithoutEnd) {
  const std::vector<std::uint8_t> open = {0, 0, 0, 2, 'o', 'k'};
  EXPECT_THROW(WireReader({open.data(), open.size()}, "test").read_string(), InputError);
  const std::vector<std::uint8_t> nothing = {0, 0, 0, 0};
  EXPECT_THROW(WireReader({nothing.data(), nothing.size()}, "test").read_string(), InputError);
}

TEST(WireReader, RefusesCountsThatCannotFit) {
  const std::vector<std::uint8_t> three = {0, 0, 0, 3, 1, 2, 3};
  EXPECT_EQ(WireReader({three.data(), three.size()}, "test").read_count(1), 3U);
  EXPECT_THROW(WireReader({three.data(), three.size()}, "test").read_count(2), InputError);
}

}  // namespace
}  // namespace houghstream
