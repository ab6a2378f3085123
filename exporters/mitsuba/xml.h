// Elements of Mitsuba's scene files.
#pragma once

#include "etendue/vec.h"

#include <string>
#include <string_view>

#include <pugixml.hpp>

namespace etendue::mitsuba {

// <KIND type="TYPE" id="ID" name="NAME">; id and name are left out where they are "".
pugi::xml_node add_plugin(pugi::xml_node parent, const char* kind, const char* type, const std::string& id = {}, const char* name = "");
void add_reference(pugi::xml_node parent, const std::string& id);

void add_float(pugi::xml_node parent, const char* name, double value);
void add_integer(pugi::xml_node parent, const char* name, long long value);
void add_boolean(pugi::xml_node parent, const char* name, bool value);
void add_string(pugi::xml_node parent, const char* name, const std::string& value);
void add_rgb(pugi::xml_node parent, const char* name, const Rgb& value);
void add_point(pugi::xml_node parent, const char* name, const Vec3d& value);
void add_vector(pugi::xml_node parent, const char* name, const Vec3d& value);
void add_matrix(pugi::xml_node parent, const char* name, const Transform& value);

// A name as part of an id: letters, digits, '_' and '-', other characters become '_'.
std::string id_safe(std::string_view name);

// Shortest decimal text that reads back as the same double.
std::string text_of(double value);

// Lights and cameras look along -Z here and along +Z in Mitsuba, +Y up in both: half a turn about Y.
Transform facing_forward(const Transform& transform);
// `transform` after a scale along its own axes.
Transform scaled(const Transform& transform, const Vec3d& scale);

}  // namespace etendue::mitsuba
