#include "pipeline/base/printable.hpp"

#include <gtest/gtest.h>

namespace houghstream {
namespace {

TEST(Printable, LeavesWhatMayBeShown) {
  EXPECT_EQ(printable("cup_1, 30.5 Hz"), "cup_1, 30.5 Hz");
  EXPECT_EQ(printable("Becher größer 杯 🙂"), "Becher größer 杯 🙂");
  EXPECT_EQ(printable(""), "");
}

TEST(Printable, ShowsWhatWouldSteerATerminal) {
  EXPECT_EQ(printable("\x1b]0;title\x07"), "\\x1b]0;title\\x07");
  EXPECT_EQ(printable("a\nb\r\t"), "a\\x0ab\\x0d\\x09");
  EXPECT_EQ(printable("\x7f"), "\\x7f");
  EXPECT_EQ(printable("\xc2\x9b"
                      "2J"),
            "\\xc2\\x9b2J");                                            // CSI in eight bits
  EXPECT_EQ(printable("mug\xe2\x80\xaegum"), "mug\\xe2\\x80\\xaegum");  // from right to left
  EXPECT_EQ(printable("\xe2\x81\xa6"), "\\xe2\\x81\\xa6");
  EXPECT_EQ(printable("\xe2\x80\xa6"), "\xe2\x80\xa6") << "an ellipsis";
}

TEST(Printable, ShowsWhatIsNotUtf8) {
  EXPECT_EQ(printable("a\xff"
                      "b"),
            "a\\xffb");
  EXPECT_EQ(printable("\xe2\x82"), "\\xe2\\x82");           // cut
  EXPECT_EQ(printable("\xc0\xaf"), "\\xc0\\xaf");           // overlong
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");  // a surrogate
}

TEST(Printable, TellsWhetherAllIsUtf8) {
  EXPECT_TRUE(is_utf8(""));
  EXPECT_TRUE(is_utf8("Becher größer 杯 🙂\n"));
  EXPECT_FALSE(is_utf8("m\xfcg"));
  EXPECT_FALSE(is_utf8("cut \xe2\x82"));
}

TEST(Printable, KeepsLinesWhereTheyAreMeant) {
  EXPECT_EQ(printable_lines("a\nb\x1b"), "a\nb\\x1b");
}

}  // namespace
}  // namespace houghstream
