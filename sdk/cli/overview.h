// What is in a scene, for people: tables of its lights, cameras, materials, pictures and meshes.
#pragma once

#include "etendue/io.h"
#include "session.h"

namespace etendue::cli {

// Only what `need` asks for; long tables are cut off unless the session is verbose.
void print_overview(const Session& session, const Scene& scene, Need need);

// The same as JSON, complete.
Json overview_json(const Scene& scene, Need need);

}  // namespace etendue::cli
