#include "drivers/datasets/uw_scenes.hpp"

#include <gtest/gtest.h>

#include "drivers/files/image_file.hpp"
#include "pipeline/base/checks.hpp"
#include "tests/drivers/mat_writing.hpp"
#include "tests/test_files.hpp"

namespace houghstream {
namespace {

namespace fs = std::filesystem;

const cv::Size kSize(64, 48);

/// desk/desk_1/ with frames 1 to `count` in a folder of this test's own, without its annotations.
fs::path write_frames(int count) {
  const std::string test = ::testing::UnitTest::GetInstance()->current_test_info()->name();
  fs::path folder = fresh_folder("uw_scenes_" + test) / "desk" / "desk_1";
  fs::create_directories(folder);
  for (int number = 1; number <= count; ++number) {
    const std::string stem = (folder / ("desk_1_" + std::to_string(number))).string();
    write_png(cv::Mat(kSize, CV_8UC3, cv::Scalar::all(number)), stem + ".png");
    write_png(cv::Mat(kSize, CV_16UC1, cv::Scalar(700)), stem + "_depth.png");
  }
  return folder;
}

fs::path mat_of(const fs::path& folder) {
  return folder.parent_path() / "desk_1.mat";
}

/// One frame with one box, annotated with `cell`.
fs::path write_one(matvar_t* cell) {
  fs::path folder = write_frames(1);
  write_mat(mat_of(folder), mat_cells("bboxes", {cell}));
  return folder;
}

/// The message of the refusal; empty where nothing is refused.
std::string refusal(const fs::path& folder) {
  try {
    read_uw_scene(folder, kSize);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

void expect_refused(const fs::path& folder, const std::string& expected) {
  const std::string message = refusal(folder);
  EXPECT_NE(message.find(expected), std::string::npos) << "'" << message << "' lacks '" << expected << "'";
  EXPECT_NE(message.find("desk_1"), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

/// A cell array `bboxes` with one cell that is empty, as a big-endian machine writes it.
std::string big_endian_mat() {
  std::string bytes(124, ' ');
  bytes += std::string("\x01\x00MI", 4);
  for (const std::uint32_t word : {14U, 56U, 6U, 8U, 1U, 0U, 5U, 8U, 1U, 1U, 1U, 6U}) {
    for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(word >> shift & 0xffU);
  }
  return bytes + std::string("bboxes\0\0\0\0\0\x0e\0\0\0\0", 16);
}

TEST(UwScenes, BoxesAreThoseOfTheFileFrameByFrame) {
  const fs::path folder = write_frames(11);
  for (const bool compressed : {false, true}) {
    std::vector<matvar_t*> cells(11);
    for (matvar_t*& cell : cells) cell = mat_boxes({});
    Mat_VarFree(cells[1]);
    Mat_VarFree(cells[9]);
    cells[1] = mat_boxes({uw_box("coffee_mug", 5, {11, 20, 3, 7}), uw_box("soda_can", 1, {1, 48, 1, 64})});
    cells[9] = mat_boxes({uw_box("cap", 12, {30, 30, 40, 40})});
    write_mat(mat_of(folder), mat_cells("bboxes", cells));
    if (compressed) compress_mat(mat_of(folder));
    const std::vector<UwSceneFrame> frames = read_uw_scene(folder, kSize);
    ASSERT_EQ(frames.size(), 11U);
    EXPECT_TRUE(frames[0].boxes.empty());
    ASSERT_EQ(frames[1].boxes.size(), 2U);
    EXPECT_EQ(frames[1].boxes[0].name, "coffee_mug_5");
    EXPECT_EQ(frames[1].boxes[0].box_px, cv::Rect(2, 10, 5, 10));
    EXPECT_EQ(frames[1].boxes[1].name, "soda_can_1");
    EXPECT_EQ(frames[1].boxes[1].box_px, cv::Rect(0, 0, 64, 48));
    ASSERT_EQ(frames[9].boxes.size(), 1U);
    EXPECT_EQ(frames[9].boxes[0].box_px, cv::Rect(39, 29, 1, 1));
    EXPECT_EQ(frames[9].images.colour.filename(), "desk_1_10.png");
  }
  EXPECT_EQ(read_uw_scene(folder.string() + "/", kSize).size(), 11U) << "with a slash at the end";
}

TEST(UwScenes, NumbersMayBeOfAnyClassAndEdgesOnePixelOutside) {
  std::uint16_t value = 7;
  std::array<std::size_t, 2> one = {1, 1};
  matvar_t* cell = mat_boxes({uw_box("cap", 1, {0, 49, 0, 65})});
  Mat_VarFree(Mat_VarSetStructFieldByName(
      cell, "instance", 0, Mat_VarCreate("instance", MAT_C_UINT16, MAT_T_UINT16, 2, one.data(), &value, 0)));
  const std::vector<UwSceneFrame> frames = read_uw_scene(write_one(cell), kSize);
  EXPECT_EQ(frames.at(0).boxes.at(0).name, "cap_7");
  EXPECT_EQ(frames.at(0).boxes.at(0).box_px, cv::Rect(0, 0, 64, 48));
}

TEST(UwScenes, MissingFramesAreNamed) {
  const fs::path folder = write_frames(3);
  write_mat(mat_of(folder), mat_cells("bboxes", {mat_boxes({}), mat_boxes({}), mat_boxes({})}));
  EXPECT_EQ(refusal(folder), "");
  fs::remove(folder / "desk_1_2_depth.png");
  expect_refused(folder, "desk_1_2_depth.png: missing");
  fs::remove(folder / "desk_1_2.png");
  expect_refused(folder, "desk_1_2.png: missing");
  const fs::path longer = write_frames(4);
  write_mat(mat_of(longer), mat_cells("bboxes", {mat_boxes({}), mat_boxes({}), mat_boxes({})}));
  expect_refused(longer, "3 cells for 4 frames");
}

TEST(UwScenes, FilesThatAreNoAnnotationsAreRefused) {
  const fs::path folder = write_frames(1);
  expect_refused(folder, "desk_1.mat: missing");
  write_text(mat_of(folder), "");
  expect_refused(folder, "no MATLAB file");
  write_text(mat_of(folder), std::string(4000, 'x'));
  expect_refused(folder, "no MATLAB file");
  write_mat(mat_of(folder), mat_cells("boxes", {mat_boxes({})}));
  expect_refused(folder, "no variable 'bboxes'");
  write_mat(mat_of(folder), mat_double("bboxes", 3));
  expect_refused(folder, "1 numbers, expected one cell for each frame");
  write_mat(mat_of(folder), mat_cells("bboxes", {mat_double(nullptr, 3)}));
  expect_refused(folder, "numbers, expected structs");
}

TEST(UwScenes, CutOffFilesAreRefusedAtAnyLength) {
  for (const bool compressed : {false, true}) {
    const fs::path folder = write_frames(2);
    const MatBox box = uw_box("cap", 1, {1, 2, 1, 2});
    write_mat(mat_of(folder), mat_cells("bboxes", {mat_boxes({box}), mat_boxes({box})}));
    if (compressed) compress_mat(mat_of(folder));
    ASSERT_EQ(refusal(folder), "");
    for (auto size = fs::file_size(mat_of(folder)) - 1; size > 0; size -= std::min<std::uintmax_t>(size, 37)) {
      fs::resize_file(mat_of(folder), size);
      EXPECT_NE(refusal(folder), "") << size << " bytes";
    }
  }
}

TEST(UwScenes, DamagedBytesAreRefusedOrReadButNeverCrash) {
  for (const bool compressed : {false, true}) {
    const fs::path folder = write_one(mat_boxes({uw_box("cap", 1, {1, 2, 1, 2})}));
    if (compressed) compress_mat(mat_of(folder));
    const std::string good = read_text(mat_of(folder));
    int refused = 0;
    for (std::size_t at = 124; at < good.size(); ++at) {
      for (const int flipped : {0x01, 0x90}) {
        std::string bad = good;
        bad[at] = static_cast<char>(bad[at] ^ flipped);
        write_text(mat_of(folder), bad);
        if (!refusal(folder).empty()) ++refused;
      }
    }
    EXPECT_GT(refused, static_cast<int>(good.size() - 124) / 2);
  }
}

TEST(UwScenes, FilesOfTheOtherByteOrderAreRead) {
  const fs::path folder = write_frames(1);
  write_text(mat_of(folder), big_endian_mat());
  const std::vector<UwSceneFrame> frames = read_uw_scene(folder, kSize);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_TRUE(frames[0].boxes.empty());
}

TEST(UwScenes, FieldsOfTheWrongKindAreNamed) {
  const MatBox good = uw_box("cap", 1, {1, 2, 1, 2});
  const auto changed = [&good](std::size_t index, const MatField& field) {
    MatBox box = good;
    box[index] = field;
    return mat_boxes({box});
  };
  expect_refused(write_one(changed(0, {"category", "", 4.0})), "field 'category': numbers of length 1, expected text");
  expect_refused(write_one(changed(0, {"category", "caf\xe9", 0.0})), "character 233");
  expect_refused(write_one(changed(0, {"kind", "cap", 0.0})), "no field 'category'");
  expect_refused(write_one(changed(1, {"instance", "ab", 0.0})), "field 'instance': text, expected a number");
  expect_refused(write_one(changed(1, {"instance", "", 1.5})), "1.5, expected a whole number");
  expect_refused(write_one(changed(2, {"top", "", std::nan("")})), "field 'top': nan, expected a finite number");
  expect_refused(write_one(changed(5, {"rechts", "", 2.0})), "no field 'right'");
}

TEST(UwScenes, AbsurdBoxesAreNamed) {
  for (const auto& edges : std::vector<std::array<double, 4>>{
           {10, 5, 1, 2}, {1, 2, 30, 20}, {-5, 2, 1, 2}, {1, 500, 1, 2}, {1, 2, 1, 66}, {1, 2, 1, 1e300}, {0, 0, 0, 0}})
    expect_refused(write_one(mat_boxes({uw_box("cap", 1, edges)})), "'bboxes' frame 1 box 1: box ");
}

}  // namespace
}  // namespace houghstream
