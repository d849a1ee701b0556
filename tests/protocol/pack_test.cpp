// Every message survives packing bit for bit, and a payload of any other length is refused.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <type_traits>

#include "protocol/transport.hpp"
#include "tests/protocol/fields_of.hpp"
#include "tests/refusal.hpp"

namespace furrow {
namespace {

NodeCard node_card() {
  NodeCard m;
  m.protocol_version = 7;
  m.self = {Role::tire, 3};
  m.node_kind = "ancf";
  m.scenario_digest = "0123456789abcdef";
  m.step = 4e-5;
  m.steps = 1'000'000'000'000;
  m.substeps = 2;
  m.wheel_count = 4;
  m.tire_count = 5;
  m.threads = 6;
  m.pid = 4711;
  m.host = "node-17";
  m.tire_mass.mass = 4.8;
  m.tire_mass.inertia << 1, 2, 3, 4, 5, 6, 7, 8, 9;
  m.tire_radius = 0.4673;
  m.tire_width = 0.3;
  m.tire_reach = 0.47;
  m.size = 13'500;
  return m;
}
SurfaceSetup surface_setup() { return {{5, {{0, 1, 2}, {2, 3, 4}}}, {1e7, 0.45, 0.9, 0.2, 1e6, 30.0, 0.0, 4.2}}; }
TerrainSetup terrain_setup() { return {{0.1, 0.2}, {0.3, 0.4}, -0.5, 12.5, 382'500}; }
RimMotion rim_motion() {
  return {{42, 1.5}, {{1, 2, 3}, Quat(0.5, -0.5, 0.5, -0.5), {4, 5, 6}, {7, 8, 9}}, Order::stop};
}
SpindleReport spindle_report() { return testing::filled<SpindleReport>(); }
SurfaceMotion surface_motion(int vertices) {
  SurfaceMotion m;
  m.header = {44, 1.7};
  for (int i = 0; i < vertices; ++i) {
    m.surface.position.emplace_back(i, 0.1 * i, -0.0);
    m.surface.velocity.emplace_back(std::sqrt(i), 1e-310, -i);
  }
  m.order = Order::checkpoint;
  return m;
}
TerrainForces terrain_forces() {
  TerrainForces m{{45, 1.8}, {{1, 5, 9}, {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}}};
  for (const double k : {0.0, 1.0, 2.0})
    m.forces.tangent.push_back({Mat3::Constant(k), Mat3::Constant(k + 0.5), {1, 2, k}, {3, 4, k}});
  return m;
}
TerrainReport terrain_report() {
  TerrainReport m;
  m.header = {46, 1.9};
  m.state = {1, 2, 3, 4, 5, 6, 7, 8, 9};
  m.state.momenta = {{6, 7, 8}, {9, 10, 11}, {12, 13, 14}, {15, 16, 17}, {18, 19, 20}};
  m.contact.resize(2);
  m.contact[0] = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, 10, 11, 12, 13, 14};
  m.contact[1].contacts = 99;
  return m;
}
RunFolder run_folder() { return {"results/first_look-001"}; }
CheckpointPart checkpoint_part() { return {47, "tire0.h5", "0123456789abcdef", "disk full"}; }
FinalReport final_report() {
  FinalReport m;
  m.self = {Role::terrain, 0};
  m.state_hash = 0xfedcba9876543210ULL;
  m.cpu_s = 1;
  m.compute_s = 2;
  m.communicate_s = 5;
  m.wait_s = 3;
  m.threads = 4;
  m.profile = {0.5, 1.5};
  m.height_before = {0.1, 0.2, 0.3, 2, 1, {0.4, std::nan("")}};
  m.height_after = {0.5, 0.6, 0.7, 1, 1, {0.8}};
  return m;
}

/// Packing what was unpacked gives the same bytes, so nothing is lost or changed; a field missing from the list is
/// caught below.
template <class M>
void expect_round_trip(const M& message) {
  const std::vector<std::byte> bytes = pack(message);
  EXPECT_EQ(pack(unpack<M>(bytes)), bytes);
  EXPECT_NE(pack(M{}), bytes);
}

/// A message in which all numbers differ arrives with each number in its field.
template <class M>
void expect_every_field_arrives() {
  const auto message = testing::filled<M>();
  const auto arrived = unpack<M>(pack(message));
  EXPECT_EQ(testing::numbers_of(arrived).arrays(), testing::numbers_of(message).arrays());
}

/// The list of each struct names all of its members, once each.
template <class... Structs>
void expect_whole_lists() {
  const auto check = []<class T>(std::type_identity<T>) {
    const std::vector<std::string> names = testing::names_of<T>();
    EXPECT_EQ(names.size(), testing::member_count<T>()) << "the list that begins with " << names.front();
    EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
  };
  (check(std::type_identity<Structs>()), ...);
}

template <class M>
void expect_other_lengths_refused(const M& message) {
  const std::vector<std::byte> bytes = pack(message);
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    const std::vector<std::byte> cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length));
    EXPECT_THROW(unpack<M>(cut), Error) << length << " of " << bytes.size() << " bytes";
  }
  std::vector<std::byte> longer = bytes;
  longer.push_back(std::byte{0});
  expect_refused(ExitCode::rank_lost, {}, [&] { unpack<M>(longer); });
}

TEST(Pack, every_message_survives_bit_for_bit) {
  expect_round_trip(node_card());
  expect_round_trip(surface_setup());
  expect_round_trip(terrain_setup());
  expect_round_trip(rim_motion());
  expect_round_trip(spindle_report());
  expect_round_trip(surface_motion(4));
  expect_round_trip(terrain_forces());
  expect_round_trip(terrain_report());
  expect_round_trip(run_folder());
  expect_round_trip(checkpoint_part());
  expect_round_trip(final_report());
}

