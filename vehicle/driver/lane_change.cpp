#include "vehicle/driver/lane_change.hpp"

#include <algorithm>

#include "protocol/core/assert.hpp"

namespace furrow::vehicle {

std::array<Lane, 3> lanes_of(const std::string& name, double vehicle_width) {
  const auto track = std::find_if(kLaneChangeTracks.begin(), kLaneChangeTracks.end(),
                                  [&](const LaneChangeTrack& t) { return name == t.name; });
  FURROW_ASSERT(track != kLaneChangeTracks.end(), name);
  std::array<Lane, 3> lanes;
  double x = 0.0;
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    const LaneChangeTrack::Section& section = track->lanes[i];
    lanes[i].width = std::max(section.factor * vehicle_width + section.extra, section.least);
    lanes[i].start = x;
    lanes[i].end = x + section.length;
    x = lanes[i].end + (i < track->gaps.size() ? track->gaps[i] : 0.0);
  }
  const double side = track->from_left ? 0.5 : -0.5;  // of the aligned limits from the centre, over the width
  const double limit = side * lanes[0].width;         // y
  lanes[2].centre = limit - side * lanes[2].width;
  lanes[1].centre = limit + track->offset + 0.5 * lanes[1].width;
  return lanes;
}

}  // namespace furrow::vehicle
