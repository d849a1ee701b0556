// Roads: heights of ISO 8608 against the density of their class, and measured roads read from CSV and OpenCRG.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <vector>

#include "protocol/core/error.hpp"
#include "terrain/rigid/ground_map.hpp"
#include "terrain/rigid/ground_shape.hpp"
#include "terrain/rigid/roads/iso_8608.hpp"
#include "terrain/rigid/roads/open_crg.hpp"
#include "terrain/rigid/roads/read_road.hpp"
#include "tests/refusal.hpp"
#include "tests/temporary_folder.hpp"

namespace furrow::terrain {
namespace {

TEST(IsoRoad, class_densities_are_those_of_the_standards_table) {
  // ISO 8608:2016, table C.1, geometric means at 0.1 cycles/m in 1e-6 m³.
  const std::pair<char, double> table[] = {{'A', 16},   {'B', 64},    {'C', 256},   {'D', 1024},
                                           {'E', 4096}, {'F', 16384}, {'G', 65536}, {'H', 262144}};
  for (const auto& [name, density] : table) EXPECT_NEAR(road_density(name, 0.1), 1e-6 * density, 1e-12);
  EXPECT_NEAR(road_density('C', 1.0), 2.56e-6, 1e-15);  // falls with n⁻²
}

TEST(IsoRoad, heights_have_the_density_of_their_class_in_every_octave) {
  constexpr double kLength = 409.6;
  constexpr int kSeeds = 8;
  std::vector<double> density;  // of line m, frequency m/kLength
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const ProfilePoints road = iso_8608_road('C', 0.0, kLength, seed);
    const std::size_t n = road.size() - 1;
    const auto lines = static_cast<std::size_t>(kMostRoadFrequency * kLength);
    density.resize(lines + 1);
    for (std::size_t m = 1; m <= lines; ++m) {
      std::complex<double> sum = 0.0;
      const std::complex<double> turn =
          std::polar(1.0, -2.0 * std::numbers::pi * static_cast<double>(m) / static_cast<double>(n));
      std::complex<double> phase = 1.0;
      for (std::size_t k = 0; k < n; ++k, phase *= turn) {
        const double hann = 1.0 - std::cos(2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(n));
        sum += hann * road[k][1] * phase;
      }
      // One-sided; the window's mean square is 1.5.
      density[m] += 2.0 * std::norm(sum) * kLength / (1.5 * static_cast<double>(n) * static_cast<double>(n)) / kSeeds;
    }
  }
  for (double from = 0.04; from < 2.0; from *= 2.0) {
    double measured = 0.0, wanted = 0.0;
    for (std::size_t m = 1; m < density.size(); ++m) {
      const double f = static_cast<double>(m) / kLength;
      if (f >= from && f < std::min(2.0 * from, kMostRoadFrequency))
        measured += density[m], wanted += road_density('C', f);
    }
    EXPECT_NEAR(measured / wanted, 1.0, 0.15) << "from " << from << " 1/m";
  }
}

TEST(IsoRoad, begins_and_ends_level_and_is_drawn_by_its_seed) {
  const ProfilePoints road = iso_8608_road('E', 3.0, 50.0, 7);
  EXPECT_EQ(road.front(), (std::array<double, 2>{3.0, 0.0}));
  EXPECT_EQ(road.back()[1], 0.0);
  EXPECT_DOUBLE_EQ(road.back()[0], 53.0);
  EXPECT_LT(std::abs(road[1][1]), 1e-4 * std::abs(road[road.size() / 2][1]));
  EXPECT_EQ(road, iso_8608_road('E', 3.0, 50.0, 7));
  EXPECT_NE(road, iso_8608_road('E', 3.0, 50.0, 8));
  const ProfilePoints rougher = iso_8608_road('F', 3.0, 50.0, 7);
  for (std::size_t k = 0; k < road.size(); ++k) EXPECT_NEAR(rougher[k][1], 2.0 * road[k][1], 1e-12);
}

class RoadFile : public ::testing::Test {
 protected:
  std::filesystem::path put(const std::string& name, const std::string& bytes) {
    std::ofstream(folder_.path() / name, std::ios::binary) << bytes;
    return folder_.path() / name;
  }
  /// Reading is refused with these words.
  template <class Read>
  static void expect_told(const std::string& words, Read read) {
    expect_refused(ExitCode::bad_input, {words}, read);
  }

