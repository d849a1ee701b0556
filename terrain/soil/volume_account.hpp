// Volume account of the soil under a plate: displaced = heaved + compacted volume.
//
//   displaced  V_d = A z                area of the plate × sinkage of its lower face
//   heaved     V_h = Σ (h' − h) a       over the surface outside the plate: highest grain tops in cells
//   compacted  V_c = V − V' − δ A       decrease of the bed's bulk volume
//
// The bulk volume V follows from the positions of the grains alone: all points within r of a grain, except those inside
// the plate; a ball of radius r cannot reach them with its centre. This hull is δ above the surface of grain tops, and
// the plate removes that layer with the surface that it covers. So no volume follows from the other two, and V_d − V_h
// − V_c shows their errors.
#pragma once

#include <span>

#include "protocol/core/terrain_state.hpp"
#include "terrain/dem/quad.hpp"

namespace furrow::terrain::soil {

/// Area covered by a plate: a disc of this diameter, or a strip of this width that spans the bed along y.
struct Footprint {
  bool disc = false;
  double x = 0.0, y = 0.0;  // of the middle, m
  double size = 0.0;        // m
  bool covers(double px, double py) const;
};

/// The part of a bed for the account, m. Grains repeat along a periodic axis.
struct Region {
  double x_min = 0.0, x_max = 0.0, y_min = 0.0, y_max = 0.0;
  bool periodic_x = false, periodic_y = false;
};

struct BedState {
  std::span<const dem::Quad> grains;  // positions x y z and radii w, m
  const HeightField& surface;
};

struct VolumeAccount {
  double displaced = 0.0, heaved = 0.0, compacted = 0.0;  // m³
  // Solid fraction between 2 r below the plate's last face and the plate's width below that, or the floor.
  double solid_before = 0.0, solid_after = 0.0;
  double residual() const { return displaced - heaved - compacted; }  // m³
};

/// @param area of the plate as meshed, m² @param sinkage of its face below the surface before @param face its height
/// @param radius r of the grains, m
VolumeAccount volume_account(const Region& region, const Footprint& plate, double area, double sinkage, double face,
                             const BedState& before, const BedState& after, double radius);

}  // namespace furrow::terrain::soil
