#include "terrain/dem/beds/bed_cache.hpp"

#include <span>
#include <string>
#include <vector>

#include "protocol/core/field_hash.hpp"
#include "protocol/core/hash.hpp"
#include "protocol/core/paced_call.hpp"
#include "protocol/files/archive_file.hpp"
#include "protocol/files/cache_folder.hpp"
#include "protocol/files/text_file.hpp"
#include "terrain/dem/beds/bed_settling.hpp"
#include "terrain/dem/contact/contact_mixing.hpp"
#include "terrain/dem/solver_setup.hpp"

namespace furrow::terrain::dem {
namespace {

constexpr std::int64_t kBedFormat = 6;         // raise it when the bits of a bed or its digest may change
constexpr const char* kDigest = "bed/digest";  // only in files of the cache

constexpr ArchiveKind kBed{"bed", "a bed of furrow", kBedFormat, ""};

/// Checks the labels of a bed. @throws Error(io) naming what is missing
void require_label(const Archive& bed) {
  for (const char* count : {"count", "surfaces/count", "bed/periodic_sides"}) (void)bed.get_int(count);
  for (const char* four : {"bed/geometry", "bed/settled"}) (void)bed.get<double>(four, 4);
  (void)bed.get<double>("pairs/rolling");
  (void)bed.get<std::uint8_t>("bed/law");
  (void)bed.get_double("bed/size_spread");
}

}  // namespace

std::string bed_digest(const DemOptions& o, const std::string& arithmetic) {
  Hash hash;
  hash.add(arithmetic);
  const auto add = [&](const auto& value) { hash.add(&value, sizeof value); };
  add(kBedFormat);
  add(kSkinShare);
  add_fields(hash, o, role::bed);
  add(o.periodic_x);
  if (o.piece) hash.add("piece of a tiled bed");
  add(o.seed);
  add(settle_step(o));
  // Beds cached earlier were placed again after their fall, without their contacts.
  if (o.settling_friction >= 0.0) hash.add("goes on as it lies");
  if (o.gravity != standard_gravity()) hash.add(o.gravity.data(), 3 * sizeof(double));
  if (!o.bed.empty()) add_file(hash, o.bed);
  return hash.hex();
}

std::filesystem::path bed_cache_file(const std::string& digest) {
  const std::filesystem::path folder = cache_folder("beds");
  return folder.empty() ? folder : folder / (digest + ".h5");
}

void write_bed(const std::filesystem::path& file, const Archive& archive, const ProgressCall& progress) {
  std::error_code failed;  // if the folder cannot be created, creating the file reports it
  std::filesystem::create_directories(file.parent_path(), failed);
  PacedCall tell(progress, PacedCall::kInterval);
  write_archive(file, archive, kBed, [&] { tell("keeping the bed", 0.0); });
}

void keep_bed(const std::filesystem::path& file, Archive& bed, const std::string& digest,
              const ProgressCall& progress) {
  bed.put(kDigest, std::vector<std::uint8_t>(digest.begin(), digest.end()));
  try {
    write_bed(file, bed, progress);
  } catch (const Error&) {
    bed.remove(kDigest);
    throw;
  }
  bed.remove(kDigest);
}

Archive read_bed(const std::filesystem::path& file, const ProgressCall& progress, std::string* digest) {
  PacedCall tell(progress, PacedCall::kInterval);
  Archive bed = read_archive(file, kBed, [&] { tell("reading the bed", 0.0); });
  try {
    require_label(bed);
    if (bed.has(kDigest)) {
      const auto& text = bed.get<std::uint8_t>(kDigest);
      if (digest) digest->assign(text.begin(), text.end());
      bed.remove(kDigest);
    }
  } catch (const Error& error) {
    throw Error(error.code(), file.string() + ": " + error.what());
  }
  return bed;
}

bool may_be_bed(const std::filesystem::path& file) { return may_be_archive(file, kBed); }

}  // namespace furrow::terrain::dem
