#include "tools/teach/show/show_jobs.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <memory>

#include "pipeline/base/checks.hpp"
#include "tests/drivers/store/small_store.hpp"
#include "tests/pose/reconstruction/shown_scene.hpp"
#include "tests/test_files.hpp"

namespace houghstream::teach {
namespace {

namespace fs = std::filesystem;

/// Frames of a camera that goes about a box by so many degrees.
ShownFrames take_of(int frames, double degrees) {
  const auto mesh = std::make_shared<Mesh>(test_scene::table_with({}));
  const auto i = std::make_shared<int>(0);
  return [=]() -> std::optional<RgbdFrame> {
    if (*i == frames) return std::nullopt;
    const double azimuth = degrees / 57.3 * *i / frames;
    ++*i;
    return test_scene::photograph(*mesh, test_scene::camera_at(azimuth, 0.55, 0.65), test_scene::ShownScene().camera,
                                  1000000 + 33000 * *i);
  };
}

ShowOptions options_for(const std::string& name) {
  ShowOptions options;
  options.source = "a take";
  options.name = name;
  options.teach = false;
  return options;
}

std::string line_of(const ShowOptions& options, const ShownFrames& frames, const ShownFrames& second = {}) {
  return error_of([&] { show_object(options, frames, second, nullptr); });
}

struct Heard : ShowObserver {
  void progress(const ShowProgress& now) override { states.push_back(now.state); }
  std::vector<TeachingState> states;
};

TEST(ShowJobs, NamesAQuarterTurnPoorAndKeepsItsReport) {
  const fs::path folder = fs::temp_directory_path() / "show_jobs_test";
  fs::remove_all(folder);
  ShowOptions options = options_for("box");
  options.keep = folder;
  Heard heard;
  EXPECT_EQ(show_object(options, take_of(40, 90.0), {}, &heard), 3);
  EXPECT_EQ(heard.states.back(), TeachingState::kFailed);
  for (const char* file : {"model.ply", "camera_poses.csv", "report.json", "report.html", "contact_sheet.jpg",
                           "chosen.png", "views/000001/scene_gt.json", "views/models/models_info.json"})
    EXPECT_TRUE(fs::exists(folder / file)) << file;
  std::ifstream in(folder / "report.json");
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  EXPECT_NE(text.find("\"poor\""), std::string::npos);
  EXPECT_NE(text.find("too short"), std::string::npos);
  options.accept_poor_model = true;
  options.keep = folder / "";  // as a shell completes it
  std::ofstream(folder / "NOTES.txt") << "of somebody";
  std::ofstream(folder / "views" / "000001" / "earlier.png") << "of the earlier showing";
  fs::create_directories(folder / "views" / "000002");
  std::ofstream(folder / "views" / "000002" / "own.png") << "of somebody";
  std::ofstream(folder / "chosen_2.png") << "of the earlier showing";
  EXPECT_EQ(show_object(options, take_of(40, 90.0), {}, nullptr), 0);
  EXPECT_TRUE(fs::exists(folder / "report.json")) << "replaced";
  for (const char* file : {"NOTES.txt", "views/000002/own.png"}) EXPECT_TRUE(fs::exists(folder / file)) << file;
  for (const char* file : {"chosen_2.png", "views/000001/earlier.png"}) EXPECT_FALSE(fs::exists(folder / file)) << file;
  fs::remove_all(folder);
}

TEST(ShowJobs, BadInputIsOneLine) {
  EXPECT_NE(line_of(options_for("two words"), take_of(40, 90.0)).find("--name: the name 'two words'"),
            std::string::npos);
  EXPECT_NE(line_of(options_for("box"), take_of(5, 10.0)).find("5 frames, expected at least 20"), std::string::npos);
  EXPECT_NE(line_of(options_for("box"), take_of(0, 0.0)).find("a take: no frame"), std::string::npos);
  ShowOptions teaching = options_for("box");
  teaching.teach = true;
  EXPECT_NE(line_of(teaching, take_of(40, 90.0)).find("--out is missing"), std::string::npos);
  const ShownFrames grey = [frames = take_of(40, 90.0)]() -> std::optional<RgbdFrame> {
    std::optional<RgbdFrame> frame = frames();
    if (frame) frame->colour.setTo(cv::Scalar::all(128));
    return frame;
  };
  EXPECT_NE(line_of(options_for("box"), grey).find("a take: frame 1033000: no colour"), std::string::npos);
  EXPECT_NE(line_of(options_for("m\xfcg"), take_of(40, 90.0)).find("--name: the name 'm\\xfcg' is not UTF-8"),
            std::string::npos);
}

/// Before the take some frames without anything, and more of a table on which nothing stands yet.
ShownFrames take_after_a_while(int blank, int empty) {
  test_scene::ShownScene table;
  table.box.setZero();
  const RgbdFrame of_table = test_scene::photograph(test_scene::table_with(table),
                                                    test_scene::camera_at(0.0, 0.55, 0.65), table.camera, 1000000);
  const auto i = std::make_shared<int>(0);
  return [=, frames = take_of(40, 90.0)]() -> std::optional<RgbdFrame> {
    if (*i == blank + empty) return frames();
    RgbdFrame frame = of_table;
    if (*i < blank) {
      frame.colour = cv::Mat::zeros(frame.colour.size(), CV_8UC3);
      frame.depth = cv::Mat(frame.depth.size(), CV_32FC1, cv::Scalar(std::numeric_limits<float>::quiet_NaN()));
    }
    frame.id.utime = 1000 * ++*i;
    return frame;
  };
}

TEST(ShowJobs, ACameraMayWakeAndBePointedAtTheObject) {
  ShowOptions options = options_for("box");
  EXPECT_NE(line_of(options, take_after_a_while(3, 0)).find("a take: frame 1000: no colour"), std::string::npos);
  EXPECT_NE(line_of(options, take_after_a_while(0, 60)).find("a take: nothing with depth stands near"),
            std::string::npos);
  options.source = "openni2";
  EXPECT_EQ(line_of(options, take_after_a_while(3, 60)), "");
  EXPECT_NE(line_of(options, take_after_a_while(100, 0)).find("openni2: frame 90000: no colour"), std::string::npos);
}

TEST(ShowJobs, ErrorsOfTheSecondTakeNameIt) {
  EXPECT_EQ(line_of(options_for("box"), take_of(40, 90.0), take_of(5, 10.0)),
            "the second take: 5 frames, expected at least 20, of a whole turn");
  ShowOptions options = options_for("box");
  options.second = "log:on_its_side.lcmlog";
  EXPECT_EQ(line_of(options, take_of(40, 90.0), take_of(0, 0.0)).find("log:on_its_side.lcmlog: no frame"), 0U);
}

TEST(ShowJobs, ACameraHasNoSecondTake) {
  ShowOptions options = options_for("box");
  options.second = "openni2:#2";
  std::string line;
  try {
    show_sources(options, nullptr);
  } catch (const InputError& error) {
    line = error.what();
  }
  EXPECT_EQ(line.find("--second openni2:#2: a camera, expected a recording"), 0U) << line;
}

TEST(ShowJobs, AFolderThatHoldsSomethingElseIsRefusedBeforeTheTake) {
  const fs::path folder = fs::temp_directory_path() / "show_jobs_keep_test";
  fs::create_directories(folder);
  std::ofstream(folder / "report.json") << "{}";
  ShowOptions options = options_for("box");
  options.keep = folder;
  int taken = 0;
  const ShownFrames frames = [&]() -> std::optional<RgbdFrame> {
    ++taken;
    return std::nullopt;
  };
  EXPECT_EQ(line_of(options, frames).find(folder.string() + ": holds something else, expected a new folder"), 0U);
  EXPECT_EQ(taken, 0);
  EXPECT_TRUE(fs::exists(folder / "report.json"));
  options.keep.clear();
  options.teach = true;
  options.out = folder;
  EXPECT_EQ(line_of(options, frames).find(folder.string() + ": holds no store.json of an object store"), 0U);
  options.out = "/dev/null/my.store";
  EXPECT_EQ(line_of(options, frames).find("/dev/null: cannot be a folder to write to"), 0U);
  Heard heard;
  EXPECT_THROW(show_object(options, frames, {}, &heard), InputError);
  EXPECT_EQ(heard.states, std::vector<TeachingState>{TeachingState::kFailed}) << "hs-view says it too";
  options.teach = false;
  options.keep = "/dev/null/kept";
  EXPECT_EQ(line_of(options, frames).find("/dev/null: cannot be a folder to write to"), 0U);
  EXPECT_EQ(taken, 0);
  fs::remove_all(folder);
}

TEST(ShowJobs, AStoreThatIsThereIsRefusedBeforeTheTake) {
  ShowOptions options = options_for("box");
  options.teach = true;
  options.out = store::whole_store("show_replaced");
  const auto before = store::files_of(options.out);
  int taken = 0;
  const ShownFrames frames = [&]() -> std::optional<RgbdFrame> {
    ++taken;
    return std::nullopt;
  };
  EXPECT_EQ(line_of(options, frames),
            options.out.string() +
                ": holds 2 objects, expected --add to add to it, or --replace to put a new one in its place");
  EXPECT_EQ(taken, 0);
  ShowOptions adding = options;
  adding.add = true;
  EXPECT_EQ(line_of(adding, frames).find("a take: no frame"), 0U);
  ShowOptions replacing = options;
  replacing.replace = true;
  EXPECT_EQ(line_of(replacing, frames).find("a take: no frame"), 0U);
  options.teach = false;
  EXPECT_EQ(line_of(options, frames).find("a take: no frame"), 0U) << "nothing goes into the store";
  EXPECT_EQ(store::files_of(options.out), before);
}

}  // namespace
}  // namespace houghstream::teach
