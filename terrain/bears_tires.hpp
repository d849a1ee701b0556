// What a terrain asks of the tires of a scenario before a run begins.
#pragma once

namespace furrow::terrain {

/// A TerrainSpec that asks something is one of these too.
struct BearsTires {
  virtual ~BearsTires() = default;

  /// @param width overall, of one tire, m
  /// @throws Error(bad_input) naming the key of the terrain that such a tire does not go with
  virtual void check_tire_width(double width) const = 0;
};

}  // namespace furrow::terrain
