// Labels of a column in results.h5 in the terms of the CF conventions for netCDF: xarray and ParaView label axes with
// them.
#pragma once

#include <string>

#include "protocol/core/column.hpp"

namespace furrow::output {

/// Returns a unit in ASCII as UDUNITS reads it: "m/s2"; "1" if there is none.
std::string units_label(std::string_view unit);
/// Returns the name in words, without the unit at its end: "spindle force x".
std::string long_name(const Column& column);
/// Returns how a line's value was formed: "time_s: mean". Empty for values computed from other columns.
std::string cell_methods(const Column& column);

}  // namespace furrow::output
