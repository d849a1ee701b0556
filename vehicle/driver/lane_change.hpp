// Tracks of cones for the double lane change, as data: three lanes one after another, the middle one further to the
// left. Lengths are fixed; widths depend on the vehicle's width.
//
//   ISO 3888-1:2018, Passenger cars — Test track for a severe lane-change manoeuvre — Part 1: Double lane-change.
//     125 m. Its last two sections are one lane here. The right-hand limits of the first and last lane are in line, and
//     that of the middle lane is 3.5 m left of them.
//   ISO 3888-2:2011, Part 2: Obstacle avoidance. 61 m. The left-hand limits of the first and last lane are in line, and
//     the middle lane's right-hand limit is 1 m left of them.
//
// The standards leave the path to the driver. Here it follows the lanes' centre lines, with the C² smoothstep between
// them.
#pragma once

#include <array>
#include <string>

namespace furrow::vehicle {

struct LaneChangeTrack {
  struct Section {
    double length;  // m
    double factor;  // width = factor · vehicle's width + extra, at least `least`
    double extra;   // m
    double least;   // m
  };
  const char* name;
  std::array<Section, 3> lanes;
  std::array<double, 2> gaps;  // lengths between the lanes, m
  double offset;               // of the middle lane's right-hand limit, m
  bool from_left;              // from the left-hand limit of the others, otherwise from their right-hand limit
};

inline constexpr std::array<LaneChangeTrack, 2> kLaneChangeTracks = {{
    {"iso_3888_1", {{{15, 1.1, 0.25, 0}, {25, 1.2, 0.25, 0}, {30, 1.3, 0.25, 0}}}, {30, 25}, 3.5, false},
    {"iso_3888_2", {{{12, 1.1, 0.25, 0}, {11, 1.0, 1.0, 0}, {12, 1.3, 0.25, 3.0}}}, {13.5, 12.5}, 1.0, true},
}};

/// A lane between cones, from the track's start along x and from the first lane's centre line along y, m.
struct Lane {
  double start = 0.0, end = 0.0;  // x
  double centre = 0.0;            // y
  double width = 0.0;
};

/// @pre the track is one of kLaneChangeTracks
std::array<Lane, 3> lanes_of(const std::string& track, double vehicle_width);

}  // namespace furrow::vehicle
