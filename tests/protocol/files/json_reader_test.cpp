// Objects of JSON files, key by key: every error names file, key, value and expected values.
#include "protocol/files/json_reader.hpp"
#include "tests/refusal.hpp"

#include <gtest/gtest.h>

namespace furrow {
namespace {

using nlohmann::json;

/// The error on reading the object, without the file's name; empty if there is none.
template <class Read>
std::string complaint(const json& object, const Read& read) {
  return without_file(refusal(ExitCode::bad_input,
                              [&] {
                                JsonReader reader(object, "f.json");
                                read(reader);
                                reader.finish();
                              }),
                      "f.json");
}

TEST(JsonReader, values_are_read_by_type_and_optional_ones_have_a_default) {
  const json object = {{"text", "a"},    {"flag", true},        {"count", 3},     {"number", -2.5},
                       {"list", {1, 2}}, {"inner", {{"x", 1}}}, {"none", nullptr}};
  EXPECT_EQ(complaint(object,
                      [](JsonReader& r) {
                        EXPECT_EQ(r.text("text"), "a");
                        EXPECT_EQ(r.text_or("no_text", "b"), "b");
                        EXPECT_TRUE(r.flag_or("flag", false));
                        EXPECT_TRUE(r.flag_or("no_flag", true));
                        EXPECT_EQ(r.count("count", 1), 3);
                        EXPECT_EQ(r.number("number"), -2.5);
                        EXPECT_EQ(r.not_negative_or("no_number", 7.0), 7.0);
                        EXPECT_EQ(r.numbers("list", 2), (std::vector<double>{1.0, 2.0}));
                        EXPECT_TRUE(r.has("none") && !r.given("none") && !r.given("nothing"));
                        EXPECT_TRUE(r.object_or_empty("none").empty());
                        JsonReader inner = r.child("inner");
                        EXPECT_EQ(inner.positive("x"), 1.0);
                        inner.finish();
                      }),
            "");
}

TEST(JsonReader, wrong_values_are_told_with_their_path_and_what_is_expected) {
  const json object = {{"a", {{"b", "big"}, {"n", -1}, {"c", 1.5}, {"l", {1, "x"}}, {"o", 3}}}};
  const auto inside = [&](auto&& read) {
    return complaint(object, [&](JsonReader& r) {
      JsonReader inner = r.child("a");
      read(inner);
    });
  };
  EXPECT_EQ(inside([](JsonReader& r) { r.number("b"); }), "key 'a.b': is 'big', expected a number");
  EXPECT_EQ(inside([](JsonReader& r) { r.number("m"); }), "key 'a.m': is missing, expected a number");
  EXPECT_EQ(inside([](JsonReader& r) { r.positive("n"); }), "key 'a.n': is -1, expected a number above zero");
  EXPECT_EQ(inside([](JsonReader& r) { r.not_negative("n"); }), "key 'a.n': is -1, expected a number of zero or above");
  EXPECT_EQ(inside([](JsonReader& r) { r.count("c", 1, 9); }),
            "key 'a.c': is 1.5, expected a whole number from 1 to 9");
  EXPECT_EQ(inside([](JsonReader& r) { r.count("n", 0); }),
            "key 'a.n': is -1, expected a whole number from 0 to 100000");
  EXPECT_EQ(inside([](JsonReader& r) { r.text("n"); }), "key 'a.n': is -1, expected a text");
  EXPECT_EQ(inside([](JsonReader& r) { r.flag_or("n", true); }), "key 'a.n': is -1, expected true or false");
  EXPECT_EQ(inside([](JsonReader& r) { r.array("n"); }), "key 'a.n': is -1, expected a list");
  EXPECT_EQ(inside([](JsonReader& r) { r.numbers("l"); }), "key 'a.l': holds 'x', expected numbers");
  EXPECT_EQ(inside([](JsonReader& r) { r.numbers("l", 3); }), "key 'a.l': has 2 values, expected 3");
  EXPECT_EQ(inside([](JsonReader& r) { r.child("o"); }), "key 'a.o': is 3, expected an object { }");
}

TEST(JsonReader, keys_that_nothing_asks_for_are_errors_with_the_nearest_name) {
  const json object = {{"radius", 1.0}, {"presure", 2.0}};
  EXPECT_EQ(complaint(object,
                      [](JsonReader& r) {
                        r.number("radius");
                        r.not_negative_or("pressure", 0.0);
                      }),
            "key 'presure': is unknown, expected 'pressure'?");
  EXPECT_EQ(complaint(object, [](JsonReader& r) { r.skip("radius"); }),
            "key 'presure': is unknown, expected one of: radius");
  EXPECT_EQ(complaint(object,
                      [](JsonReader& r) {
                        r.allow_only({"presure", "radios"});
                      }),
            "key 'radius': is unknown, expected 'radios'?");
}

TEST(JsonReader, files_of_a_newer_program_are_refused) {
  const auto version = [](const json& object, int newest, bool required) {
    return complaint(object, [&](JsonReader& r) { r.check_version(newest, required); });
  };
  EXPECT_EQ(version({{"format_version", 2}}, 2, true), "");
  EXPECT_EQ(version(json::object(), 1, false), "");
  EXPECT_EQ(version(json::object(), 1, true), "key 'format_version': is missing, expected 1");
  EXPECT_EQ(version({{"format_version", 3}}, 2, false),
            "key 'format_version': is 3: the file is newer than this program, expected at most 2");
  EXPECT_EQ(version({{"format_version", 0}}, 2, false), "key 'format_version': is 0, expected 1 to 2");
  EXPECT_EQ(version({{"format_version", "1"}}, 1, false), "key 'format_version': is '1', expected 1");
}

TEST(JsonReader, the_order_of_keys_is_kept_where_it_matters) {
  const auto object = nlohmann::ordered_json::parse(R"({"grid": {"z": 1, "a": 2}})");
  OrderedJsonReader reader(object, "f.json");
  EXPECT_EQ(reader.object_or_empty("grid").begin().key(), "z");
}

}  // namespace
}  // namespace furrow
