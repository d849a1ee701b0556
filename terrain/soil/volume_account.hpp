// Where the soil under a plate goes: displaced = heaved + compacted volume.
//
//   displaced  V_d = A z                area of the plate × sinkage of its lower face
//   heaved     V_h = Σ (h' − h) a       over the surface beside the plate: highest grain tops in cells
//   compacted  V_c = V − V' − δ A       by which the bulk volume of the bed shrank
//
// The bulk volume V is measured from the positions of the grains alone: it is what a ball of radius r cannot reach with
// its centre, all points within r of a grain, but those inside the plate. This hull lies δ above the surface of grain
// tops; the plate takes that layer away with the surface that it covers. So no figure follows from the two others, and
// V_d − V_h − V_c shows their errors.
#pragma once

#include <span>

#include "protocol/core/terrain_state.hpp"
#include "terrain/dem/quad.hpp"

namespace furrow::terrain::soil {

/// What a plate covers: a disc of this diameter, or a strip of this width that spans the bed along y.
struct Footprint {
  bool disc = false;
  double x = 0.0, y = 0.0;  // of the middle, m
  double size = 0.0;        // m
  bool covers(double px, double py) const;
};

/// The part of a bed that is looked at, m. Grains repeat along an axis of it that is periodic.
struct Region {
  double x_min = 0.0, x_max = 0.0, y_min = 0.0, y_max = 0.0;
  bool periodic_x = false, periodic_y = false;
};

/// A bed at one time.
struct BedState {
  std::span<const dem::Quad> grains;  // positions x y z and radii w, m
  const HeightField& surface;
};

struct VolumeAccount {
  double displaced = 0.0, heaved = 0.0, compacted = 0.0;  // m³
  // Solid fraction of the space from 2 r below the plate's last face on, as deep as the plate is wide or to the floor.
  double solid_before = 0.0, solid_after = 0.0;
  double residual() const { return displaced - heaved - compacted; }  // m³
};

/// @param area of the plate as meshed, m² @param sinkage of its face below the surface before @param face its height
/// @param radius r of the grains, m
VolumeAccount volume_account(const Region& region, const Footprint& plate, double area, double sinkage, double face,
                             const BedState& before, const BedState& after, double radius);

}  // namespace furrow::terrain::soil