  testing::TemporaryFolder folder_;
};

const std::string kRoad =
    "$CT ! text\na road\n$\n$ROAD_CRG\nREFERENCE_LINE_START_U = 2.0\nREFERENCE_LINE_END_U = 4.0 ! m\n"
    "REFERENCE_LINE_INCREMENT = 1\nLONG_SECTION_V_RIGHT = -0.5\nLONG_SECTION_V_INCREMENT = 0.5\n$!***\n";
const std::string kCuts = "D:long section 1,m\nD:long section 2,m\nD:long section 3,m\n$\n";

template <class Number>
std::string big_endian(const std::vector<Number>& values) {
  std::string bytes;
  for (const Number value : values) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    if constexpr (std::endian::native == std::endian::little) std::reverse(raw, raw + sizeof value);
    bytes.append(raw, sizeof value);
  }
  return bytes;
}

/// ASAM's handmade_straight_minimalist.crg is "completely equivalent" to handmade_straight.crg, with v from -1.5 m on.
TEST_F(RoadFile, cuts_without_a_first_v_lie_evenly_about_the_reference_line) {
  const std::string rows = "#:LRFI\n" + kCuts + "$$\n 0.0000000 0.0100000 0.0200000\n 0.0000000 0.0100000 0.0200000\n";
  const auto cuts = [&](const std::string& v) {
    return read_open_crg(put("road.crg", "$ROAD_CRG\nREFERENCE_LINE_INCREMENT = 1\n" + v +
                                             "LONG_SECTION_V_INCREMENT = 0.5\n$\n$KD_DEFINITION\n" + rows))
        .v;
  };
  EXPECT_EQ(cuts(""), (std::vector<double>{-0.5, 0.0, 0.5}));
  EXPECT_EQ(cuts("LONG_SECTION_V_LEFT = 2\n"), (std::vector<double>{1.0, 1.5, 2.0}));
}

TEST_F(RoadFile, the_four_formats_hold_the_same_road) {
  const std::string text = kRoad + "$KD_Definition\n#:LRFI\n" + kCuts +
                           "$$$$ data\n 0.0000000 0.0100000 *missing*\n 0.0200000-0.0300000 0.0400000\r\n "
                           "5.00e-02 0.0600000 0.0700000\n";
  const std::string wide = kRoad + "$KD_Definition\n#:LDFI\n" + kCuts + "$$$$\n" +
                           "                 0.0                0.01           *missing*\n" +
                           "                0.02               -0.03                0.04\n" +
                           "                0.05                0.06                0.07\n";
  const float nan = std::nanf("");
  std::vector<float> singles{0.0f, 0.01f, nan, 0.02f, -0.03f, 0.04f, 0.05f, 0.06f, 0.07f};
  singles.resize(20, nan);  // a record of 80 bytes
  std::vector<double> doubles{0.0, 0.01, nan, 0.02, -0.03, 0.04, 0.05, 0.06, 0.07, nan};
  const std::string binary = kRoad + "$KD_Definition\n" + kCuts + "$$$$\n" + big_endian(singles);
  const std::string fine = kRoad + "$KD_Definition\n#:KDBI\n" + kCuts + "$$$$\n" + big_endian(doubles);
  for (const std::string& bytes : {text, wide, binary, fine}) {
    const OpenCrg road = read_open_crg(put("road.crg", bytes));
    EXPECT_EQ(road.v, (std::vector<double>{-0.5, 0.0, 0.5}));
    ASSERT_EQ(road.count(), 3U);
    EXPECT_TRUE(std::isnan(road.heights[2]));
    const ProfilePoints middle = read_road(folder_.path() / "road.crg", {0.0});
    ASSERT_EQ(middle.size(), 3U);
    EXPECT_EQ(middle[0][0], 2.0);
    EXPECT_EQ(middle[2][0], 4.0);
    EXPECT_NEAR(middle[1][1], -0.03, 1e-8);
    EXPECT_NEAR(read_road(folder_.path() / "road.crg", {-0.25})[2][1], 0.055, 1e-8);
  }
}

