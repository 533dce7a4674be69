#include "tools/teach/mesh/contact_sheet.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "drivers/files/image_file.hpp"
#include "tests/test_files.hpp"

namespace houghstream::teach {
namespace {

TEST(ContactSheet, AnImageOfAnotherWidthIsNamed) {
  const std::filesystem::path folder = fresh_folder("contact_sheet");
  write_png(cv::Mat(10, 30, CV_8UC3, cv::Scalar(1, 2, 3)), folder / "a.png");
  write_png(cv::Mat(10, 40, CV_8UC3, cv::Scalar(1, 2, 3)), folder / "b.png");
  write_contact_sheet({folder / "a.png", folder / "a.png"}, folder / "sheet.png");
  EXPECT_EQ(read_colour_image(folder / "sheet.png").size(), cv::Size(30, 20));
  const std::string words = error_of([&] {
    write_contact_sheet({folder / "a.png", folder / "b.png"}, folder / "sheet.png");
  });
  EXPECT_NE(words.find("b.png: 40 pixels wide, expected 30"), std::string::npos) << words;
}

TEST(ContactSheet, ShapeSymmetriesAreSaidInWords) {
  const auto rotation = [](double angle_deg, const Eigen::Vector3d& axis) {
    return Eigen::Isometry3d(Eigen::AngleAxisd(angle_deg * M_PI / 180.0, axis));
  };
  ShapeSymmetry shape;
  EXPECT_EQ(symmetry_words(shape), "none");
  shape.nearly_round = ContinuousSymmetry{};
  EXPECT_EQ(symmetry_words(shape), "a spin but for its handle");
  shape.symmetries.discrete = {rotation(180, Eigen::Vector3d::UnitZ())};
  EXPECT_EQ(symmetry_words(shape), "a half turn and a spin but for its handle");
  shape.nearly_round.reset();
  shape.symmetries.continuous.push_back({});
  EXPECT_EQ(symmetry_words(shape), "a spin and a half turn");
  shape.symmetries.continuous.push_back({Eigen::Vector3d::UnitX(), Eigen::Vector3d::Zero()});
  EXPECT_EQ(symmetry_words(shape), "any turn");
  shape.symmetries.continuous.clear();
  shape.symmetries.discrete = {rotation(90, Eigen::Vector3d::UnitZ()), rotation(180, Eigen::Vector3d::UnitX()),
                               rotation(180, Eigen::Vector3d::UnitY()), rotation(-90, Eigen::Vector3d::UnitZ())};
  EXPECT_EQ(symmetry_words(shape), "2 half turns and 2 turns by 90 degrees");
  store::StoredObject object;
  object.name = "tin";
  const Eigen::Vector3d size_m(0.1184, 0.0826, 0.0096);
  EXPECT_EQ(title_of(object, size_m).find("shape symmetries"), std::string::npos) << "not known";
  object.shape_symmetry = shape;
  EXPECT_NE(title_of(object, size_m).find("; shape symmetries: 2 half turns and"), std::string::npos);
  EXPECT_NE(title_of(object, size_m).find("tin (object 0): 118 x 83 x 9.6 mm, "), std::string::npos);
  EXPECT_EQ(size_words(Eigen::Vector3d(NAN, 0.0, 0.0)), "size unknown");
}

}  // namespace
}  // namespace houghstream::teach
