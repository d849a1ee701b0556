// Writes frames of known contents and their index into the given folder, for xdmf_vtk_test.py to read.
//   3 instants; tire 0: 12 vertices, 20 triangles (an icosahedron that rolls); terrain: 30 grains
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "nodes/output/frames.hpp"
#include "nodes/output/xdmf.hpp"

namespace {

using furrow::Vec3;

furrow::SurfaceState icosahedron(double x, double turned) {
  const double golden = 0.5 * (1.0 + std::sqrt(5.0));
  const Vec3 corners[12] = {{-1, golden, 0}, {1, golden, 0}, {-1, -golden, 0}, {1, -golden, 0},
                            {0, -1, golden}, {0, 1, golden}, {0, -1, -golden}, {0, 1, -golden},
                            {golden, 0, -1}, {golden, 0, 1}, {-golden, 0, -1}, {-golden, 0, 1}};
  furrow::SurfaceState state;
  const furrow::Mat3 turn = Eigen::AngleAxisd(turned, Vec3::UnitY()).toRotationMatrix();
  for (const Vec3& corner : corners) {
    const Vec3 arm = 0.2 * (turn * corner);
    state.position.push_back(Vec3(x, 0.0, 0.5) + arm);
    state.velocity.push_back(Vec3(1.0, 0.0, 0.0) + Vec3(0.0, 2.0, 0.0).cross(arm));
  }
  return state;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "usage: xdmf_example FOLDER\n");
    return 2;
  }
  const std::filesystem::path folder = arguments[1];
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  const furrow::SurfaceMesh mesh{12,
                                 {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                                  {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                                  {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
  for (int i = 0; i < 3; ++i) {
    const double time = 0.1 * i;
    furrow::output::write_tire_frame(folder, 0, i, time, mesh, icosahedron(time, 2.0 * time),
                                     {{2, 3}, {{0, 0, 100.0 + i}, {5, 0, 50}}});
    furrow::terrain::TerrainFrame grains;
    for (int g = 0; g < 30; ++g) {
      grains.position.insert(grains.position.end(), {0.1f * g, 0.01f * g, 0.05f - 0.001f * i * g});
      grains.speed.push_back(0.01f * g);
      grains.radius.push_back(0.006f + 0.0001f * g);
    }
    furrow::output::write_terrain_frame(folder, i, time, grains);
  }
  furrow::output::write_xdmf_index(folder);
  return 0;
}
