// A pressure schedule as readable text, in kPa.
#pragma once

#include <string>

#include "tire/pressure_schedule.hpp"

namespace furrow::tire {

/// @pre not empty
std::string pressure_text(const PressureSchedule& schedule);

}  // namespace furrow::tire
