#include "tire/rim_archive.hpp"

namespace furrow::tire {

void save_rim(Archive& archive, const std::string& name, const RimState& r) {
  const auto& q = r.orientation.coeffs();
  archive.put(name,
              std::vector<double>{r.position.x(), r.position.y(), r.position.z(), q[0], q[1], q[2], q[3],
                                  r.velocity.x(), r.velocity.y(), r.velocity.z(), r.angular_velocity.x(),
                                  r.angular_velocity.y(), r.angular_velocity.z()});
}

RimState restore_rim(const Archive& archive, const std::string& name) {
  const auto& v = archive.get<double>(name, 13);
  RimState r;
  r.position = Vec3(v[0], v[1], v[2]);
  r.orientation.coeffs() << v[3], v[4], v[5], v[6];
  r.velocity = Vec3(v[7], v[8], v[9]);
  r.angular_velocity = Vec3(v[10], v[11], v[12]);
  return r;
}

void save_wrench(Archive& archive, const std::string& name, const Wrench& w) {
  archive.put(name, std::vector<double>{w.force.x(), w.force.y(), w.force.z(), w.moment.x(), w.moment.y(),
                                        w.moment.z()});
}

Wrench restore_wrench(const Archive& archive, const std::string& name) {
  const auto& v = archive.get<double>(name, 6);
  return {Vec3(v[0], v[1], v[2]), Vec3(v[3], v[4], v[5])};
}

}  // namespace furrow::tire
