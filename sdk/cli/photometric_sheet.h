// A page of luminaires: one HTML file that needs nothing else.
#pragma once

#include <string>
#include <vector>

#include "photometric_file.h"

namespace etendue::cli {

// What the page shows of one file: its polar diagram, key figures and what is wrong with it.
std::string luminaire_card(const PhotometricReading& reading, Units units);
std::string luminaire_page(const std::vector<std::string>& cards, const std::string& title);

}  // namespace etendue::cli
