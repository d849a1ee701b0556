// Saved states with numbers changed, arrays cut, renamed and exchanged, and a checksum that fits: what a bed file, of
// this format or an earlier one, or the part of a checkpoint may hold that somebody forged. Read back from disk,
// restored and stepped; of engine liggghts, read and made into the state of engine dem.
#include <fuzzer/FuzzedDataProvider.h>

#include <cmath>
#include <limits>
#include <tuple>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/core/outcome.hpp"
#include "protocol/files/archive_file.hpp"
#include "rigs/drawbar_rig.hpp"
#include "terrain/dem/beds/bed_cache.hpp"
#include "terrain/dem/beds/bed_preparation.hpp"
#include "terrain/dem/dem_terrain.hpp"
#include "terrain/liggghts/saved_grains.hpp"
#include "tests/fuzz/input_file.hpp"
#include "tire/tires.hpp"

namespace {

using namespace furrow;

terrain::dem::DemOptions options() {
  terrain::dem::DemOptions o;
  o.radius = 0.03, o.layers = 2, o.length = 0.5, o.width = 0.3, o.step = 1e-4;
  o.threads = o.settle_threads = 1;
  o.cache = false;
  o.allow_unstable_step = true;
  return o;
}

struct Seeds {
  Archive bed, old_bed, terrain, part, shell, rigid, rig;
};

constexpr ArchiveKind kOldBed{"bed", "a bed of furrow", 4, 4, ""};

tire::TireOptions tire_options(bool rigid) {
  tire::TireOptions o;
  o.file = FURROW_SOURCE_FOLDER "/tire/data/toroidal.json";
  o.elements_circumference = 12, o.elements_width = 6;
  o.rigid = rigid;
  return o;
}

SurfaceState square(double z) {
  SurfaceState s;
  s.position = {Vec3(0.1, -0.1, z), Vec3(0.3, -0.1, z), Vec3(0.3, 0.1, z), Vec3(0.1, 0.1, z)};
  s.velocity.assign(4, Vec3::Zero());
  return s;
}
const SurfaceMesh kSquare{4, {{0, 1, 2}, {0, 2, 3}}};

/// A terrain with one surface that touches it.
std::unique_ptr<terrain::Terrain> made_terrain() {
  auto terrain = terrain::make_dem_terrain(options());
  terrain->prepare({});
  ContactMaterial rubber;
  rubber.young_modulus = 1e7, rubber.poisson_ratio = 0.4, rubber.friction = 0.8, rubber.restitution = 0.2;
  terrain->attach(kSquare, rubber, square(0.11));
  return terrain;
}

Outcome advance(terrain::Terrain& terrain) {
  std::vector<NodalForces> forces(1);
  std::vector<ContactSums> sums(1);
  const std::vector<SurfaceState> target{square(0.109)};
  return terrain.advance(target, 1e-4, 1, forces, sums);
}

std::unique_ptr<rigs::Rig> made_rig() {
  rigs::DrawbarRigOptions o;
  o.carrier_mass = 450.0, o.rim_mass = 15.0, o.rim_spin_inertia = 0.4, o.rim_diametral_inertia = 0.3;
  o.touchdown_damping = 1e4, o.touchdown_time = 0.1;
  auto rig = rigs::make_drawbar_rig(o);
  rig->add_tire_mass(0, {20.0, Mat3::Identity()}, 0.46);
  return rig;
}

/// What a rank of engine liggghts saves of three grains that touch and stand on the floor.
Archive saved_part() {
  std::vector<double> state, contact{4.0, 0.0, 0.0, 1.0, 0.5, 0.0, 0.0, 0.03, 0.0, 0.0, 0.0}, contacts;
  for (const double x : {0.1, 0.159, 0.218}) {
    state.push_back(options().radius);
    for (int copy = 0; copy < 3; ++copy) state.insert(state.end(), {x, 0.0, 0.029});
    state.insert(state.end(), 6, 0.01);
    contacts.insert(contacts.end(), contact.begin(), contact.end());
  }
  Archive archive;
  const Archive::Scope scope(archive, "terrain/");
  archive.put("grains/all", std::int64_t{3});
  archive.put("tires/count", std::int64_t{1});
  archive.put("grains/id", std::vector<std::int32_t>{0, 1, 2});
  archive.put("grains/state", state);
  archive.put("pairs/grains", std::vector<std::int32_t>{0, 1, 1, 2});
  archive.put("pairs/history", std::vector<double>(14, 0.03));
  archive.put("carried/grain", std::vector<std::int32_t>{0, 1, 2});
  archive.put("carried/history", contacts);
  return archive;
}

Outcome advance(rigs::Rig& rig) {
  const std::vector<Wrench> wrenches(1, Wrench{Vec3(100.0, 0.0, 4000.0), Vec3(0.0, -300.0, 0.0)});
  return rig.advance(wrenches, 1e-4, 2);
}

const Seeds& seeds() {
  static const Seeds all = [] {
    Seeds s;
    s.bed = terrain::dem::prepare_bed(options(), {}).bed;
    s.old_bed = read_archive(FURROW_SOURCE_FOLDER "/tests/terrain/data/bed_format_4.h5", kOldBed);
    const auto terrain = made_terrain();
    FURROW_ASSERT(advance(*terrain).ok, "the bed moves");
    terrain->save(s.terrain);
    s.part = saved_part();
    for (const bool rigid : {false, true}) {
      const auto tire = tire::make_tire(tire_options(rigid));
      RimState rim;
      rim.position = Vec3(0.0, 0.0, 1.0);
      tire->place(rim);
      tire->save(rigid ? s.rigid : s.shell);
    }
    const auto rig = made_rig();
    rig->place(std::vector<double>{1.0});
    FURROW_ASSERT(advance(*rig).ok, "the rig moves");
    rig->save(s.rig);
    return s;
  }();
  return all;
}

Archive changed(FuzzedDataProvider& in, Archive archive) {
  std::vector<std::string> names;
  for (const auto& [name, array] : archive.arrays()) names.push_back(name);
  const auto any = [&] { return names[in.ConsumeIntegralInRange<std::size_t>(0, names.size() - 1)]; };
  for (int k = 0; k < 6 && in.remaining_bytes() > 4; ++k) {
    const std::string name = any();
    Archive::Array array = archive.arrays().at(name);
    switch (in.ConsumeIntegralInRange(0, 7)) {
      case 0:
        array = archive.arrays().at(any());
        break;
      case 1:
        std::visit(
            [&](auto& values) { values.resize(in.ConsumeIntegralInRange<std::size_t>(0, 2 * values.size() + 2)); },
            array);
        break;
      default:
        std::visit(
            [&]<class T>(std::vector<T>& values) {
              if (values.empty()) return;
              T& value = values[in.ConsumeIntegralInRange<std::size_t>(0, values.size() - 1)];
              if constexpr (std::is_floating_point_v<T>) {
                constexpr double kOdd[] = {0.0,
                                           -1.0,
                                           1e300,
                                           -1e300,
                                           5e-324,
                                           1e6,
                                           std::numeric_limits<double>::infinity(),
                                           std::numeric_limits<double>::quiet_NaN()};
                value =
                    in.ConsumeBool() ? in.PickValueInArray(kOdd) : value * in.ConsumeFloatingPointInRange(-4.0, 4.0);
              } else {
                value = in.ConsumeBool()
                            ? in.ConsumeIntegral<T>()
                            : static_cast<T>(static_cast<std::uint64_t>(value) + in.ConsumeIntegralInRange(0, 8) - 4);
              }
            },
            array);
    }
    archive.put_array(name, std::move(array));
  }
  return archive;
}

void read_bed(FuzzedDataProvider& in, bool old) {
  terrain::dem::DemOptions o = options();
  o.bed = (fuzz::folder() / "bed.h5").string();
  if (old) {  // as the file was made: tests/terrain/bed_preparation_test.cpp
    o.radius = 0.05, o.length = 1.0, o.width = 0.36, o.rolling_friction = 0.1, o.cohesion = 80e3;
    write_archive(o.bed, changed(in, seeds().old_bed), kOldBed);
  } else {
    terrain::dem::write_bed(o.bed, changed(in, seeds().bed));
  }
  const auto terrain = terrain::make_dem_terrain(o);
  terrain->prepare({});
  terrain::TerrainFrame frame;
  terrain->gather_frame(frame);
  terrain->attach(kSquare, {1e7, 0.4, 0.8, 0.2, 0, 0, 0, 0}, square(0.11));
  std::ignore = advance(*terrain);
}

void read_terrain(FuzzedDataProvider& in) {
  const auto file = fuzz::folder() / "terrain.h5";
  write_archive(file, changed(in, seeds().terrain));
  static const auto made = made_terrain();
  made->restore(read_archive(file));
  std::ignore = advance(*made);
}

void read_part(FuzzedDataProvider& in) {
  const auto file = fuzz::folder() / "part.h5";
  write_archive(file, changed(in, seeds().part));
  const std::vector<Archive> parts{read_archive(file)};
  std::ignore = terrain::liggghts::as_solver_state(parts, options());
}

void read_tire(FuzzedDataProvider& in) {
  const bool rigid = in.ConsumeIntegralInRange(0, 4) == 0;
  const auto file = fuzz::folder() / "tire.h5";
  write_archive(file, changed(in, rigid ? seeds().rigid : seeds().shell));
  const auto tire = tire::make_tire(tire_options(rigid));
  tire->restore(read_archive(file));
}

void read_rig(FuzzedDataProvider& in) {
  const auto file = fuzz::folder() / "rig.h5";
  write_archive(file, changed(in, seeds().rig));
  const auto rig = made_rig();
  rig->restore(read_archive(file));
  std::ignore = advance(*rig);
  rig->report(0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  FuzzedDataProvider in(data, size);
  try {
    switch (in.ConsumeIntegralInRange(0, 7)) {
      case 0:
        read_tire(in);
        break;
      case 1:
        in.ConsumeBool() ? read_part(in) : read_rig(in);
        break;
      case 2:
      case 3:
      case 4:
        read_terrain(in);
        break;
      default:
        read_bed(in, in.ConsumeIntegralInRange(0, 2) == 0);
    }
  } catch (const Error&) {
  }
  return 0;
}