TEST_F(RoadFile, slope_and_banking_of_the_reference_line_are_added) {
  const std::string head =
      "$ROAD_CRG\nREFERENCE_LINE_INCREMENT = 2.0\nREFERENCE_LINE_START_Z = 1.0\n$\n$KD_DEFINITION\n#:LRFI\n";
  const std::string bytes =
      head +
      "D:reference line phi,rad\nD:reference line slope,m/m\nD:reference line banking,m/m\n"
      "U:reference line u,m,0,2.0\nD:long section at v = 1.0,m\nD:long section at v = -1.0,m\n$\n$$\n"
      " *missing* *missing* 0.0000000 0.0100000 0.0200000\n"
      " 0.0000000 0.0500000 0.0300000 0.0100000 0.0200000\n"
      " 0.0000000-0.0100000 0.0000000 0.0100000 0.0200000\n";
  const std::filesystem::path file = put("sloped.crg", bytes);
  const ProfilePoints left = read_road(file, {1.0}), right = read_road(file, {-1.0});
  const double z_left[] = {1.01, 1.1 + 0.01 + 0.03, 1.08 + 0.01}, z_right[] = {1.02, 1.1 + 0.02 - 0.03, 1.08 + 0.02};
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(left[k][1], z_left[k], 1e-12);
    EXPECT_NEAR(right[k][1], z_right[k], 1e-12);
  }
}

/// Headings −0.1, 0.3 and, once round, 0.2 rad from where the first row ends; a scale of 0 makes the line straight.
TEST_F(RoadFile, a_reference_line_that_turns_is_laid_straight_and_said_to_turn) {
  const auto road = [&](const std::string& mods) {
    return put("turning.crg", "$ROAD_CRG\nREFERENCE_LINE_INCREMENT = 2.0\n$\n" + mods +
                                  "$KD_DEFINITION\n#:LRFI\nD:reference line phi,rad\n"
                                  "D:long section at v = 1.0,m\nD:long section at v = -1.0,m\n$\n$$\n"
                                  " *missing* 0.0100000 0.0200000\n-0.1000000 0.0100000 0.0200000\n"
                                  " 0.3000000 0.0100000 0.0200000\n 6.4831853 0.0100000 0.0200000\n");
  };
  const GroundShape shape = read_shape(road(""), {}, true);
  ASSERT_TRUE(shape.map);
  EXPECT_NEAR(shape.map->turn, 0.4, 1e-6);
  EXPECT_EQ(shape.map->x.back(), 6.0);
  ASSERT_EQ(shape.remarks().size(), 1U);
  EXPECT_TRUE(holds(shape.remarks()[0].second, "turns by 0.4 rad: it is laid straight")) << shape.remarks()[0].second;
  EXPECT_TRUE(read_shape(road("$ROAD_CRG_MODS\nSCALE_CURVATURE = 0\n$\n"), {}, true).remarks().empty());
}

TEST_F(RoadFile, heights_and_lengths_are_printed) {
  EXPECT_EQ(GroundShape().range(), "");
  EXPECT_EQ(read_shape(put("road.csv", "x_m,z_m\n1,0\n2,0.25\n21,-0.5\n"), {}, true).range(),
            ", heights from -0.5 to 0.25 m over 20 m");
  const GroundShape map = read_shape(put("road.csv", "x_m,y_m,z_m\n0,0,0\n0,1,0\n3,0,0\n3,1,0.5\n"), {}, true);
  EXPECT_EQ(map.range(), ", heights from 0 to 0.5 m over 3 m by 1 m");
}

