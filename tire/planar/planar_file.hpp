// The file of a planar tire.
#pragma once

#include <string>

#include "protocol/core/key.hpp"
#include "tire/planar/planar_params.hpp"
#include "tire/tire_file_keys.hpp"
#include "tire/tire_spec.hpp"

namespace furrow::tire {

inline constexpr int kLeastAround = 12, kMostAround = 2000, kMostRings = 200;

enum class PlanarVolume { averaged, element };

struct PlanarFile {
  static constexpr SchemaName kSchema{"planar",
                                      "A wheel seen from the side, in plane strain: a disc and around it the tire, "
                                      "meshed with constant-strain triangles. "
                                      "It can be pressed on plates, cleats and profiles; in a run the section is "
                                      "extended over the width. SI units."};
  std::string path;
  PlanarParams params;
  PlanarVolume volume = PlanarVolume::element;  // options.averaged of the parameters
  ContactBlock contact;
};
void visit_fields(FieldsOf<PlanarFile> auto& s, auto&& visit) {
  using namespace allowed;
  auto& p = s.params;
  visit(p.size.radius, needed("radius", "m", keys::kSize, "Radius of the undeformed tire."));
  visit(p.size.rim_radius, needed("rim_radius", "m", keys::kSize, "Radius of the disc, where the tire begins."));
  visit(p.options.width, needed("width", "m", keys::kSize, "Width; all forces and masses are in proportion to it."));
  visit(
      p.size.around,
      needed("elements_circumference", "", from(kLeastAround, kMostAround),
             "Nodes of every ring of the tire; tire.elements_circumference overrides it and changes elements_radial in "
             "proportion."));
  visit(p.size.rings, needed("elements_radial", "", from(1, kMostRings),
                             "Rings of triangles from the disc to the tread, each of twice elements_circumference."));
  visit(p.disc, needed("disc"));
  visit(p.tire, needed("tire"));
  visit(
      p.options.law,
      key("law", "", words("printed consistent"),
          "Volumetric stress lambda / 2 (J - 1/J), which is Hooke's law for small strains, or lambda (J - 1/J), as the "
          "source prints it."));
  visit(
      s.volume,
      key("volume", "", words("averaged element"),
          "Whether the volumetric stress is that of each triangle, which locks near incompressibility, or follows from "
          "volumes averaged around nodes."));
  visit(
      p.integrator,
      key("integrator", "", words("semi_implicit_euler runge_kutta_4"),
          "Integrator of its motion. runge_kutta_4 costs four times as much; forces of the terrain are constant in its "
          "steps, those of contact_law penalty are not."));
  visit(
      p.contact,
      key("contact_law", "", words("terrain penalty"),
          "Contact in a run: that of the terrain, or contact_stiffness and friction of this tire in each of its steps, "
          "as in the source, on the rigid terrain alone, level or alike across."));
  visit(p.disc_in_run,
        key("disc_in_run", "", words("rigid elastic"),
            "Whether the rim replaces the disc in a run, or holds its middle alone: then the tire's mass contains the "
            "disc, and the rim's must not."));
  visit(p.step_share, needed("step_share", "-", above(0).to(1),
                             "Step of its motion / largest stable one; in a run that of the mesh as it is pressed."));
  visit(p.contact_stiffness,
        needed("contact_stiffness", "N/m", above(0).usual(1e4, 1e11),
               "c, force of a node on rigid ground / its depth, per metre of width, when it is pressed, and in a run "
               "with contact_law penalty."));
  visit(s.contact, keys::kContact);
}

}  // namespace furrow::tire
