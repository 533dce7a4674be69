#include "pipeline/base/zstd_bytes.hpp"

#include <gtest/gtest.h>

#include "pipeline/base/checks.hpp"
#include "tests/expect_says.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

TEST(ZstdBytes, ComeBackInFewerBytes) {
  const std::string bytes(10000, 'a');
  const std::string frame = compress_zstd(bytes, 3);
  EXPECT_LT(frame.size(), 100U);
  std::string back(bytes.size(), '\0');
  decompress_zstd(frame, back.data(), back.size(), "a test");
  EXPECT_EQ(back, bytes);
}

TEST(ZstdBytes, NothingComesBackAsNothing) {
  EXPECT_NO_THROW(decompress_zstd(compress_zstd("", 3), nullptr, 0, "a test"));
}

TEST(ZstdBytes, OtherSizesAndDamageAreRefused) {
  const std::string frame = compress_zstd("abcdefgh", 3);
  std::string back(16, '\0');
  expect_says(error_of([&] { decompress_zstd(frame, back.data(), 7, "a test"); }), {"a test cannot be decompressed"});
  expect_says(error_of([&] { decompress_zstd(frame, back.data(), 16, "a test"); }),
              {"a test decompresses to 8 bytes, expected 16"});
  expect_says(error_of([&] { decompress_zstd(frame.substr(0, 9), back.data(), 8, "a test"); }),
              {"a test cannot be decompressed"});
}

}  // namespace
}  // namespace houghstream
