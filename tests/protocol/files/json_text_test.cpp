// JSON that people wrote: where a mistake stands.
#include <gtest/gtest.h>

#include <fstream>

#include "protocol/core/error.hpp"
#include "protocol/files/json_text.hpp"
#include "protocol/files/text_file.hpp"
#include "tests/nodes/temporary_folder.hpp"

namespace furrow {
namespace {

std::string complaint(const std::string& text) {
  try {
    parse_json(text, "f");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::bad_input);
    return error.what();
  }
  return {};
}

std::string complaint_of_file(const std::string& bytes) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "f";
  std::ofstream(file, std::ios::binary) << bytes;
  try {
    read_text_file(file, "a text");
  } catch (const Error& error) {
    return std::string(error.what()).substr(file.string().size());
  }
  return {};
}

TEST(JsonText, values_come_out_as_written) {
  const auto json =
      parse_json(R"({"a": [1, -2, 2.5e3, {"b": null}], "c": {"d": "é", "e": [true, []]}})", "f");
  EXPECT_EQ(json.dump(), R"({"a":[1,-2,2500.0,{"b":null}],"c":{"d":"é","e":[true,[]]}})");
}

TEST(JsonText, syntax_errors_name_line_and_column) {
  EXPECT_TRUE(complaint("{\n  \"a\": 1\n  \"b\": 2\n}").starts_with("f:3:"));
  EXPECT_TRUE(complaint("{\"a\": NaN}").starts_with("f:1:"));
  EXPECT_TRUE(complaint("{\"é\": }").starts_with("f:1:7:")) << complaint("{\"é\": }");
  EXPECT_NE(complaint(""), "");
  EXPECT_NE(complaint("{} {}"), "");
}

TEST(JsonText, duplicate_keys_are_named_by_their_path) {
  EXPECT_EQ(complaint(R"({"a": {"b": 1, "c": 2, "b": 3}})"), "f: key 'a.b': is given twice, expected once");
  EXPECT_EQ(complaint(R"({"a": {"b": 1}, "b": {"b": 1}})"), "");
}

TEST(JsonText, numbers_beyond_a_double_are_refused) {
  EXPECT_NE(complaint(R"({"a": 1e400})").find("key 'a': is a number too large"), std::string::npos);
  EXPECT_NE(complaint(R"({"a": -1e400})").find("too large"), std::string::npos);
  EXPECT_EQ(complaint(R"({"a": 1e-400})"), "");  // rounds to zero
}

TEST(JsonText, deep_nesting_is_no_danger) {
  const std::string deep(200000, '[');
  EXPECT_NE(complaint(deep), "");
}

TEST(JsonText, files_must_be_utf8) {
  EXPECT_EQ(complaint_of_file("grüße €  𝄞"), "");
  EXPECT_EQ(complaint_of_file("ab\n\xff").substr(0, 5), ":2:1:");
  for (const char* bad : {"\xc0\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xe2\x82", "\x80", "\xe0\x80\x80"})
    EXPECT_NE(complaint_of_file(std::string("a") + bad).find("is not UTF-8"), std::string::npos);
  EXPECT_NE(complaint_of_file(std::string("a\0b", 3)).find("is not UTF-8"), std::string::npos);
  EXPECT_EQ(complaint_of_file(" \r\n\t"), ": is empty, expected a text");
}

TEST(JsonText, command_line_values_are_json_or_text) {
  EXPECT_EQ(parse_value("0.3", "f", "k"), 0.3);
  EXPECT_EQ(parse_value("true", "f", "k"), true);
  EXPECT_EQ(parse_value("[1]", "f", "k"), nlohmann::json::array({1}));
  EXPECT_EQ(parse_value("mindlin", "f", "k"), "mindlin");
  EXPECT_EQ(parse_value("\"7\"", "f", "k"), "7");
  EXPECT_EQ(parse_value("", "f", "k"), "");
  EXPECT_THROW(parse_value("1e999", "f", "k"), Error);
  EXPECT_THROW(parse_value(R"({"a": 1, "a": 2})", "f", "k"), Error);
}

TEST(JsonText, numbers_read_well_and_read_back) {
  EXPECT_EQ(number_text(200e3), "200e3");
  EXPECT_EQ(number_text(450), "450");
  EXPECT_EQ(number_text(-1), "-1");
  EXPECT_EQ(number_text(4e-5), "4e-5");
  EXPECT_EQ(number_text(1e9), "1e9");
  EXPECT_EQ(number_text(2.49e7), "2.49e7");
  EXPECT_EQ(number_text(1e-12), "1e-12");
  for (const double x : {0.1, 1.0 / 3.0, 123456.7, 1234567.0, 6.02e23, -4.9e-7, 12345678.9})
    EXPECT_EQ(std::stod(number_text(x)), x) << number_text(x);
}

}  // namespace
}  // namespace furrow
