#include "terrain/dem/beds/bed_cache.hpp"

#include <array>
#include <cstdlib>
#include <span>

#include "protocol/core/hash.hpp"
#include "protocol/files/archive_file.hpp"
#include "protocol/files/text_file.hpp"
#include "terrain/dem/beds/bed_settling.hpp"
#include "terrain/dem/solver_setup.hpp"

namespace furrow::terrain::dem {
namespace {

constexpr std::int64_t kBedFormat = 4;  // raise when the bits of a bed may change

constexpr ArchiveKind kBed{"bed", "a bed of furrow", kBedFormat, "", true};

}  // namespace

std::string bed_digest(const TerrainOptions& o) {
  Hash hash;
  hash.add(o.law);
  hash.add(o.precision);
  const std::array<double, 19> numbers{static_cast<double>(kBedFormat),
                                       o.radius,
                                       o.size_spread,
                                       o.density,
                                       static_cast<double>(o.layers),
                                       o.length,
                                       o.width,
                                       kSkinShare,
                                       o.periodic_x ? 1.0 : 0.0,
                                       o.periodic_y ? 1.0 : 0.0,
                                       o.young_modulus,
                                       o.poisson_ratio,
                                       o.restitution,
                                       o.friction,
                                       o.rolling_friction,
                                       o.cohesion,
                                       o.normal_stiffness,
                                       o.normal_damping,
                                       o.friction_velocity_scale};
  hash.add(std::span<const double>(numbers));
  const double step = settle_step(o);
  hash.add(&step, sizeof step);
  hash.add(&o.seed, sizeof o.seed);
  hash.add(o.size_distribution);
  hash.add(o.bed_generator);
  hash.add(&o.compaction_pressure, sizeof o.compaction_pressure);
  hash.add(&o.settling_friction, sizeof o.settling_friction);
  if (!o.bed.empty()) add_file(hash, o.bed);
  return hash.hex();
}

std::filesystem::path bed_cache_file(const std::string& digest) {
  std::filesystem::path folder;
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache) {
    folder = cache;
  } else if (const char* home = std::getenv("HOME"); home && *home) {
    folder = std::filesystem::path(home) / ".cache";
  } else {
    return {};
  }
  return folder / "furrow" / "beds" / (digest + ".h5");
}

void write_bed(const std::filesystem::path& file, const Archive& archive) {
  std::error_code failed;  // if the folder cannot be made, creating the file says so
  std::filesystem::create_directories(file.parent_path(), failed);
  write_archive(file, archive, kBed);
}

Archive read_bed(const std::filesystem::path& file) { return read_archive(file, kBed); }

bool may_be_bed(const std::filesystem::path& file) { return may_be_archive(file, kBed); }

}  // namespace furrow::terrain::dem
