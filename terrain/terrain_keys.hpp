// Keys of the section `terrain` that several engines share.
#pragma once

#include "protocol/core/key.hpp"

namespace furrow::terrain::keys {

inline constexpr Key kMaterial =
    key("material", "", allowed::not_empty().or_null(),
        "Soil file with values for this section: loose_sand.json, dense_sand.json, cohesive_sand.json (measured with "
        "furrow soil, engines dem and scm), grains_lete_sand.json, grains_lete_sand_loose.json, "
        "grains_sandy_loam.json, "
        "grains_loose_dry_sand.json (fitted, engines of grains), "
        "lete_sand.json, upland_sandy_loam.json, dry_sand.json (published, engine scm) or your own, relative to the "
        "scenario, then in terrain/data. Keys of the scenario's own section override it; with --set it overrides them. "
        "null: none.");
inline constexpr Key kConeIndex =
    key("cone_index", "Pa", role::harmless, allowed::above(0).to(1e9).usual(1e4, 1e7).or_null(),
        "Cone index of the soil, for the published regressions of traction that the summary shows beside the run; it "
        "changes no result. `furrow soil` measures it. null: that of the soil file under `measured`, where its values "
        "are taken as they are, or not known.");
inline constexpr Key kFriction = key(
    "friction", "-", allowed::from(0, 10),
    "Coulomb coefficient between grains. Between grain or ground and tire the smaller of this and that of the tire's "
    "file holds, or tire.friction. "
    "Without the key a handling tire has the grip of its file.");
inline constexpr Key kLength = key("length", "m", allowed::above(0).to(1e4).usual(0.2, 200),
                                   "Length of the bin or of the grid of engine scm, x from 0 to length.");
inline constexpr Key kWidth = key("width", "m", allowed::above(0).to(1e4).usual(0.05, 50),
                                  "Width of the bin or of the grid of engine scm, y from −width/2 to width/2.");
inline constexpr Key kFrictionVelocityScale =
    key("friction_velocity_scale", "s/m", allowed::above(0).to(1e6),
        "Constant c in F_t = μ F_e tanh(c |v_t|), law hertz_tanh and engine rigid.");

inline constexpr Key kProfileFile =
    key("profile_file", "", allowed::not_empty().or_null(),
        "File with the heights of the ground, engines rigid and scm: CSV with the columns x_m and z_m, or x_m, y_m and "
        "z_m at the nodes of a grid; a grid in ASCII after ESRI, with the ending .asc; or a measured road in OpenCRG, "
        "with the ending .crg, whose u is x. Relative to the scenario. In place of profile and road_class.");
inline constexpr Key kProfileAcross =
    key("profile_across", "",
        "Each wheel meets the heights where it is across profile_file. false: those at profile_v, alike for all y.");
inline constexpr Key kProfileLine = key(
    "profile_line", "", allowed::words("straight curved"),
    "The reference line of a road in OpenCRG: straight along x, or curved by its headings. A curved one begins along "
    "x where the straight one does.");
inline constexpr Key kProfileV = key(
    "profile_v", "m", allowed::from(-1e7, 1e7),
    "What lies at y = 0 of the scenario: v of profile_file in OpenCRG, to the left of its reference line, or y of a "
    "grid.");
inline constexpr Key kProfileFrom = key("profile_from", "m", allowed::from(0, 1e6).or_null(),
                                        "x where the first height of profile_file lies. null: where the file says.");

}  // namespace furrow::terrain::keys
