// Structs in a saved state are restored by the names of their fields, not by position.
#include <gtest/gtest.h>

#include <limits>

#include "protocol/messages.hpp"
#include "tests/protocol/fields_of.hpp"
#include "tests/refusal.hpp"

namespace furrow {
namespace {

using testing::filled;
using testing::numbers_of;

enum class Mood : std::int32_t { calm = 0, wild = 7 };

struct Point {
  double x = 0.0, y = 0.0;
};
void visit_fields(FieldsOf<Point> auto& s, auto&& visit) {
  visit(s.x, Field{"x", "m"});
  visit(s.y, Field{"y", "m"});
}

struct Sample {
  std::int64_t count = 0;
  std::uint64_t hash = 0;
  bool on = false;
  Mood mood = Mood::calm;
  Vec3 force = Vec3::Zero();
  Mat3 inertia = Mat3::Zero();
  Quat turn = Quat::Identity();
  Point at;
  std::string text;
  std::vector<double> heights;
  std::vector<Vec3> points;
  std::vector<std::array<int, 3>> triangles;
  std::vector<Point> path;
};
void visit_fields(FieldsOf<Sample> auto& s, auto&& visit) {
  visit(s.count, Field{"count"});
  visit(s.hash, Field{"hash"});
  visit(s.on, Field{"on"});
  visit(s.mood, Field{"mood"});
  visit(s.force, Field{"force"});
  visit(s.inertia, Field{"inertia"});
  visit(s.turn, Field{"turn"});
  visit(s.at, Field{"at"});
  visit(s.text, Field{"text"});
  visit(s.heights, Field{"heights"});
  visit(s.points, Field{"points"});
  visit(s.triangles, Field{"triangles"});
  visit(s.path, Field{"path"});
}

/// Point with its fields in reverse order.
struct LaterPoint {
  double y = 0.0, x = 0.0;
};
void visit_fields(FieldsOf<LaterPoint> auto& s, auto&& visit) {
  visit(s.y, Field{"y", "m"});
  visit(s.x, Field{"x", "m"});
}

template <class F>
std::string refusal(F&& f) {
  return furrow::refusal(ExitCode::io, [&] { f(); });
}

TEST(ArchiveFields, every_kind_of_field_comes_back_under_its_own_name) {
  const Sample sample = filled<Sample>();
  Archive archive;
  save_fields(archive, "a/sample", sample);
  Sample other;
  restore_fields(archive, "a/sample", other);
  EXPECT_EQ(numbers_of(other).arrays(), numbers_of(sample).arrays());
  EXPECT_EQ(archive.get_int("a/sample/count"), sample.count);
  EXPECT_EQ(archive.get<std::uint64_t>("a/sample/hash", 1).front(), sample.hash);
  EXPECT_EQ(archive.get<std::int32_t>("a/sample/on", 1).front(), 1);
  EXPECT_EQ(archive.get<double>("a/sample/force"), (std::vector<double>{4, 5, 6}));
  EXPECT_EQ(archive.get_double("a/sample/at/y"), sample.at.y);
  EXPECT_EQ(archive.get<double>("a/sample/path/y"), (std::vector<double>{sample.path[0].y, sample.path[1].y}));
  EXPECT_EQ(other.text, sample.text);
  EXPECT_EQ(other.triangles, sample.triangles);
}

TEST(ArchiveFields, whole_numbers_do_not_pass_through_doubles) {
  Sample sample;
  sample.count = std::numeric_limits<std::int64_t>::max();
  sample.hash = std::numeric_limits<std::uint64_t>::max() - 1;
  Archive archive;
  save_fields(archive, "s", sample);
  Sample other;
  restore_fields(archive, "s", other);
  EXPECT_EQ(other.count, sample.count);
  EXPECT_EQ(other.hash, sample.hash);
}

TEST(ArchiveFields, matrices_lie_column_by_column_and_orientations_as_x_y_z_w) {
  Sample sample;
  sample.inertia << 1, 2, 3, 4, 5, 6, 7, 8, 9;
  sample.turn = Quat(4.0, 1.0, 2.0, 3.0);
  const Archive archive = numbers_of(sample);
  EXPECT_EQ(archive.get<double>("inertia"), (std::vector<double>{1, 4, 7, 2, 5, 8, 3, 6, 9}));
  EXPECT_EQ(archive.get<double>("turn"), (std::vector<double>{1, 2, 3, 4}));
}

TEST(ArchiveFields, fields_are_found_by_name_in_any_order) {
  Archive archive;
  save_fields(archive, "p", Point{1.0, 2.0});
  LaterPoint later;
  restore_fields(archive, "p", later);
  EXPECT_EQ(later.x, 1.0);
  EXPECT_EQ(later.y, 2.0);
  save_value(archive, "all", std::vector<Point>{{1.0, 2.0}, {3.0, 4.0}});
  std::vector<LaterPoint> all;
  restore_value(archive, "all", all);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[1].x, 3.0);
  EXPECT_EQ(all[1].y, 4.0);
}

TEST(ArchiveFields, what_is_missing_or_of_another_type_or_size_is_refused_by_name) {
  Archive archive;
  archive.put("p/x", 1.0);
  Point point;
  EXPECT_EQ(refusal([&] { restore_fields(archive, "p", point); }), "saved state lacks 'p/y'");
  archive.put("p/y", std::int64_t{2});
  EXPECT_EQ(refusal([&] { restore_fields(archive, "p", point); }), "saved state holds 'p/y' as another type");
  archive.put("p/y", std::vector<double>{1.0, 2.0});
  EXPECT_EQ(refusal([&] { restore_fields(archive, "p", point); }), "saved state 'p/y' has 2 values, expected 1");
  std::vector<Point> points;
  EXPECT_EQ(refusal([&] { restore_value(archive, "p", points); }), "saved state 'p/y' has 2 values, expected 1");
  EXPECT_EQ(refusal([&] { ColumnReader<Point>(archive, "p", 3); }), "saved state 'p/x' has 1 values, expected 3");
  std::vector<Vec3> vectors;
  archive.put("v", std::vector<double>(7, 0.0));
  EXPECT_EQ(refusal([&] { restore_value(archive, "v", vectors); }), "saved state 'v' has 7 values, expected 6");
  EXPECT_EQ(refusal([&] { restore_value(archive, "v", vectors, 3); }), "saved state 'v' has 7 values, expected 9");
}

TEST(ArchiveFields, no_structs_leave_empty_columns) {
  Archive archive;
  save_value(archive, "none", std::vector<ContactTangent>());
  EXPECT_TRUE(archive.get<double>("none/stiffness").empty());
  std::vector<ContactTangent> tangents(3);
  restore_value(archive, "none", tangents);
  EXPECT_TRUE(tangents.empty());
}

TEST(ArchiveFields, a_surface_with_its_forces_comes_back) {
  const auto forces = filled<NodalForces>();
  Archive archive;
  save_fields(archive, "node/forces0", forces);
  EXPECT_EQ(archive.get<double>("node/forces0/tangent/stiffness").size(), 18U);
  NodalForces other;
  restore_fields(archive, "node/forces0", other);
  EXPECT_EQ(numbers_of(other).arrays(), numbers_of(forces).arrays());
}

}  // namespace
}  // namespace furrow
