#include "document.h"

#include <algorithm>
#include <array>

namespace etendue::gltf {
namespace {

using Indices = std::set<std::size_t>;
// Visits every reference to one array's elements.
using References = std::function<void(Json& document, const std::function<void(Json& index)>& visit)>;

void visit_member(Json& object, const char* key, const std::function<void(Json&)>& visit) {
  if (index_in(object, key) != nullptr) visit(object[key]);
}

// A textureInfo alone has a member `index`, in the core and in all extensions of references_are_known().
void texture_references(Json& document, const std::function<void(Json&)>& visit) {
  for_each_object(document, [&](Json& object) { visit_member(object, "index", visit); });
}
void image_references(Json& document, const std::function<void(Json&)>& visit) {
  if (!document.contains("textures")) return;
  for_each_object(document["textures"], [&](Json& object) { visit_member(object, "source", visit); });
}
void view_references(Json& document, const std::function<void(Json&)>& visit) {
  for_each_object(document, [&](Json& object) { visit_member(object, "bufferView", visit); });
}

Indices unreferenced(Json& document, const References& references, Indices candidates) {
  references(document, [&](Json& index) { candidates.erase(index.get<std::size_t>()); });
  return candidates;
}

void remove_elements(Json& document, const char* array, const References& references, const Indices& gone) {
  if (gone.empty()) return;
  Json kept = Json::array();
  for (std::size_t i = 0; i < document[array].size(); ++i)
    if (!gone.contains(i)) kept.push_back(std::move(document[array][i]));
  if (kept.empty())
    document.erase(array);
  else
    document[array] = std::move(kept);
  references(document, [&](Json& index) {
    const auto old = index.get<std::size_t>();
    index = old - static_cast<std::size_t>(std::distance(gone.begin(), gone.lower_bound(old)));
  });
}

void note_gap(Document& document, const Json& view) {
  if (const Json* buffer = index_in(view, "buffer"))
    document.gaps.push_back(
        {buffer->get<std::size_t>(), view.value("byteOffset", std::size_t{0}), view.value("byteLength", std::size_t{0})});
}

void remove_name(Json& document, const char* list, const std::string& name) {
  const auto found = document.find(list);
  if (found == document.end()) return;
  Json kept = Json::array();
  for (const Json& element : *found)
    if (element != name) kept.push_back(element);
  if (kept.empty())
    document.erase(list);
  else
    *found = std::move(kept);
}

}  // namespace

void for_each_object(Json& value, const std::function<void(Json&)>& visit) {
  if (value.is_object()) visit(value);
  if (!value.is_structured()) return;
  for (auto it = value.begin(); it != value.end(); ++it)
    if (!value.is_object() || it.key() != "extras") for_each_object(*it, visit);
}

const Json* index_in(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number_unsigned() ? &*found : nullptr;
}

bool references_are_known(const Json& document) {
  constexpr std::array known = {"EXT_texture_webp",        "EXT_texture_avif", "EXT_meshopt_compression",
                                "EXT_mesh_gpu_instancing", "EXT_lights_ies",   "EXT_lights_area"};
  const auto used = document.find("extensionsUsed");
  return used == document.end() || std::all_of(used->begin(), used->end(), [&](const Json& name) {
           const auto text = name.get<std::string>();
           return text.starts_with("KHR_") || std::find(known.begin(), known.end(), text) != known.end();
         });
}

void remove_unused(Document& document, const Indices& candidates) {
  Json& now = document.now;
  if (!references_are_known(document.before)) {
    document.losses.add("textures that only the old materials used",
                        "kept, unused: the file has extensions that may refer to them in ways that are not known here");
    return;
  }
  const Indices textures = unreferenced(now, texture_references, candidates);
  Indices images, views;
  for (const std::size_t texture : textures)
    for_each_object(now["textures"][texture], [&](Json& object) {
      if (const Json* image = index_in(object, "source")) images.insert(image->get<std::size_t>());
    });
  remove_elements(now, "textures", texture_references, textures);
  images = unreferenced(now, image_references, images);
  for (const std::size_t image : images)
    if (const Json* view = index_in(now["images"][image], "bufferView")) views.insert(view->get<std::size_t>());
  remove_elements(now, "images", image_references, images);
  std::map<std::size_t, const ImageRef*> new_images;
  for (const auto& [place, image] : document.new_images)
    new_images.emplace(place - static_cast<std::size_t>(std::distance(images.begin(), images.lower_bound(place))), image);
  document.new_images = std::move(new_images);
  views = unreferenced(now, view_references, views);
  for (const std::size_t view : views) note_gap(document, now["bufferViews"][view]);
  remove_elements(now, "bufferViews", view_references, views);
}

void use_extension(Json& document, const std::string& name) {
  Json& used = document["extensionsUsed"];
  if (std::find(used.begin(), used.end(), name) == used.end()) used.push_back(name);
}

void drop_extension(Json& document, const std::string& name) {
  remove_name(document, "extensionsUsed", name);
  remove_name(document, "extensionsRequired", name);
}

}  // namespace etendue::gltf
