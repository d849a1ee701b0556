// Fuzzes settled beds, as another user's bed file may contain them: numbers changed, arrays cut, renamed and exchanged,
// with a valid checksum. They are read from disk, restored and stepped.
#include <fuzzer/FuzzedDataProvider.h>

#include <cmath>
#include <limits>
#include <tuple>

#include "protocol/core/error.hpp"
#include "protocol/core/outcome.hpp"
#include "terrain/dem/beds/bed_cache.hpp"
#include "terrain/dem/beds/bed_preparation.hpp"
#include "terrain/dem/dem_terrain.hpp"
#include "tests/fuzz/input_file.hpp"

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

SurfaceState square(double z) {
  SurfaceState s;
  s.position = {Vec3(0.1, -0.1, z), Vec3(0.3, -0.1, z), Vec3(0.3, 0.1, z), Vec3(0.1, 0.1, z)};
  s.velocity.assign(4, Vec3::Zero());
  return s;
}
const SurfaceMesh kSquare{4, {{0, 1, 2}, {0, 2, 3}}};

Outcome advance(terrain::Terrain& terrain) {
  std::vector<NodalForces> forces(1);
  std::vector<ContactSums> sums(1);
  const std::vector<SurfaceState> target{square(0.109)};
  return terrain.advance(target, 1e-4, 1, forces, sums);
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

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  FuzzedDataProvider in(data, size);
  static const Archive settled = terrain::dem::prepare_bed(options(), {}).bed;
  terrain::dem::DemOptions o = options();
  o.bed = (fuzz::folder() / "bed.h5").string();
  try {
    terrain::dem::write_bed(o.bed, changed(in, settled));
    const auto terrain = terrain::make_dem_terrain(o);
    terrain->prepare({});
    terrain::TerrainFrame frame;
    terrain->gather_frame(frame);
    terrain->attach(kSquare, {1e7, 0.4, 0.8, 0.2, 0, 0, 0, 0}, square(0.11));
    std::ignore = advance(*terrain);
  } catch (const Error&) {
  }
  return 0;
}
