// Text of foreign files in messages: control sequences are shown and not executed.
#include "protocol/files/printable.hpp"

#include <gtest/gtest.h>

namespace furrow {
namespace {

TEST(Printable, what_a_terminal_would_obey_is_written_out) {
  EXPECT_EQ(printable("grüße €  𝄞 'x' \\n"), "grüße €  𝄞 'x' \\n");
  EXPECT_EQ(printable("a\nb\tc\rd"), "a\\nb\\tc\\rd");
  EXPECT_EQ(printable("\x1b[31mred\x7f\a"), "\\x1b[31mred\\x7f\\x07");
  EXPECT_EQ(printable(std::string("zero\0end", 8)), "zero\\x00end");
  EXPECT_EQ(printable("\xc2\x9b"
                      "31m"),
            "\\u009b31m");  // a control sequence in one character
  EXPECT_EQ(printable("a\xe2\x80\xae"
                      "b\xe2\x81\xa6"),
            "a\\u202eb\\u2066");  // right to left from here on
}

TEST(Printable, bytes_that_are_no_utf8_are_written_out) {
  EXPECT_EQ(printable("caf\xe9"), "caf\\xe9");
  EXPECT_EQ(printable("\xe2\x82"), "\\xe2\\x82");
  EXPECT_EQ(printable("\xff\xfe"), "\\xff\\xfe");
}

TEST(Printable, excerpts_are_short_whole_characters) {
  EXPECT_EQ(excerpt("short"), "short");
  EXPECT_EQ(excerpt(std::string(60, 'x')), std::string(60, 'x'));
  EXPECT_EQ(excerpt(std::string(61, 'x')), std::string(57, 'x') + "…");
  EXPECT_LE(excerpt(std::string(1 << 20, '\x1b')).size(), 60U);
  std::string umlauts;
  for (int k = 0; k < 40; ++k) umlauts += "ü";
  EXPECT_EQ(excerpt(umlauts, 12), "üüüü…");
}

}  // namespace
}  // namespace furrow
