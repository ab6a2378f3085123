// The Python script that renders, and its messages.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <string_view>

namespace etendue::mitsuba {

const std::string& driver_script();
// What follows "@etendue " on a line of its output; an empty object for every other line.
nlohmann::json driver_message(std::string_view line);

}  // namespace etendue::mitsuba
