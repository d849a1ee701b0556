// A parcel: a piece of a strip across y, the smallest piece of a bed that can sleep and wake.
//
// The grains of a strip are sorted by columns of cells along y, its pairs by their first grain, its wall contacts by
// their grain. A parcel consists of some columns, so its grains, pairs and wall contacts are each one range of the
// strip's. So are those of a row of parcels, and a step evaluates only a few ranges of a strip.
#pragma once

#include <cstdint>
#include <vector>

#include "terrain/dem/accounts/contact_losses.hpp"
#include "terrain/dem/quad.hpp"

namespace furrow::terrain::dem {

inline constexpr int kParcelColumns = 4;  // columns of cells across, fewest in a parcel
inline constexpr int kFewestParcels = 3;  // of a strip that is cut; with fewer the strip is one parcel

/// Number of parcels of a strip with that many columns. A narrower bed is not cut: a wheel moves its whole width.
constexpr int parcels_across(int columns) {
  const int parcels = columns / kParcelColumns;
  return parcels < kFewestParcels ? 1 : parcels;
}

/// Sums over contacts, in the last step that evaluated them.
struct ContactTotals {
  double power = 0.0;          // Σ F·v_rel at the step's start, W
  double elastic = 0.0;        // J
  double contact_force = 0.0;  // Σ |F|, N, when measured
  double max_overlap = 0.0;    // m
  Quad wall_force;             // on the grains, N
  double floor_force = 0.0;    // N
  std::int64_t contacts = 0;
  ContactSample sample;  // when losses are sampled
};

/// Sums that a step computes in addition to the usual ones.
struct Wanted {
  bool forces = false;  // Σ |F| and Σ |net force|
  bool losses = false;  // by mechanism
};

/// Sums and extremes over grains after the last step; a speed or force is that of its largest components. Here m₀ and
/// I₀ are those of the reference grain.
struct MotionTotals {
  double net_force = 0.0;      // Σ |contact forces + weight| of grains, N, when measured
  double kinetic = 0.0;        // J
  double spin2 = 0.0;          // Σ I ω² / I₀, rad²/s²
  double height = 0.0;         // Σ m h / m₀, h against gravity, m
  Quad velocity;               // Σ m v / m₀, m/s
  double step_work = 0.0;      // Σ F·a + T·α: half of it times dt² belongs to the power at mid-step, N²/kg
  Quad fastest2;               // largest squares of each component of v, m²/s²
  double max_speed = 0.0;      // root of the sum of fastest2, m/s
  double speed2 = 0.0;         // Σ m v² / m₀, m²/s²
  double max_net_force = 0.0;  // N, only when grains may sleep
  Quad held;                   // Σ contact forces + weight, N, only when grains may sleep
};

void add(ContactTotals& to, const ContactTotals& more);
void add(MotionTotals& to, const MotionTotals& more);

/// Consecutive grains of a strip with their pairs and wall contacts; each range is counted from the strip's first.
struct StripPart {
  std::int32_t first = 0, last = 0;  // grains
  std::int32_t pair_first = 0, pair_last = 0;
  std::int32_t wall_first = 0, wall_last = 0;

  int grains() const { return last - first; }
};

struct Parcel {
  StripPart part;
  bool asleep = false;  // its grains rest and are not stepped, activity.hpp
  bool stale = false;   // it sleeps, but its grains have changed since its sums were computed
  int calm = 0;         // steps since a force on it was last too large or, unless it sways, its speed
  bool sways = false;   // its grains may be fast, but drifted slowly over the last window
  int window = 0;       // steps since its last window ended
  // Only while it is asleep or about to fall asleep; awake parcels are evaluated with their neighbours.
  ContactTotals contact;
  double measured_force = 0.0;  // contact.contact_force when last measured, N
  Stored stored;                // contact.sample.stored when last sampled
  MotionTotals motion;
};
/// The saved state of a parcel if strips are cut; its part follows from the lists.
void visit_fields(FieldsOf<Parcel> auto& s, auto&& visit) {
  visit(s.asleep, Field{"asleep", ""});
  visit(s.stale, Field{"stale", ""});
  visit(s.calm, Field{"calm"});
  visit(s.sways, Field{"sways", ""});
  visit(s.window, Field{"window"});
  visit(s.contact.elastic, Field{"elastic", "J"});
  visit(s.contact.max_overlap, Field{"max_overlap", "m"});
  visit(s.contact.wall_force, Field{"wall_force", "N"});
  visit(s.contact.floor_force, Field{"floor_force", "N"});
  visit(s.contact.contacts, Field{"contacts"});
  visit(s.measured_force, Field{"measured_force", "N"});
  visit(s.stored, Field{"stored", ""});
  visit(s.motion.height, Field{"height", "m"});
  visit(s.motion.held, Field{"held", "N"});
  visit(s.motion.max_net_force, Field{"pressed", "N"});
}

/// Parcels [from, to) as one part. @pre there is one
inline StripPart joined(const std::vector<Parcel>& parcels, int from, int to) {
  const StripPart &a = parcels[from].part, &b = parcels[to - 1].part;
  return {a.first, b.last, a.pair_first, b.pair_last, a.wall_first, b.wall_last};
}

}  // namespace furrow::terrain::dem