TEST_F(RoadFile, heights_in_millimetres_are_said_to_step) {
  const auto told = [&](const std::string& rows) {
    const auto remarks = read_shape(put("road.csv", rows), {}, true).remarks();
    return remarks.empty() ? std::string() : remarks[0].second;
  };
  EXPECT_EQ(told("x_m,z_m\n0,0\n1,0\n2,120\n"),
            "steps by 120 m at x = 2 m, expected lengths and heights in m: another unit, or degrees?");
  EXPECT_EQ(told("x_m,y_m,z_m\n0,0,0\n0,1,0\n1,0,0\n1,1,50\n"),
            "steps by 50 m at x = 1 m, expected lengths and heights in m: another unit, or degrees?");
  EXPECT_EQ(told("x_m,z_m\n0,0\n1,0\n1,2.5\n500,300\n"), "");  // a wall, and a mountain
}

TEST_F(RoadFile, a_row_of_more_than_eight_channels_goes_on_in_the_next_record) {
  std::string bytes =
      "$ROAD_CRG\nREFERENCE_LINE_INCREMENT = 1\nLONG_SECTION_V_RIGHT = 0\nLONG_SECTION_V_INCREMENT = "
      "1\n$\n$KD_DEFINITION\n#:LRFI\n";
  for (int k = 1; k <= 10; ++k) bytes += "D:long section " + std::to_string(k) + ",m\n";
  bytes += "$\n$$\n";
  for (int row = 0; row < 2; ++row)
    for (int k = 0; k < 10; ++k)
      bytes += std::string(" 0.") + std::to_string(1000000 + 10 * row + k) + (k == 7 || k == 9 ? "\n" : "");
  const OpenCrg road = read_open_crg(put("wide.crg", bytes));
  ASSERT_EQ(road.heights.size(), 20U);
  EXPECT_EQ(road.heights[9], 0.1000009);
  EXPECT_EQ(road.heights[18], 0.1000018);
}

TEST_F(RoadFile, options_and_modifiers_that_are_defaults_or_scale_heights_are_honoured) {
  const std::string rows =
      "$$\n *missing* 0.0100000 0.0000000\n 0.0000000 0.0200000 0.0000000\n"
      " 0.0000000 0.0300000 *missing*\n";
  const std::string opts =
      "$ROAD_CRG_OPTS\n* keep last\nBORDER_MODE_U = 2 ! default\nBORDER_OFFSET_V = 0.0\n"
      "WARN_MSGS = -1\nWARN_MSGS = -1\n$\n";
  const std::string mods =
      "$ROAD_CRG_MODS\nSCALE_Z_GRID = 2\nREFLINE_OFFSET_Z = 1.0\nREFLINE_OFFSET_X = 7\n"
      "grid_nan_mode = 2.000000000+e00\nGRID_NAN_OFFSET = 0.25\n$\n";
  const std::filesystem::path file = put("ROAD.CRG", kRoad + opts + mods + "$KD_DEFINITION\n#:LRFI\n" + kCuts + rows);
  const ProfilePoints middle = read_road(file, {0.0}), right = read_road(file, {-0.5}), left = read_road(file, {0.5});
  EXPECT_NEAR(middle[0][1], 1.02, 1e-12);
  EXPECT_NEAR(middle[2][1], 1.06, 1e-12);
  EXPECT_NEAR(right[0][1], 1.02 + 0.25, 1e-12);  // the height beside it, and the offset
  EXPECT_NEAR(left[2][1], 1.06 + 0.25, 1e-12);
  EXPECT_NEAR(left[1][1], 1.0, 1e-12);
}

