// Parameters of a planar wheel: its sizes, materials and options.
#pragma once

#include <array>

#include "tire/planar/planar_elements.hpp"

namespace furrow::tire {

enum class PlanarIntegrator { semi_implicit_euler, runge_kutta_4 };
enum class PlanarContactOf { terrain, penalty };  // in a run
enum class PlanarDisc { rigid, elastic };         // in a run

struct PlanarParams {
  PlanarWheelSize size;
  PlanarMaterial disc, tire;
  PlanarOptions options;
  double contact_stiffness = 0.0;  // c of a node, N/m per metre of width
  double friction = 0.0;           // of tire on ground
  PlanarContactOf contact = PlanarContactOf::terrain;
  PlanarDisc disc_in_run = PlanarDisc::rigid;
  PlanarIntegrator integrator = PlanarIntegrator::semi_implicit_euler;
  double step_share = 0.5;  // of the largest stable step of the undeformed mesh
};

inline PlanarElements planar_elements(const PlanarMesh& mesh, const PlanarParams& params) {
  return PlanarElements(mesh, std::array{params.disc, params.tire}, params.options);
}

}  // namespace furrow::tire
