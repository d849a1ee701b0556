#include "terrain/dem/parcel.hpp"

#include <algorithm>
#include <cmath>

namespace furrow::terrain::dem {

void add(ContactTotals& to, const ContactTotals& more) {
  to.power += more.power;
  to.elastic += more.elastic;
  to.contact_force += more.contact_force;
  to.max_overlap = std::max(to.max_overlap, more.max_overlap);
  add(to.wall_force, load(more.wall_force));
  to.floor_force += more.floor_force;
  to.contacts += more.contacts;
  add(to.sample, more.sample);
}

void add(MotionTotals& to, const MotionTotals& more) {
  to.net_force += more.net_force;
  to.kinetic += more.kinetic;
  to.spin2 += more.spin2;
  to.height += more.height;
  add(to.velocity, load(more.velocity));
  to.step_work += more.step_work;
  to.speed2 += more.speed2;
  to.max_net_force = std::max(to.max_net_force, more.max_net_force);
  add(to.held, load(more.held));
  // Not a number if one of the two is not: the strip must then be sorted, so that the grain is found.
  const double not_a_number = 0.0 * (to.max_speed + more.max_speed);
  store(to.fastest2, larger(load(to.fastest2), load(more.fastest2)));
  to.max_speed = std::sqrt(sum_of(load(to.fastest2))) + not_a_number;
}

}  // namespace furrow::terrain::dem