TEST(Pack, every_field_of_every_message_arrives) {
  expect_every_field_arrives<NodeCard>();
  expect_every_field_arrives<SurfaceSetup>();
  expect_every_field_arrives<TerrainSetup>();
  expect_every_field_arrives<RimMotion>();
  expect_every_field_arrives<SpindleReport>();
  expect_every_field_arrives<SurfaceMotion>();
  expect_every_field_arrives<TerrainForces>();
  expect_every_field_arrives<FinalReport>();
  expect_every_field_arrives<RunFolder>();
  expect_every_field_arrives<CheckpointPart>();
  expect_every_field_arrives<TerrainReport>();
}

TEST(Pack, no_list_forgets_a_member_of_its_struct) {
  expect_whole_lists<NodeCard, SurfaceSetup, TerrainSetup, RimMotion, SurfaceMotion, TerrainForces, TerrainReport,
                     FinalReport, RunFolder, CheckpointPart>();
  expect_whole_lists<Address, StepHeader, RimState, Wrench, SurfaceMesh, SurfaceState, ContactTangent, NodalForces,
                     MassProperties, ContactMaterial, ContactSums, TerrainState, HeightField, TireDiagnostics>();
}

/// The report of a tire lists the model's own values instead of the struct that contains them.
TEST(Pack, report_of_a_tire_lists_all_that_its_model_says) {
  const std::vector<std::string> names = testing::names_of<SpindleReport>();
  EXPECT_EQ(names.size(), testing::member_count<SpindleReport>() - 1 + testing::member_count<TireDiagnostics>());
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
}

TEST(Pack, truncated_and_trailing_bytes_are_refused) {
  expect_other_lengths_refused(node_card());
  expect_other_lengths_refused(surface_setup());
  expect_other_lengths_refused(terrain_setup());
  expect_other_lengths_refused(rim_motion());
  expect_other_lengths_refused(spindle_report());
  expect_other_lengths_refused(surface_motion(4));
  expect_other_lengths_refused(terrain_forces());
  expect_other_lengths_refused(terrain_report());
  expect_other_lengths_refused(run_folder());
  expect_other_lengths_refused(checkpoint_part());
  expect_other_lengths_refused(final_report());
}

// One byte flipped in a length must not allocate the machine's memory.
TEST(Pack, an_absurd_length_is_refused) {
  std::vector<std::byte> bytes = pack(terrain_setup());
  for (int i = 0; i < 8; ++i) bytes[static_cast<std::size_t>(i)] = std::byte{0xff};
  EXPECT_THROW(unpack<TerrainSetup>(bytes), Error);
}

/// The bytes of all numbers and texts in a value; texts and vectors have a length before them.
template <class T>
std::size_t bytes_of(const T& value) {
  constexpr std::size_t kLength = 8;
  if constexpr (HasFields<T>) {
    std::size_t sum = 0;
    visit_fields(value, [&](const auto& member, const Field&) { sum += bytes_of(member); });
    return sum;
  } else if constexpr (std::is_same_v<T, bool>) {
    return 1;
  } else if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
    return sizeof(T);
  } else if constexpr (std::is_same_v<T, std::string>) {
    return kLength + value.size();
  } else if constexpr (std::is_same_v<T, Quat>) {
    return 4 * sizeof(double);
  } else if constexpr (requires { T::SizeAtCompileTime; }) {
    return T::SizeAtCompileTime * sizeof(double);
  } else {
    std::size_t sum = requires { std::declval<T&>().resize(1); }
    ? kLength : 0;
    for (const auto& one : value) sum += bytes_of(one);
    return sum;
  }
}

/// Only the fields of the struct are sent.
template <class M>
void expect_fields_alone(const M& message) {
  EXPECT_EQ(pack(message).size(), bytes_of(message));
}

TEST(Pack, every_field_is_there_and_nothing_else) {
  expect_fields_alone(node_card());
  expect_fields_alone(surface_setup());
  expect_fields_alone(terrain_setup());
  expect_fields_alone(rim_motion());
  expect_fields_alone(spindle_report());
  expect_fields_alone(surface_motion(4));
  expect_fields_alone(terrain_forces());
  expect_fields_alone(terrain_report());
  expect_fields_alone(run_folder());
  expect_fields_alone(checkpoint_part());
  expect_fields_alone(final_report());
}

TEST(Pack, fields_arrive_where_they_belong) {
  const auto card = unpack<NodeCard>(pack(node_card()));
  EXPECT_EQ(card.self, (Address{Role::tire, 3}));
  EXPECT_EQ(card.host, "node-17");
  EXPECT_EQ(card.tire_mass.inertia, node_card().tire_mass.inertia);
  const auto motion = unpack<RimMotion>(pack(rim_motion()));
  EXPECT_EQ(motion.rim.orientation.coeffs(), rim_motion().rim.orientation.coeffs());
  EXPECT_EQ(motion.order, Order::stop);
  const auto report = unpack<TerrainReport>(pack(terrain_report()));
  EXPECT_EQ(report.contact[0].tangential, Vec3(7, 8, 9));
  EXPECT_EQ(report.contact[1].contacts, 99);
  EXPECT_TRUE(std::isnan(unpack<FinalReport>(pack(final_report())).height_before.height[1]));
}

}  // namespace
}  // namespace furrow
