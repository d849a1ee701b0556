#include "terrain/dem/beds/bed_format_4.hpp"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "protocol/core/archive_fields.hpp"
#include "terrain/dem/grain_solver.hpp"

namespace furrow::terrain::dem {
namespace {

constexpr double kMostWhole = 9007199254740992.0;  // 2^53

/// Takes numbers one after another.
class Numbers {
 public:
  explicit Numbers(const std::vector<double>& all) : next_(all.data()) {}
  void operator()(double& value) { value = *next_++; }
  /// @throws Error(io) for what is no whole number of that type
  void operator()(std::integral auto& value) {
    using Value = std::remove_reference_t<decltype(value)>;
    const double number = *next_++;
    if (!(std::abs(number) <= std::min(kMostWhole, static_cast<double>(std::numeric_limits<Value>::max()))))
      throw Error(ExitCode::io, "saved state holds a count that is none: it is damaged");
    value = static_cast<Value>(number);
  }
  void operator()(Vec3& value) {
    for (double& x : value) (*this)(x);
  }
  void operator()(Quad& value) {
    for (double* x : {&value.x, &value.y, &value.z, &value.w}) (*this)(*x);
  }

 private:
  const double* next_;
};

constexpr std::size_t kAccounts = 21, kStripSizes = 4, kStripNumbers = 14, kWallNumbers = 8;

Accounts accounts_of(const Archive& bed) {
  Numbers next(bed.get<double>("accounts", kAccounts));
  Accounts a;
  next(a.contact_work), next(a.elastic), next(a.elastic_start);
  next(a.wall_impulse), next(a.surface_impulse), next(a.floor_force);
  next(a.kinetic), next(a.height), next(a.velocity), next(a.contacts);
  next(a.max_overlap), next(a.contact_force), next(a.net_force), next(a.slept), next(a.active);
  return a;
}

void name_strips(const Archive& bed, Archive& named) {
  const auto& sizes = bed.get<std::int32_t>("strips/sizes");
  const std::size_t count = sizes.size() / kStripSizes;
  Numbers next(bed.get<double>("strips/values", kStripNumbers * count));
  ColumnWriter<Strip> strips;
  std::vector<std::int32_t> walls;
  for (std::size_t k = 0; k < count; ++k) {
    const std::int32_t* size = &sizes[kStripSizes * k];
    Strip s;
    s.first = size[0], s.last = size[1], s.pairs = size[2];
    walls.push_back(size[3]);
    next(s.travel), next(s.x_min), next(s.x_max), next(s.z_max), next(s.asleep), next(s.parcels.front().calm);
    next(s.contact.elastic), next(s.contact.max_overlap);
    next(s.contact.wall_force.x), next(s.contact.wall_force.y), next(s.contact.wall_force.z);
    next(s.contact.floor_force), next(s.contact.contacts), next(s.motion.height);
    strips.add(s);
  }
  strips.put(named, "strips");
  named.put("strips/walls", walls);
}

void name_walls(const Archive& bed, Archive& named) {
  const auto& grain = bed.get<std::int32_t>("walls/grain");
  const auto& wall = bed.get<std::int32_t>("walls/wall", grain.size());
  Numbers next(bed.get<double>("walls/history", kWallNumbers * grain.size()));
  ColumnWriter<WallContact> contacts;
  for (std::size_t k = 0; k < grain.size(); ++k) {
    WallContact contact;
    contact.grain = grain[k], contact.wall = wall[k];
    next(contact.tangential), next(contact.rolling);
    contacts.add(contact);
  }
  contacts.put(named, "walls");
}

}  // namespace

Archive from_format_4(const Archive& bed) {
  static const std::set<std::string> kRenamed{"accounts",   "strips/sizes",  "strips/values", "walls/grain",
                                              "walls/wall", "walls/history", "surfaces/keys", "surfaces/history"};
  Archive named;
  for (const auto& [name, array] : bed.arrays())
    if (!kRenamed.contains(name)) named.put_array(name, array);
  save_fields(named, "accounts", accounts_of(bed));
  name_strips(bed, named);
  name_walls(bed, named);
  SurfaceContacts({}, 0.0, {}, false).save(named);     // a bed bears none
  named.put("samples/strips", std::vector<double>());  // none taken: the first step does
  named.put("samples/until", std::int64_t{0});
  return named;
}

}  // namespace furrow::terrain::dem
