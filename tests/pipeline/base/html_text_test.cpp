#include "pipeline/base/html_text.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

TEST(HtmlText, MarkupBecomesText) {
  EXPECT_EQ(escape_html("<script>alert(1)</script>"), "&lt;script&gt;alert(1)&lt;/script&gt;");
  EXPECT_EQ(escape_html("\" onload='x' &amp;"), "&quot; onload=&#39;x&#39; &amp;amp;");
}

TEST(HtmlText, NamesStayLegible) {
  EXPECT_EQ(escape_html("Tasse für zwei\nLöffel"), "Tasse für zwei\nLöffel");
  EXPECT_EQ(escape_html("mug\x1b[2J"), "mug\\x1b[2J");
}

}  // namespace
}  // namespace houghstream
