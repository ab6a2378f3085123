#include "xml.h"

#include <fmt/format.h>

namespace etendue::mitsuba {
namespace {

pugi::xml_node add_value(pugi::xml_node parent, const char* kind, const char* name, const std::string& value) {
  pugi::xml_node node = parent.append_child(kind);
  node.append_attribute("name") = name;
  node.append_attribute("value") = value.c_str();
  return node;
}

void add_xyz(pugi::xml_node parent, const char* kind, const char* name, const Vec3d& value) {
  pugi::xml_node node = parent.append_child(kind);
  node.append_attribute("name") = name;
  node.append_attribute("x") = text_of(value.x).c_str();
  node.append_attribute("y") = text_of(value.y).c_str();
  node.append_attribute("z") = text_of(value.z).c_str();
}

}  // namespace

// Adding 0 turns -0 into 0.
std::string text_of(double value) { return fmt::format("{}", value + 0.0); }

pugi::xml_node add_plugin(pugi::xml_node parent, const char* kind, const char* type, const std::string& id, const char* name) {
  pugi::xml_node node = parent.append_child(kind);
  node.append_attribute("type") = type;
  if (!id.empty()) node.append_attribute("id") = id.c_str();
  if (*name != '\0') node.append_attribute("name") = name;
  return node;
}

void add_reference(pugi::xml_node parent, const std::string& id) { parent.append_child("ref").append_attribute("id") = id.c_str(); }

void add_float(pugi::xml_node parent, const char* name, double value) { add_value(parent, "float", name, text_of(value)); }
void add_integer(pugi::xml_node parent, const char* name, long long value) { add_value(parent, "integer", name, std::to_string(value)); }
void add_boolean(pugi::xml_node parent, const char* name, bool value) { add_value(parent, "boolean", name, value ? "true" : "false"); }
void add_string(pugi::xml_node parent, const char* name, const std::string& value) { add_value(parent, "string", name, value); }
void add_rgb(pugi::xml_node parent, const char* name, const Rgb& value) {
  add_value(parent, "rgb", name, text_of(value.x) + ' ' + text_of(value.y) + ' ' + text_of(value.z));
}
void add_point(pugi::xml_node parent, const char* name, const Vec3d& value) { add_xyz(parent, "point", name, value); }
void add_vector(pugi::xml_node parent, const char* name, const Vec3d& value) { add_xyz(parent, "vector", name, value); }

void add_matrix(pugi::xml_node parent, const char* name, const Transform& m) {
  pugi::xml_node node = parent.append_child("transform");
  node.append_attribute("name") = name;
  std::string rows;
  for (int row = 0; row < 3; ++row) {
    for (const Vec3d& column : {m.columns[0], m.columns[1], m.columns[2], m.translation}) rows += text_of(column[row]) + ' ';
  }
  node.append_child("matrix").append_attribute("value") = (rows + "0 0 0 1").c_str();
}

std::string id_safe(std::string_view name) {
  std::string id(name);
  for (char& c : id) {
    const bool keep = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    if (!keep) c = '_';
  }
  return id;
}

Transform facing_forward(const Transform& t) { return {{-t.columns[0], t.columns[1], -t.columns[2]}, t.translation}; }

Transform scaled(const Transform& t, const Vec3d& s) {
  return {{t.columns[0] * s.x, t.columns[1] * s.y, t.columns[2] * s.z}, t.translation};
}

}  // namespace etendue::mitsuba