/// As crg_write of ASAM's MATLAB package leaves it; where the point lies in the plane changes no height.
TEST_F(RoadFile, the_height_of_the_point_of_reference_is_that_of_its_modifier) {
  const std::string rows =
      "$KD_DEFINITION\n#:LRFI\n" + kCuts +
      "$$\n 0.1000000 0.2000000 0.4000000\n 0.3000000 0.5000000 0.7000000\n 0.0000000 0.0000000 *missing*\n";
  const auto middle = [&](const std::string& mods) {
    return read_road(put("moved.crg", kRoad + "$ROAD_CRG_MODS\n" + mods +
                                          "$\n$ROAD_CRG_OPTS\nrefline_continuation = 1.0\n$\n" + rows),
                     {0.0})[0][1];
  };
  EXPECT_NEAR(middle("refpoint_u_fraction = 0\nrefpoint_u_offset = 0\nrefpoint_v = 0\nrefpoint_v_offset = 0\n"
                     "refpoint_x = 10\nrefpoint_y = 0\nrefpoint_z = 0\nrefpoint_phi = 3.14\n"),
              0.0, 1e-12);
  EXPECT_NEAR(middle("refpoint_z = 7\n"), 7.0, 1e-12);
  EXPECT_NEAR(middle("refpoint_u = 2.5\nrefpoint_v = 0.25\nrefpoint_z = 1\n"), 0.2 + 1.0 - 0.45, 1e-12);
  EXPECT_NEAR(middle("refpoint_u_fraction = 0.5\nrefpoint_u_offset = -0.5\nrefpoint_v_fraction = 0.75\n"), 0.2 - 0.45,
              1e-12);
  expect_told("REFPOINT_Z': is the height at u = 4 m, v = 0.5 m, where the road has none",
              [&] { middle("refpoint_u_fraction = 1\nrefpoint_v_fraction = 1\n"); });
}

TEST_F(RoadFile, a_binary_road_that_states_no_end_ends_before_the_padding_of_its_last_record) {
  const std::string open =
      "$ROAD_CRG\nREFERENCE_LINE_INCREMENT = 1\n$\n$KD_DEFINITION\n#:KRBI\nD:long section at v = "
      "-1,m\nD:long section at v = 1,m\n$\n$$\n";
  std::vector<float> singles(40, std::nanf(""));
  for (std::size_t k = 0; k < 24; ++k) singles[k] = 0.25f * static_cast<float>(k);
  EXPECT_EQ(read_open_crg(put("open.crg", open + big_endian(singles))).count(), 12U);
  EXPECT_EQ(read_open_crg(put("open.crg", open + big_endian(singles).substr(0, 96))).count(), 12U);  // not filled up
  const std::filesystem::path cut = put("cut.crg", open + big_endian(singles).substr(1));
  expect_told("has 159 bytes of road data, expected whole records of 80 bytes: it was damaged in transfer",
              [&] { read_open_crg(cut); });
}

