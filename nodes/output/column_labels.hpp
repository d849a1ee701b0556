// What results.h5 says of a column beside its numbers, in the words that netCDF's readers know (CF conventions): xarray
// and ParaView label axes with it.
#pragma once

#include <string>

#include "protocol/core/column.hpp"

namespace furrow::output {

/// A unit in ASCII as UDUNITS reads it: "m/s2"; "1" where there is none.
std::string units_label(std::string_view unit);
/// The name in words, without the unit at its end: "spindle force x".
std::string long_name(const Column& column);
/// What the value in a line is: "time_s: mean". Empty for what is computed from other columns.
std::string cell_methods(const Column& column);

}  // namespace furrow::output
