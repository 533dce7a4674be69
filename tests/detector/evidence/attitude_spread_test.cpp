#include "detector/evidence/attitude_spread.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace houghstream {
namespace {

constexpr float kPi = 3.14159265F;

// Seen from `pitch` above the object's own horizon, then rolled in the picture.
TrainedView view_of(std::uint32_t class_index, float pitch_rad, float roll_rad, float azimuth_rad) {
  TrainedView view;
  view.class_index = class_index;
  view.R_ray_object = Eigen::AngleAxisf(roll_rad, Eigen::Vector3f::UnitZ()) *
                      Eigen::AngleAxisf(0.5F * kPi + pitch_rad, Eigen::Vector3f::UnitX()) *
                      Eigen::AngleAxisf(azimuth_rad, Eigen::Vector3f::UnitZ());
  return view;
}

TEST(AttitudeSpread, IsOneForATurntableAtAnyPitch) {
  Forest forest;
  for (int i = 0; i < 36; ++i) {
    for (const float pitch : {0.1F, 0.7F, 1.5F}) {
      forest.views.push_back(view_of(0, pitch, 0.0F, 2.0F * kPi * static_cast<float>(i) / 36.0F));
      forest.views.push_back(view_of(1, pitch, 0.5F * kPi, 0.0F));  // another class does not matter
    }
  }
  EXPECT_EQ(attitude_spread(forest, 0), 1.0F);
}

TEST(AttitudeSpread, CountsViewsThatAreNotUpright) {
  Forest forest;
  for (const float roll : {0.0F, 0.5F * kPi, kPi}) forest.views.push_back(view_of(0, 0.7F, roll, 0.3F));
  EXPECT_FLOAT_EQ(attitude_spread(forest, 0), 3.0F);
  forest.views.erase(forest.views.begin());
  EXPECT_FLOAT_EQ(attitude_spread(forest, 0), 4.0F);  // no upright one at all
}

}  // namespace
}  // namespace houghstream
