// Beds from the generator, from a user's positions, and compacted, with their messages.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "protocol/files/archive_file.hpp"
#include "protocol/files/hdf5_handle.hpp"
#include "terrain/dem/beds/bed_cache.hpp"
#include "terrain/dem/beds/bed_compaction.hpp"
#include "terrain/dem/beds/bed_csv.hpp"
#include "terrain/dem/beds/bed_generators.hpp"
#include "terrain/dem/beds/bed_packing.hpp"
#include "terrain/dem/beds/bed_preparation.hpp"
#include "terrain/dem/beds/bed_statistics.hpp"
#include "terrain/dem/close_pairs.hpp"
#include "terrain/dem/dem_terrain.hpp"
#include "terrain/dem/solver_setup.hpp"
#include "tests/refusal.hpp"
#include "tests/terrain/bed_fixture.hpp"

namespace furrow::terrain::dem {
namespace {

class Beds : public SmallBeds {
 protected:
  Beds() {
    options_.layers = 5;
    options_.cohesion = 40e3;
  }
  BedStatistics statistics_of(const PreparedBed& bed) const {
    GrainSolver solver(solver_params(options_));
    solver.restore(bed.bed);
    return bed_statistics(positions_by_id(solver), solver.params().bin, options_.radius);
  }
  std::string refusal() const {
    return furrow::refusal(ExitCode::bad_input, [&] { prepare_bed(options_, {}); });
  }
};

TEST(BedStatistics, two_touching_spheres_by_hand) {
  const double r = 0.01, d = 0.018;
  const Bin bin{0.2, 0.1, false, false};
  const std::vector<Quad> two{{0.05, 0.0, 0.0098, r}, {0.05 + d, 0.0, 0.05, r}, {0.05, 0.0, 0.0098 + d, r}};
  const BedStatistics s = bed_statistics(two, bin, r);
  EXPECT_EQ(s.pairs, 1);
  EXPECT_EQ(s.wall_contacts, 1);
  EXPECT_NEAR(s.coordination, 2.0 / 3.0, 1e-15);
  EXPECT_NEAR(s.max_overlap, 0.002, 1e-15);
  EXPECT_NEAR(s.top, 0.06, 1e-15);
  const double sphere = 4.0 / 3.0 * std::numbers::pi * r * r * r;
  EXPECT_NEAR(s.solid_fraction * 0.2 * 0.1 * s.depth, 3.0 * sphere - lens_volume(r, r, d), 1e-12);
}

/// The middle of this bed (1 m deep) is 0.5 × 0.5 × 0.5 m, at x = 0.25 to 0.75: a grain in it counts fully, a grain on
/// its boundary by half, and the overlap of two grains once.
TEST(BedStatistics, the_middle_counts_what_of_a_grain_is_in_it) {
  const double r = 0.04, sphere = 4.0 / 3.0 * std::numbers::pi * r * r * r;
  const Bin bin{1.0, 1.0, false, false};
  std::vector<Quad> grains;
  for (double x = r; x < 1.0; x += 2.0 * r)
    for (double y = r - 0.5; y < 0.5; y += 2.0 * r) grains.push_back({x, y, 1.0 - r, r});  // the surface
  const auto solid = [&](std::vector<Quad> inside) {
    inside.insert(inside.end(), grains.begin(), grains.end());
    const BedStatistics s = bed_statistics(inside, bin, r);
    EXPECT_NEAR(s.depth, 1.0, 1e-12);
    EXPECT_NEAR(s.solid_fraction_bulk, (s.profile[0] + s.profile[1] + s.profile[2] + s.profile[3]) / 4.0, 1e-15);
    return s.solid_fraction_bulk * 0.125;
  };
  EXPECT_NEAR(solid({{0.5, 0.0, 0.5, r}}), sphere, 1e-12);
  EXPECT_NEAR(solid({{0.25, 0.0, 0.45, r}}), 0.5 * sphere, 1e-12);
  EXPECT_NEAR(solid({{0.5, 0.25, 0.75, r}}), 0.25 * sphere, 1e-12);
  EXPECT_NEAR(solid({{0.1, 0.0, 0.5, r}}), 0.0, 1e-15);
  EXPECT_NEAR(solid({{0.5, 0.0, 0.45, r}, {0.51, 0.0, 0.45, r}}), 2.0 * sphere - lens_volume(r, r, 0.01), 1e-12);
}

/// Radii 3 and 4 at distance 5 meet in a circle of radius 12/5, at 9/5 and 16/5 from the centres: two caps by hand.
TEST(BedStatistics, lens_of_unequal_spheres_is_two_caps) {
  const auto cap = [](double r, double h) { return std::numbers::pi * h * h * (3.0 * r - h) / 3.0; };
  EXPECT_NEAR(lens_volume(3.0, 4.0, 5.0), cap(3.0, 3.0 - 1.8) + cap(4.0, 4.0 - 3.2), 1e-13);
  EXPECT_EQ(lens_volume(3.0, 4.0, 5.0), lens_volume(4.0, 3.0, 5.0));
}

TEST(BedStatistics, lens_and_cap_tend_to_the_sphere) {
  const double r = 0.5, sphere = std::numbers::pi / 6.0;
  EXPECT_NEAR(lens_volume(r, r, 0.0), sphere, 1e-15);
  EXPECT_EQ(lens_volume(r, r, 1.0), 0.0);
  EXPECT_NEAR(volume_below(r, 0.0, 0.5), sphere, 1e-15);
  EXPECT_NEAR(volume_below(r, 0.0, 0.0), 0.5 * sphere, 1e-15);
  EXPECT_EQ(volume_below(r, 2.0, 1.0), 0.0);
}

TEST(ClosePairs, agree_with_all_pairs_also_across_periodic_sides) {
  for (const bool periodic : {false, true}) {
    const Bin bin{0.21, 0.13, periodic, periodic};
    std::vector<Quad> points;
    for (int k = 0; k < 300; ++k)
      points.push_back({0.21 * std::fmod(0.618034 * k, 1.0), 0.13 * (std::fmod(0.754878 * k, 1.0) - 0.5),
                        0.1 * std::fmod(0.569840 * k, 1.0)});
    std::vector<std::pair<std::size_t, std::size_t>> found, all;
    for_close_pairs(points, bin, 0.02, [&](std::size_t a, std::size_t b, double) { found.emplace_back(a, b); });
    for (std::size_t a = 0; a < points.size(); ++a)
      for (std::size_t b = a + 1; b < points.size(); ++b) {
        const Quad d = shortest(bin, points[a], points[b]);
        if (d.x * d.x + d.y * d.y + d.z * d.z < 0.02 * 0.02) all.emplace_back(a, b);
      }
    EXPECT_GT(all.size(), 100u);
    EXPECT_EQ(found, all);
  }
}

TEST_F(Beds, lattice_fills_the_bin_without_touching_and_counts_as_expected) {
  options_.bed_generator = "lattice";
  const std::vector<Quad> grains = starting_positions(options_, {});
  EXPECT_EQ(static_cast<double>(grains.size()), expected_grains(options_));
  const Bin bin{options_.length, options_.width};
  for (const Quad& p : grains)
    for (int wall = 0; wall < kWalls; ++wall) EXPECT_GE(bin.distance(wall, p), options_.radius * (1.0 - 1e-12));
  int touching = 0;
  for_close_pairs(grains, bin, 2.0 * options_.radius, [&](std::size_t, std::size_t, double) { ++touching; });
  EXPECT_EQ(touching, 0);
  options_.seed = 2;
  EXPECT_NE(starting_positions(options_, {})[3].x, grains[3].x);
  EXPECT_TRUE(prepare_bed(options_, {}).settled.settled);
}

/// Random close packing of smooth spheres is 0.64 [Scott & Kilgour 1969, J. Phys. D 2, 863]; walls and depth take some.
TEST_F(Beds, smooth_grains_pack_denser_and_are_rough_afterwards) {
  options_.cache = false;
  const BedStatistics rough = statistics_of(prepare_bed(options_, {}));
  options_.settling_friction = 0.0;
  const PreparedBed prepared = prepare_bed(options_, {});
  const BedStatistics smooth = statistics_of(prepared);
  EXPECT_TRUE(prepared.settled.settled);
  EXPECT_GT(smooth.solid_fraction_bulk, rough.solid_fraction_bulk + 0.03);
  EXPECT_LT(smooth.solid_fraction_bulk, 0.66);
}

TEST_F(Beds, grains_that_fall_rougher_than_they_are_lie_looser) {
  options_.cache = false;
  options_.cohesion = 0.0;
  options_.friction = 0.5;
  options_.rolling_friction = 0.1;
  const PreparedBed plain = prepare_bed(options_, {});
  options_.settling_friction = 2.0;
  const PreparedBed loose = prepare_bed(options_, {});
  EXPECT_TRUE(plain.settled.settled && loose.settled.settled);
  const double before = statistics_of(plain).solid_fraction_bulk, after = statistics_of(loose).solid_fraction_bulk;
  std::printf("solid fraction %.4f, rougher while falling %.4f\n", before, after);
  EXPECT_LT(after, before - 0.01);
  options_.settling_friction = options_.friction;
  EXPECT_EQ(statistics_of(prepare_bed(options_, {})).depth, statistics_of(plain).depth);
}

TEST(PackingSearch, finds_the_looseness_of_a_solid_fraction_and_the_ends) {
  int beds = 0;
  PackingSearch search([&](double u) {
    ++beds;
    return 0.55 - (u > 0.0 ? 0.03 * u : 0.06 * u - 0.04 * u * u) + 1e-3 * std::sin(100.0 * u);  // with some chance
  });
  for (const double wanted : {0.53, 0.55, 0.60}) {
    beds = 0;
    EXPECT_NEAR(search.at(search.looseness_for(wanted)), wanted, 2e-3);
    EXPECT_LE(beds, 7);
  }
  EXPECT_EQ(search.looseness_for(0.4), 1.0);
  EXPECT_EQ(search.looseness_for(0.7), -1.0);
  EXPECT_LT(search.loosest(), 0.522);
  EXPECT_GT(search.densest(), 0.648);
}

TEST_F(Beds, have_the_solid_fraction_that_is_asked_for_with_the_friction_of_the_run) {
  options_.cohesion = 0.0;
  options_.friction = 0.5;
  options_.rolling_friction = 0.1;
  options_.layers = 10;
  options_.sides = "periodic";
  options_.periodic_x = true;
  for (const double wanted : {0.55, 0.60}) {
    options_.solid_fraction = wanted;
    options_.cohesion = wanted == 0.60 ? 20e3 : 0.0;
    PreparedBed bed = prepare_bed(options_, {});
    const BedStatistics found = statistics_of(bed);
    std::printf("solid fraction asked %.3f, found %.4f\n", wanted, found.solid_fraction_bulk);
    EXPECT_NEAR(found.solid_fraction_bulk, wanted, packing_tolerance(wanted));
    EXPECT_TRUE(bed.settled.settled);
    GrainSolver solver(settling_params(options_));
    solver.restore(bed.bed);
    const DemOptions same = level(options_);
    EXPECT_LT(std::abs(solid_fraction_under_weight(solver, same, {}) - found.solid_fraction_bulk), 0.005);
    // With the settings found before, the same bed results at once.
    const auto& laid = bed.bed.get<double>("bed/packing", 3);
    DemOptions as = options_;
    as.settling_friction = laid[0], as.settling_cohesion = laid[1], as.settling_drag = laid[2];
    EXPECT_EQ(statistics_of(prepare_bed(as, {})).depth, found.depth);
  }
  options_.cohesion = 0.0;
  options_.solid_fraction = 0.42;
  const std::string text = refusal();
  EXPECT_TRUE(holds(text, "terrain.solid_fraction': is 0.42") && holds(text, "lie between 0.5")) << text;
  options_.solid_fraction = 0.55;
  options_.compaction_pressure = 1e4;
  EXPECT_TRUE(holds(refusal(), "terrain.compaction_pressure"));
}

/// At rest by forces and energy, for any number of contacts.
TEST_F(Beds, one_grain_a_row_and_columns_come_to_rest) {
  options_.cache = false;
  options_.cohesion = 0.0;
  const auto settled = [&](const std::string& rows) {
    options_.bed = write("few.csv", "x_m,y_m,z_m\n" + rows);
    return prepare_bed(options_, {}).settled;
  };
  const SettleResult one = settled("0.15,0,0.02\n");
  EXPECT_TRUE(one.settled) << one.force_ratio << ' ' << one.floor_error;
  EXPECT_LT(one.time, 2.0);
  std::string row, columns;
  for (int k = 0; k < 10; ++k) row += std::to_string(0.02 + 0.025 * k) + ",0,0.011\n";
  EXPECT_TRUE(settled(row).settled);
  for (int k = 0; k < 12; ++k)
    columns += std::to_string(0.05 + 0.04 * (k / 3)) + ",0," + std::to_string(0.011 + 0.021 * (k % 3)) + "\n";
  EXPECT_TRUE(settled(columns).settled);
}

/// A motionless grain in the air is not at rest: nothing holds it.
TEST_F(Beds, falling_grains_are_not_at_rest) {
  options_.cache = false;
  options_.bed = write("high.csv", "x_m,y_m,z_m\n0.15,0,0.3\n");
  GrainSolver solver(settling_params(options_));
  solver.place(starting_positions(options_, {}));
  EXPECT_FALSE(settle(solver, options_, {}, 0.1).settled);
}

/// There are no sides: grains lean on grains at the other side, as if the bed continued.
TEST_F(Beds, periodic_sides_hold_each_other) {
  const PreparedBed walled = prepare_bed(options_, {});
  const BedStatistics between_walls = statistics_of(walled);
  options_.sides = "periodic";
  const PreparedBed prepared = prepare_bed(options_, {});
  EXPECT_TRUE(prepared.settled.settled);
  EXPECT_NEAR(statistics_of(prepared).solid_fraction_bulk, between_walls.solid_fraction_bulk, 0.03);
  GrainSolver solver(solver_params(options_));
  solver.restore(prepared.bed);
  const std::vector<Quad> grains = positions_by_id(solver);
  int across = 0;
  for_close_pairs(grains, solver.params().bin, 2.0 * options_.radius, [&](std::size_t a, std::size_t b, double) {
    across += std::abs(grains[a].y - grains[b].y) > 0.5 * options_.width;
  });
  EXPECT_GT(across, 10);
  int beyond = 0;
  for (const Quad& p : grains) {
    EXPECT_LE(std::abs(p.y), 0.5 * options_.width);
    beyond += std::abs(p.y) > 0.5 * options_.width - 0.5 * options_.radius;
  }
  EXPECT_GT(beyond, 3);  // where no centre fits between walls
  options_.bed = walled.file.string();
  EXPECT_TRUE(holds(refusal(), "key 'terrain.sides': is 'periodic' but the bed"));
}

TEST_F(Beds, radii_of_a_file_are_kept_and_checked) {
  options_.size_spread = 0.3;
  options_.bed = write("sizes.csv", "x_m,y_m,z_m,radius_m\n0.05,0,0.02,0.012\n0.1,0,0.02,0.008\n");
  EXPECT_NEAR(statistics_of(prepare_bed(options_, {})).grain_volume,
              4.0 / 3.0 * std::numbers::pi * (std::pow(0.012, 3) + std::pow(0.008, 3)), 1e-15);
  options_.bed = write("without.csv", "x_m,y_m,z_m\n0.05,0,0.02\n");
  EXPECT_TRUE(holds(refusal(), "line 2': the grain has no radius, expected one (radius_m"));
  options_.bed = write("large.csv", "x_m,y_m,z_m,radius_m\n0.05,0,0.02,0.014\n");
  EXPECT_TRUE(holds(refusal(), "line 2': the grain's radius is 0.014 m, expected 0.007 to 0.013 m"));
}

/// A frame of grains: positions and radii in single precision.
TEST_F(Beds, hdf5_of_positions_is_settled_like_csv) {
  const std::string file = (folder() / "frame.h5").string();
  const std::vector<float> x{0.05F, 0.0F, 0.02F, 0.1F, 0.0F, 0.02F}, r{0.01F, 0.01F};
  const auto put = [](hid_t out, const char* name, const std::vector<float>& values, std::vector<hsize_t> size) {
    const Handle space(H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr), H5Sclose);
    const Handle set(H5Dcreate2(out, name, H5T_NATIVE_FLOAT, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
    H5Dwrite(set, H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  };
  {
    const Handle out(H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
    put(out, "position", x, {2, 3});
    put(out, "radius", r, {2});
  }
  options_.bed = file;
  const PreparedBed prepared = prepare_bed(options_, {});
  EXPECT_EQ(prepared.bed.get_int("count"), 2);
  EXPECT_EQ(prepared.bed.get<double>("position")[3], 0.01);
  {
    const Handle out(H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
    put(out, "position", x, {3, 2});
  }
  EXPECT_TRUE(holds(refusal(), "dataset 'position'': expected N × 3 numbers, m"));
}

TEST_F(Beds, unknown_generator_is_refused_with_the_known_ones) {
  options_.bed_generator = "hex";
  EXPECT_TRUE(holds(refusal(), "'hex' is unknown, expected poisson or lattice"));
}

TEST_F(Beds, positions_of_a_file_are_settled_and_kept) {
  std::string text = "x_m,y_m,z_m\n";
  for (int layer = 0; layer < 4; ++layer)
    for (int i = 0; i < 13; ++i)
      for (int j = 0; j < 8; ++j)
        text += std::to_string(0.012 + 0.0215 * i + 0.005 * (layer % 2)) + "," +
                std::to_string(-0.088 + 0.0215 * j + 0.005 * (layer % 2)) + "," + std::to_string(0.01 + 0.021 * layer) +
                "\n";
  options_.bed = write("mine.csv", text);
  const PreparedBed first = prepare_bed(options_, {}), second = prepare_bed(options_, {});
  EXPECT_FALSE(first.from_cache);
  EXPECT_TRUE(second.from_cache);
  EXPECT_EQ(first.bed.arrays(), second.bed.arrays());
  EXPECT_TRUE(first.settled.settled);
  EXPECT_EQ(statistics_of(first).grains, 4 * 13 * 8);
  EXPECT_EQ(estimate_dem_terrain(options_).grains, 4 * 13 * 8);
  // A file with the same name and other contents is another bed.
  const std::string digest = bed_digest(options_);
  write("mine.csv", text + "0.15,0,0.12\n");
  EXPECT_NE(bed_digest(options_), digest);
}

TEST_F(Beds, bad_positions_are_refused_by_line) {
  for (const auto& [row, what] : std::initializer_list<std::pair<const char*, const char*>>{
           {"0.1,0,nan", "line 3': '0.1,0,nan', expected three finite numbers"},
           {"0.1,0", "line 3': '0.1,0', expected three finite numbers"},
           {"0.1,0,1e400", "expected three finite numbers"},
           {"0.4,0,0.05", "line 3': the grain stands at (0.4, 0, 0.05) m, expected a centre inside the bin"},
           {"0.1,0,-0.05", "inside the bin"},
           {"0.1,0,5000",
            "line 3': the grain stands at (0.1, 0, 5000) m, 5000 m above all that is below it, expected at "
            "most 1 m, 100 radii"},
           {"\x1b[31m,0,0.05", "line 3': '\\x1b[31m,0,0.05', expected three finite numbers"},
           {"0.101,0,0.05", "line 3': the grain at (0.101, 0, 0.05) m is 0.001 m from that of line 2"}}) {
    options_.bed = write("bad.csv", std::string("x_m,y_m,z_m\n0.1,0,0.05\n") + row + "\n");
    EXPECT_TRUE(holds(refusal(), what));
  }
  options_.bed = write("bad.csv", "x,y,z\n0.1,0,0.05\n");
  EXPECT_TRUE(holds(refusal(), "expected the header x_m,y_m,z_m"));
  // Of a file that is not a bed, only the beginning is shown.
  options_.bed = write("bad.csv", "root:x:0:0:root:/root:/bin/bash and more that is nobody's business\n");
  EXPECT_TRUE(holds(refusal(), "line 1': 'root:x:0:0:root:/root:/bin/…', expected"));
  for (const std::string& text : {"x_m,y_m,z_m\n0.1,0," + std::string(5000, '0') + "1\n", std::string(1 << 20, 'x')}) {
    options_.bed = write("bad.csv", text);
    EXPECT_TRUE(holds(refusal(), "': is longer than 1023 bytes, expected a CSV file"));
  }
  options_.bed = write("bad.csv", std::string("x_m,y_m,z_m\n0.1,0,0.05\0,0.1,0,0.05\n", 35));
  EXPECT_TRUE(holds(refusal(), "line 2': holds a zero byte"));
  options_.bed = write("bad.csv", "");
  EXPECT_TRUE(holds(refusal(), "is empty"));
}

/// Grains on top of each other, high above the floor.
TEST_F(Beds, grains_may_stand_high_when_others_stand_below) {
  std::string text = "x_m,y_m,z_m";
  for (int k = 0; k < 200; ++k) text += "\n0.1,0," + std::to_string(0.02 + 0.02 * k);
  const std::string file = write("high.csv", text);  // and no end of its last line
  std::vector<Quad> grains = read_positions_csv(file);
  EXPECT_EQ(grains.size(), 200U);
  check_positions(options_, file, grains);
  grains.push_back({0.1, 0.0, 5.2, 0.0});
  EXPECT_THROW(check_positions(options_, file, grains), Error);
}

/// A bed with a valid checksum whose lists contain grains that do not exist.
TEST_F(Beds, a_bed_that_does_not_hold_together_is_refused_by_file_and_array) {
  options_.bed = write("mine.csv", "x_m,y_m,z_m\n0.05,0,0.02\n0.1,0,0.02\n0.15,0,0.02\n");
  const Archive bed = prepare_bed(options_, {}).bed;
  const auto told = [&](const Archive& forged) {
    write_bed(folder() / "forged.h5", forged);
    DemOptions options = options_;
    options.bed = (folder() / "forged.h5").string();
    options.allow_unstable_step = true;
    const std::string text = furrow::refusal(ExitCode::io, [&] { make_dem_terrain(options)->prepare({}); });
    EXPECT_TRUE(text.empty() || holds(text, "forged.h5: "));
    return text;
  };
  EXPECT_EQ(told(bed), "");
  Archive forged = bed;
  forged.put("strips/last", std::vector<std::int32_t>(bed.get<std::int32_t>("strips/last").size(), 1 << 30));
  EXPECT_TRUE(holds(told(forged), "saved state 'strips/"));
  forged = bed;
  forged.put("surfaces/count", std::int64_t{1});
  EXPECT_TRUE(holds(told(forged), "holds a tire besides its grains"));
}

/// Such a bed in the cache: the next run prints a warning and settles the bed again, with the same result.
TEST_F(Beds, a_cached_bed_that_does_not_hold_together_is_settled_anew_and_replaced) {
  const auto load = [&](bool refused) {
    std::string warnings;
    GrainSolver solver(solver_params(options_));
    const PreparedBed prepared = load_bed(solver, options_, [&](const std::string& what, double) {
      if (what.starts_with(kWarning)) warnings += what;
    });
    EXPECT_EQ(holds(warnings, "saved state 'position'"), refused) << warnings;
    EXPECT_EQ(holds(warnings, prepared.file.string()), refused) << warnings;
    return prepared;
  };
  const PreparedBed made = load(false);
  Archive forged = made.bed;
  std::vector<double> positions = forged.get<double>("position");
  positions[5] = NAN;
  forged.put("position", positions);
  keep_bed(made.file, forged, bed_digest(options_));
  const PreparedBed again = load(true);
  EXPECT_FALSE(again.from_cache);
  EXPECT_EQ(again.bed.arrays(), made.bed.arrays());
  EXPECT_TRUE(load(false).from_cache);
}

TEST_F(Beds, compaction_makes_the_bed_denser_and_leaves_it_at_rest) {
  options_.cohesion = 80e3;
  const PreparedBed loose = prepare_bed(options_, {});
  options_.compaction_pressure = 100e3;
  const PreparedBed dense = prepare_bed(options_, {});
  EXPECT_NE(loose.file, dense.file);
  const BedStatistics before = statistics_of(loose), after = statistics_of(dense);
  EXPECT_EQ(before.grains, after.grains);
  EXPECT_TRUE(dense.settled.settled);
  EXPECT_LT(dense.settled.floor_error, 1e-3);
  EXPECT_LT(after.depth, 0.97 * before.depth);
  EXPECT_GT(after.solid_fraction, 1.02 * before.solid_fraction);
  EXPECT_GT(after.coordination, before.coordination);
}

TEST_F(Beds, compaction_of_a_settled_file_is_refused) {
  const PreparedBed made = prepare_bed(options_, {});
  options_.bed = made.file.string();
  EXPECT_EQ(prepare_bed(options_, {}).bed.arrays(), made.bed.arrays());
  options_.compaction_pressure = 1e4;
  EXPECT_TRUE(holds(refusal(), "terrain.compaction_pressure"));
}

TEST_F(Beds, whatever_a_bed_lacks_is_told_with_its_file) {
  const Archive whole = prepare_bed(options_, {}).bed;
  options_.bed = (folder() / "forged.h5").string();
  int refused = 0;
  for (const auto& [name, unused] : whole.arrays()) {
    Archive bed = whole;
    bed.remove(name);
    write_bed(options_.bed, bed);
    const std::string text = furrow::refusal(ExitCode::io, [&] {
      GrainSolver solver(solver_params(options_));
      load_bed(solver, options_, {});
    });
    refused += !text.empty();
    EXPECT_TRUE(text.empty() || text.starts_with(options_.bed)) << name << ": " << text;
  }
  EXPECT_GT(refused, 40);
}

TEST_F(Beds, digest_knows_every_way_to_make_a_bed) {
  const std::string plain = bed_digest(options_);
  DemOptions other = options_;
  other.bed_generator = "lattice";
  EXPECT_NE(bed_digest(other), plain);
  other = options_, other.compaction_pressure = 1e4;
  EXPECT_NE(bed_digest(other), plain);
  other = options_, other.periodic_x = true;
  EXPECT_NE(bed_digest(other), plain);
  other = options_, other.threads = 7;
  EXPECT_EQ(bed_digest(other), plain);
}

}  // namespace
}  // namespace furrow::terrain::dem
