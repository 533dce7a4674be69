#include "tools/teach/mesh/store_report.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "drivers/files/image_file.hpp"
#include "tests/drivers/store/small_store.hpp"
#include "tests/expect_says.hpp"
#include "tests/test_files.hpp"

namespace houghstream::teach {
namespace {

namespace fs = std::filesystem;

int count_of(const std::string& part, const std::string& text) {
  int count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

/// A mug that was practised, and a second object of which nothing is known.
fs::path practised_store(const std::string& name, const std::string& second) {
  const fs::path folder = fresh_folder(name) / "store";
  fs::create_directories(folder);
  store::fill_store(folder, second);
  store::ObjectStore store = store::read_store(folder);
  store::PracticeRecord& record = store.objects[0].practice.emplace();
  record.shown = 200;
  record.right = 150;
  record.wrong = 1;
  record.scores = {{0.71, 160, 0}, {0.4, 170, 30}};
  record.taken_for = {{second, 31}};
  record.by_distance = {{1.0, 120, 96}, {10.0, 80, 4}};
  record.by_visible = {{0.5, 50, 5}, {1.0, 150, 145}};
  store::write_store_json(store);
  fs::create_directories(folder / "views");
  write_png(cv::Mat(30, 1400, CV_8UC3, cv::Scalar(9, 90, 200)), store.view_image(2));
  return folder;
}

TEST(StoreReport, ShowsWhatPracticeHasCounted) {
  const fs::path folder = practised_store("store_report", "brick");
  const fs::path out = folder.parent_path() / "page.html";
  write_store_report(folder, out);
  const std::string page = read_text(out);
  for (const char* part :
       {"<td>200</td><td>75 %</td><td>99.0 %</td><td class=\"words\">brick (15.5 %)</td>",
        "<td>0 to 1 m</td><td>120</td><td>80 %</td>", "<td>from 1 m on</td><td>80</td><td>5 %</td>",
        "<td>0 to 50 %</td><td>50</td><td>10 %</td>", "<td>50 to 100 %</td><td>150</td><td>97 %</td>",
        "<td>0.98</td><td>0.71</td><td>80 %</td><td colspan=\"2\">nothing found</td>",
        "<polyline class=\"score\" points=\"",
        "can hardly be told apart: in practice &#39;brick&#39; is detected in the place of &#39;mug&#39; in 16 % of "
        "200",
        "unknown, hs-teach practise learns it", "<section id=\"object-5\">"})
    EXPECT_EQ(count_of(part, page), 1) << part << " in\n" << page;
  EXPECT_EQ(count_of("src=\"data:image/jpeg;base64,/9j/", page), 1) << "the brick has no views";
  EXPECT_EQ(count_of("<svg ", page), 1);
  EXPECT_EQ(count_of("src=\"", page), 1) << "all is within the page";
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.parent_path()), {}), 2) << "nothing is left beside it";
}

TEST(StoreReport, NamesAreNoMarkup) {
  const fs::path folder = practised_store("store_report_names", "<script>");
  replace_in_file(folder / "store.json", "cad/mug.ply", "<img src=x onerror=alert(1)>");
  const fs::path out = folder.parent_path() / "page.html";
  write_store_report(folder, out);
  const std::string page = read_text(out);
  EXPECT_EQ(count_of("<script", page), 0);
  EXPECT_EQ(count_of("<img src=x", page), 0);
  EXPECT_GE(count_of("&lt;script&gt;", page), 4) << "in the table, as what it is taken for, and as a title";
}

TEST(StoreReport, ReplacesNoFileButItsOwn) {
  const fs::path folder = practised_store("store_report_other", "brick");
  const fs::path out = folder.parent_path() / "mine.html";
  write_text(out, "<html>my notes</html>");
  expect_says(error_of([&] { write_store_report(folder, out); }), {out.string(), "no page of hs-teach report"});
  EXPECT_EQ(read_text(out), "<html>my notes</html>");
  expect_says(error_of([&] { write_store_report(folder, folder); }), {folder.string(), "is no file"});
  expect_says(error_of([&] { write_store_report(folder / "no", folder.parent_path() / "b.html"); }),
              {"expected an object store"});
  EXPECT_FALSE(fs::exists(folder.parent_path() / "b.html"));
  fs::remove(out);
  write_store_report(folder, out);
  const std::string page = read_text(out);
  write_store_report(folder, out);
  EXPECT_EQ(read_text(out), page) << "the same store, the same page";
}

}  // namespace
}  // namespace houghstream::teach
