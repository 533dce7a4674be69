#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace houghstream {

/// The error is one line in which all of these stand.
inline void expect_says(const std::string& error, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) EXPECT_NE(error.find(part), std::string::npos) << part << " in: " << error;
  EXPECT_EQ(error.find('\n'), std::string::npos) << error;
}

}  // namespace houghstream