TEST_F(RoadFile, mistakes_of_an_open_crg_file_are_told_by_line_and_parameter) {
  const std::string rows =
      "$$\n 0.0000000 0.0000000 0.0000000\n 0.0000000 0.0000000 0.0000000\n 0.0000000 0.0000000 0.0000000\n";
  const std::string text = "$KD_DEFINITION\n#:LRFI\n" + kCuts;
  const auto with = [](const std::string& from, const std::string& to) {
    std::string road = kRoad;
    return road.replace(road.find(from), from.size(), to);
  };
  const std::pair<std::string, std::string> wrong[] = {
      {"", "has no road data"},
      {"{}\n", "has no road data"},
      {kRoad + text, "has no road data"},
      {kRoad + rows, "defines no channel"},
      {kRoad + "$KD_DEFINITION\n#:LRFI\nD:reference line phi,rad\n$\n" + rows, "has no cut along the road"},
      {kRoad + "$KD_DEFINITION\n#:XXXX\n" + kCuts + rows, "line 12': is the data format 'XXXX'"},
      {kRoad + "$KD_DEFINITION\nD\n$\n" + rows, "defines no channel"},
      {kRoad + "$KD_DEFINITION\n#:LRFI\nD:long section one,m\n$\n" + rows, "line 13': is not a cut"},
      {kRoad + "$KD_DEFINITION\n#:LRFI\nD:long section 1,mm\n$\n" + rows, "line 13': is not a cut"},
      {kRoad + "$KD_DEFINITION\n#:LRFI\nD:long section 1,m\nD:long section at v = 0,m\n$\n" + rows,
       "line 14': mixes cuts"},
      {kRoad + "$KD_DEFINITION\n#:LRFI\nD:long section 1,m\nD:long section 1,m\n$\n$$\n 0.0000000 0.0000000\n",
       "has two cuts at v = -0.5 m"},
      {"$ROAD_CRG\nLONG_SECTION_V_RIGHT = 0\n$\n$KD_DEFINITION\n#:LRFI\nD:long section 1,m\n$\n$$\n "
       "0.0000000\n 0.0000000\n",
       "REFERENCE_LINE_INCREMENT': is missing"},
      {"$ROAD_CRG\nREFERENCE_LINE_INCREMENT = -1\n$\n$KD_DEFINITION\n#:LRFI\nD:long section at v = "
       "0,m\n$\n$$\n 0.0000000\n 0.0000000\n",
       "is -1, expected 1e-06 to 1e+06 m"},
      {with("INCREMENT = 1", "INCREMENT = 1e-300") + text + rows, "is 1e-300, expected 1e-06 to 1e+06 m"},
      {with("INCREMENT = 1", "INCREMENT = 1e300") + text + rows, "is 1e+300, expected 1e-06 to 1e+06 m"},
      {with("START_U = 2.0", "START_U = 1e300") + text + rows, "leads the road from u = 1e+300 to 1e+300 m"},
      {"$ROAD_CRG\nREFERENCE_LINE_INCREMENT = wide\n$\n", "line 2': is 'REFERENCE_LINE_INCREMENT = wide'"},
      {"$ROAD_CRG\nREFERENCE_LINE_INCREMENT = 1\nREFERENCE_LINE_INCREMENT = 1\n$\n",
       "line 3': gives a parameter twice"},
      {kRoad + "$ROAD_CRG_MODS\nSCALE_Z_GIRD = 2\n$\n" + text + rows,
       "line 12': SCALE_Z_GIRD is unknown, expected 'SCALE_Z_GRID'?"},
      {with("START_U = 2.0", "STRAT_U = 2.0") + text + rows,
       "line 5': REFERENCE_LINE_STRAT_U is unknown, expected 'REFERENCE_LINE_START_U'?"},
      {with("START_U = 2.0", "START_U = 2.0\nSCALE_Z_GRID = 2") + text + rows,
       "line 6': SCALE_Z_GRID is given in $ROAD_CRG, expected it in $ROAD_CRG_MODS"},
      {kRoad + "$ROAD_CRG_OPTS\nBORDER_MODE_U = 3\n$\n" + text + rows,
       "line 12': BORDER_MODE_U is 3, expected 2: the road goes on with its last height"},
      {kRoad + "$ROAD_CRG_MODS\nREFPOINT_U = 0\nREFPOINT_U_FRACTION = 0\n$\n" + text + rows,
       "REFPOINT_U': is given beside REFPOINT_U_FRACTION, expected one of them"},
      {kRoad + "$ROAD_CRG_MODS\nGRID_NAN_MODE = 5\n$\n" + text + rows,
       "line 12': GRID_NAN_MODE is 5, expected 0, 1 or 2"},
      {kRoad + "$KD_DEFINITION\n#:LRFI\n$ROAD_CRG_MODS\nSCALE_Z_GRID = 2\n$\n" + rows,
       "line 13': begins $ROAD_CRG_MODS within $KD_DEFINITION"},
      {kRoad + "$KD_DEFINITION\n#:LRFI\nU:reference line u,mm\n" + kCuts + rows,
       "line 13': has the unit 'MM', expected M"},
      {kRoad + "$KD_DEFINITION\n#:LRFI\nD:reference line slope,%\n" + kCuts + rows,
       "line 13': has the unit '%', expected M/M"},
      {with("RIGHT = -0.5", "RIGHT = -0.5\nLONG_SECTION_V_LEFT = 1") + text + rows,
       "LONG_SECTION_V_LEFT': is 1 m, but the last cut on that side is at v = 0.5 m"},
      {with("END_U = 4.0", "END_U = 6.0") + text + rows,
       "REFERENCE_LINE_END_U': is 6 m, where the road has 5 cross-sections, but the file holds 3"},
      {kRoad + "$ROAD_CRG_FILE\nother.crg\n$\n" + text + rows, "line 11': refers to another file"},
      {kRoad + text + "$$\n 0.0000000 0.0000000\n", "line 18': is '' for channel 3"},
      {kRoad + text + "$$\n 0.0000000 0.00x0000 0.0000000\n", "line 18': is '0.00x0000' for channel 2"},
      {with("REFERENCE_LINE_END_U = 4.0 ! m\n", "") + text + "$$\n 0.0000000 0.0000000 0.0000000\n",
       "has 1 cross-sections"},
      {kRoad + "$KD_DEFINITION\n#:KRBI\n" + kCuts + "$$\n" + std::string(32, '\0'),
       "holds 8 numbers, expected 9: the file is cut short"},
      {kRoad + "$KD_DEFINITION\n#:KRBI\n" + kCuts + "$$\n" + std::string(79, '\0'),
       "has 79 bytes of road data, expected 1 records of 80 bytes: it was damaged in transfer"},
      {kRoad + "$KD_DEFINITION\n#:KRBI\n" + kCuts + "$$\n" + std::string(160, '\0'),
       "is 4 m, which needs 1 records of road data, but the file holds 2"}};
  for (const auto& [bytes, words] : wrong) {
    const std::filesystem::path file = put("wrong.crg", bytes);
    SCOPED_TRACE(bytes);
    expect_told(words, [&] { read_open_crg(file); });
  }
  const std::string short_road = with("END_U = 4.0", "END_U = 3.0");
  const std::filesystem::path file =
      put("road.crg", short_road + text + "$$\n *missing* 0.0000000 0.0000000\n 0.0000000 0.0000000 0.0000000\n");
  expect_told("expected terrain.profile_v from -0.5 to 0.5 m", [&] { read_road(file, {0.75}); });
  expect_told("has no height at u = 2 m, v = -0.2 m", [&] { read_road(file, {-0.2}); });
  const std::filesystem::path high =
      put("high.crg", short_road + text + "$$\n 0.0000000 0.0000000 0.0000000\n 0.0000000  9.00e+08 0.0000000\n");
  expect_told("has the height 9e+08 m at u = 3 m, v = 0 m", [&] { read_road(high, {0.0}); });
}

