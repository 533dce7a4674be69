#include "pipeline/base/logit.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

TEST(LogOdds, AreUndoneByTheLogistic) {
  for (const double p : {0.001, 0.2, 0.5, 0.97, 0.999}) EXPECT_NEAR(logistic(logit(p)), p, 1e-12);
}

TEST(LogOdds, NothingIsCertain) {
  EXPECT_NEAR(logistic(logit(0.0)), 0.001, 1e-12);
  EXPECT_NEAR(logistic(logit(1.0)), 0.999, 1e-12);
  EXPECT_NEAR(logistic(logit(1.0, 0.1)), 0.9, 1e-12);
}

}  // namespace
}  // namespace houghstream
