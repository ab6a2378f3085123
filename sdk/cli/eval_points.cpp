#include "eval_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iostream>
#include <vector>

#include "number_text.h"

namespace etendue::cli {
namespace {

constexpr std::string_view heading = "px,py,pz,nx,ny,nz,vx,vy,vz";
constexpr std::size_t most_numbers = 9, block = 4096, longest_line = 4096;

// Numbers between commas, as many as there are places; the number found, or nothing where something else stands.
std::optional<std::size_t> take_numbers(std::string_view text, std::span<double> numbers) {
  std::size_t count = 0;
  do {
    text = trimmed(text);
    if (count == numbers.size() || take_decimal(text, numbers[count]) != nullptr) return std::nullopt;
    ++count;
    text = trimmed(text);
    if (text.empty()) return count;
  } while (text.front() == ',' && (text.remove_prefix(1), true));
  return std::nullopt;
}

Result<PointRow> parse_row(std::string_view line, bool with_view, const Where& where) {
  const auto wrong = [&](const char* expected) {
    return Error{"POINT_INVALID", fmt::format("expected {}, found '{}'", expected, line), where, {}, {}};
  };
  std::array<double, most_numbers> n{};
  const std::optional<std::size_t> count = take_numbers(line, n);
  if (!count || (*count != 6 && *count != 9)) return wrong("px,py,pz,nx,ny,nz or px,py,pz,nx,ny,nz,vx,vy,vz");
  if (with_view && *count != 9) return wrong("nine numbers: this BRDF needs the direction to the eye, vx,vy,vz");
  const auto unit = [](const Vec3d& v) {
    const double longest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    return longest > 0 ? normalised(v / longest) : Vec3d{};
  };
  PointRow row{{n[0], n[1], n[2]}, unit({n[3], n[4], n[5]}), {}};
  if (dot(row.normal, row.normal) == 0) return wrong("a normal that is not 0");
  if (with_view) {
    row.view = unit({n[6], n[7], n[8]});
    if (dot(row.view, row.view) == 0) return wrong("a direction to the eye that is not 0");
  }
  return row;
}

}  // namespace

std::optional<Vec3d> parse_vector(std::string_view text) {
  std::array<double, 3> c{};
  const std::optional<std::size_t> count = take_numbers(text, c);
  if (count != 3) return std::nullopt;
  return Vec3d{c[0], c[1], c[2]};
}

std::optional<Rgb> parse_rgb(std::string_view text) {
  const std::optional<Rgb> c = parse_vector(text);
  return c && c->x >= 0 && c->y >= 0 && c->z >= 0 ? c : std::nullopt;
}

Status each_block(const std::string& file, bool with_view, const std::function<Status(std::span<const PointRow>)>& take) {
  std::ifstream opened;
  if (file != "-") {
    opened.open(file);
    if (!opened) return Error{"FILE_UNREADABLE", "the points cannot be read", {file, 0, 0, {}}, {}, {}};
  }
  std::istream& in = file == "-" ? std::cin : opened;
  const std::string name = file == "-" ? "stdin" : file;
  std::vector<PointRow> rows;
  std::string line;
  for (std::size_t number = 1; std::getline(in, line); ++number) {
    if (line.size() > longest_line)
      return Error{"LINE_TOO_LONG",
                   fmt::format("expected lines of at most {} bytes", longest_line),
                   {name, static_cast<int>(number), 0, {}},
                   {},
                   {}};
    const std::string_view text = trimmed(std::string_view(line).substr(0, line.size() - (line.ends_with('\r') ? 1 : 0)));
    if (text.empty() || (number == 1 && (text == heading || text == heading.substr(0, 17)))) continue;
    const Result<PointRow> row = parse_row(text, with_view, {name, static_cast<int>(number), 0, {}});
    if (!row) return row.error();
    rows.push_back(*row);
    if (rows.size() < block) continue;
    if (Status done = take(rows); !done) return done;
    rows.clear();
  }
  if (in.bad()) return Error{"FILE_UNREADABLE", "the points cannot be read", {name, 0, 0, {}}, {}, {}};
  return rows.empty() ? Status(Done{}) : take(rows);
}

}  // namespace etendue::cli
