// JSON written by people: the positions of errors.
#include <gtest/gtest.h>

#include <fstream>
#include <vector>

#include "protocol/core/error.hpp"
#include "protocol/files/json_text.hpp"
#include "protocol/files/text_file.hpp"
#include "tests/refusal.hpp"
#include "tests/temporary_folder.hpp"

namespace furrow {
namespace {

std::string complaint(const std::string& text) {
  return refusal(ExitCode::bad_input, [&] { parse_json(text, "f"); });
}

std::string complaint_of_file(const std::string& bytes) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "f";
  std::ofstream(file, std::ios::binary) << bytes;
  const std::string text = refusal(ExitCode::bad_input, [&] { read_text_file(file, "a text"); });
  return text.substr(std::min(text.size(), file.string().size()));
}

TEST(JsonText, values_come_out_as_written) {
  const auto json = parse_json(R"({"a": [1, -2, 2.5e3, {"b": null}], "c": {"d": "é", "e": [true, []]}})", "f");
  EXPECT_EQ(json.dump(), R"({"a":[1,-2,2500.0,{"b":null}],"c":{"d":"é","e":[true,[]]}})");
}

TEST(JsonText, syntax_errors_name_line_and_column) {
  EXPECT_TRUE(complaint("{\n  \"a\": 1\n  \"b\": 2\n}").starts_with("f:3:"));
  EXPECT_TRUE(complaint("{\"a\": NaN}").starts_with("f:1:"));
  EXPECT_TRUE(complaint("{\"é\": }").starts_with("f:1:7:")) << complaint("{\"é\": }");
  EXPECT_NE(complaint(""), "");
  EXPECT_NE(complaint("{} {}"), "");
}

TEST(JsonText, slips_of_other_notations_are_named) {
  EXPECT_TRUE(complaint("{\"radius\": 0,02, \"density\": 1}").starts_with("f:1:")) << complaint("{\"radius\": 0,02}");
  for (const char* text : {"{\"radius\": 0,02, \"density\": 1}", "{\"radius\": 12,5}", "{\"radius\": -1,25e3}"})
    EXPECT_TRUE(holds(complaint(text), "a number has a decimal point, no comma"));
  EXPECT_TRUE(holds(complaint("{\"a\": 1,}"), "a comma stands between entries, none after the last"));
  EXPECT_TRUE(holds(complaint("[1, 2,\n]"), "a comma stands between entries, none after the last"));
  EXPECT_TRUE(holds(complaint("{\n 'a': 1}"), "f:2:2: is not valid JSON: a text is in double quotes"));
  EXPECT_FALSE(holds(complaint("{\"a\": }"), "comma"));
}

TEST(JsonText, meshes_are_named_whatever_is_in_them) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "wheel.OBJ";
  std::ofstream(file, std::ios::binary) << "# Blender\nv 0 0 \xff\n";
  EXPECT_TRUE(holds(refusal(ExitCode::bad_input, [&] { load_json(file, "a tire file in JSON"); }),
                    "wheel.OBJ: is a mesh, expected a tire file in JSON: meshes are not read"));
}

TEST(JsonText, duplicate_keys_are_named_by_their_path) {
  EXPECT_EQ(complaint(R"({"a": {"b": 1, "c": 2, "b": 3}})"), "f: key 'a.b': is given twice, expected once");
  EXPECT_EQ(complaint(R"({"a": {"b": 1}, "b": {"b": 1}})"), "");
}

TEST(JsonText, numbers_beyond_a_double_are_refused) {
  EXPECT_TRUE(holds(complaint(R"({"a": 1e400})"), "key 'a': is a number too large"));
  EXPECT_TRUE(holds(complaint(R"({"a": -1e400})"), "too large"));
  EXPECT_EQ(complaint(R"({"a": 1e-400})"), "");  // rounds to zero
}

TEST(JsonText, nesting_beyond_64_levels_is_refused_where_it_begins) {
  const auto nested = [](std::size_t levels) { return std::string(levels, '[') + std::string(levels, ']'); };
  EXPECT_EQ(complaint(nested(64)), "");
  EXPECT_EQ(complaint(nested(65)), "f:1:65: lists and objects are nested deeper than 64 levels, expected fewer");
  EXPECT_EQ(complaint(nested(1000000)).substr(0, 7), "f:1:65:");
  EXPECT_EQ(complaint(std::string(200000, '[')).substr(0, 7), "f:1:65:");
  std::string objects = "{\n\"a\": ";
  for (int k = 0; k < 100000; ++k) objects += "{\"a\": ";
  EXPECT_TRUE(holds(complaint(objects), "nested deeper"));
  EXPECT_EQ(complaint("[\"" + std::string(100, '[') + "\\\"" + std::string(100, '{') + "\"]"), "") << "in a text";
}

