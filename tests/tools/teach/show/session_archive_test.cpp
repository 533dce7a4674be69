#include "tools/teach/show/session_archive.hpp"

#include <gtest/gtest.h>

#include "tests/pipeline/geometry/tetrahedron.hpp"

namespace houghstream::teach {
namespace {

TEST(ReportPage, NamesAndReasonsAreText) {
  ShowResult shown;
  shown.name = "<script>alert(1)</script>";
  shown.takes.emplace_back();
  shown.takes.front().frames.resize(2);
  shown.takes.front().keyframes.resize(20);
  shown.takes.front().lost.push_back({0, 1, "<b>dark</b>"});
  shown.takes.front().selected.T_camera_stand.translation() = Eigen::Vector3d(0.0, 0.0, 0.8);
  shown.views.emplace_back(20);
  shown.mesh = tetrahedron(0.1F);
  const ModelAssessment assessment{false, {"<i>too short</i>"}};
  const std::string page = report_page(shown, assessment, {{"chosen.png"}, {"outlines/\"000001.png"}});
  for (const char* markup : {"<script", "<b>", "<i>", "\"000001"})
    EXPECT_EQ(page.find(markup), std::string::npos) << page;
  EXPECT_NE(page.find("<h1>&lt;script&gt;alert(1)&lt;/script&gt;: poor</h1>"), std::string::npos) << page;
  EXPECT_NE(page.find("&lt;i&gt;too short&lt;/i&gt;"), std::string::npos) << page;
  EXPECT_NE(page.find("src=\"chosen.png\""), std::string::npos) << page;
}

}  // namespace
}  // namespace houghstream::teach
