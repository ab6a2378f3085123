#include "driver.h"

#include <nlohmann/json.hpp>

namespace etendue::mitsuba {

const std::string& driver_script() {
  static const std::string script =
#include "driver.inc"
      ;
  return script;
}

nlohmann::json driver_message(std::string_view line) {
  constexpr std::string_view prefix = "@etendue ";
  if (line.substr(0, prefix.size()) != prefix) return nlohmann::json::object();
  nlohmann::json message = nlohmann::json::parse(line.substr(prefix.size()), nullptr, false);
  return message.is_object() ? message : nlohmann::json::object();
}

}  // namespace etendue::mitsuba