TEST(JsonText, comments_are_skipped_and_those_of_other_languages_refused) {
  for (const char* text :
       {"// note\n{}", "{\n/* [[ \" */\n}", "{\"a\": 1 // note\n}", "{\"a\": 1 } // [ \"", "{\"a//\": \"/* no */\"}"})
    EXPECT_EQ(complaint(text), "") << text;
  EXPECT_EQ(parse_json("{\"a\": /* 1 */ 2}", "f")["a"], 2);
  EXPECT_EQ(parse_json("{\"a\": \"// b\"}", "f")["a"], "// b");
  EXPECT_EQ(complaint("{\n# note\n}"), "f:2:1: is a comment of another language, expected // or /* */");
  EXPECT_TRUE(holds(complaint("{ /* no end }"), "is not valid JSON"));
  EXPECT_TRUE(holds(complaint("{\"a\": 1/2}"), "is not valid JSON"));
  const std::string deep(200, '[');
  EXPECT_EQ(complaint("// \"\n" + deep).substr(0, 7), "f:2:65:") << "a quote in a comment hides no brackets";
  EXPECT_EQ(complaint("{} // " + deep), "");
}

TEST(JsonText, keys_that_nobody_could_type_are_refused) {
  EXPECT_EQ(complaint("{\"a\": {\"b\\u001b[31m\\n\": 1}}"),
            "f: key 'a.b\\x1b[31m\\n': has a control character or is longer than 256 bytes, expected the "
            "name of a key");
  EXPECT_EQ(complaint("{\"" + std::string(256, 'k') + "\": 1}"), "");
  EXPECT_TRUE(holds(complaint("{\"" + std::string(257, 'k') + "\": 1}"), "longer than 256 bytes"));
}

/// Finding a key in an ordered object takes a time proportional to its number of keys: a million keys would take an
/// hour.
TEST(JsonText, objects_of_more_keys_than_anybody_writes_are_refused) {
  const auto object = [](int keys) {
    std::string text;
    for (int k = 0; k < keys; ++k) text += (k == 0 ? "{\"k" : ", \"k") + std::to_string(k) + "\": 1";
    return text + "}";
  };
  EXPECT_EQ(complaint(object(10000)), "");
  EXPECT_EQ(complaint(object(1000000)), "f: key 'k10000': is one too many, expected at most 10000 keys in an object");
  const testing::TemporaryFolder folder;
  std::ofstream(folder.path() / "f") << object(1000000);
  EXPECT_TRUE(read_json_if_whole(folder.path() / "f").is_null());
}

TEST(JsonText, values_in_messages_are_short_and_of_one_line) {
  EXPECT_EQ(value_text(nlohmann::json("a\nb\x1b")), "'a\\nb\\x1b'");
  EXPECT_LE(value_text(nlohmann::json(std::string(100000, 'x'))).size(), 60U);
  EXPECT_LE(value_text(nlohmann::json(std::vector<int>(100000))).size(), 60U);
}

TEST(JsonText, files_of_our_own_that_are_too_deep_or_too_large_count_as_damaged) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "f";
  std::ofstream(file) << "{\"a\": " << std::string(100000, '[') << std::string(100000, ']') << "}";
  EXPECT_TRUE(read_json_if_whole(file).is_null());
  std::ofstream(file) << "{\"a\": 1}";
  EXPECT_TRUE(read_json_if_whole(file).is_object());
  std::filesystem::resize_file(file, 17 << 20);
  EXPECT_TRUE(read_json_if_whole(file).is_null());
}

TEST(JsonText, files_must_be_utf8) {
  EXPECT_EQ(complaint_of_file("grüße €  𝄞"), "");
  EXPECT_EQ(complaint_of_file("ab\n\xff").substr(0, 5), ":2:1:");
  for (const char* bad : {"\xc0\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xe2\x82", "\x80", "\xe0\x80\x80"})
    EXPECT_TRUE(holds(complaint_of_file(std::string("a") + bad), "is not UTF-8"));
  EXPECT_TRUE(holds(complaint_of_file(std::string("a\0b", 3)), "is not UTF-8"));
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
  EXPECT_THROW(parse_value(std::string(100000, '[') + std::string(100000, ']'), "f", "k"), Error);
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