TEST_F(RoadFile, a_profile_in_csv_is_read_and_its_mistakes_are_told_by_line) {
  const ProfilePoints curb = read_road(put("curb.csv", "# a curb\nx_m,z_m\n-1,0\r\n6,0\n6,0.2\n"), {0.0});
  EXPECT_EQ(curb, (ProfilePoints{{-1.0, 0.0}, {6.0, 0.0}, {6.0, 0.2}}));
  const std::pair<const char*, const char*> wrong[] = {
      {"x_m,z_m\n1,0\n0,0\n", "line 3': x_m is 0, expected 1"},
      {"x_m,z_m\n1,0\n1,0\n", "line 3': is the row before once more"},
      {"x_m,z_m\n1,0\n1,1\n1,2\n", "line 4': x_m is 1 a third time"},
      {"x_m,z_m\n1,nan\n", "line 2': z_m is 'nan', expected a number"},
      {"x_m,z_m\n1,2e6\n", "line 2': z_m is 2e+06, expected -1e+06 to 1e+06"},
      {"x,z\n0,0\n", "line 1': column 'x' is unknown"},
      {"x_m,z_m\n", "has no rows of values"},
      {"x_m,z_m\n1\n", "line 2': has 1 values, expected 2"}};
  for (const auto& [text, words] : wrong) {
    const std::filesystem::path file = put("wrong.csv", text);
    expect_told(words, [&] { read_road(file, {0.0}); });
  }
}

}  // namespace
}  // namespace furrow::terrain
