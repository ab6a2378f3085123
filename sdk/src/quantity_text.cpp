#include "etendue/quantity_text.h"

#include "article.h"
#include "camera_text.h"
#include "etendue/srgb.h"
#include "etendue/temperature.h"

#include <array>
#include <charconv>

namespace etendue {
namespace {

Result<double> take_si(Cursor& cursor, Dimension expected) {
  const Cursor before = cursor;
  const Result<Counted> quantity = take_quantity(cursor);
  if (!quantity) return quantity.error();
  if (quantity->unit->dimension == expected) return quantity->si();
  return before.error("DIMENSION_MISMATCH", fmt::format("expected {} (in {}), found {}", with_article(name_of(expected)),
                                                        si_unit_of(expected), with_article(name_of(quantity->unit->dimension))));
}

// ---- Colours ----

Result<Written> take_hex(Cursor cursor) {
  const std::string_view digits = cursor.rest().substr(1);
  std::uint32_t code = 0;
  const auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), code, 16);
  if (digits.size() != 6 || status != std::errc() || end != digits.data() + 6)
    return cursor.error("COLOUR_INVALID", fmt::format("expected six hexadecimal digits such as #ffb46b, found \"{}\"", cursor.rest()));
  const auto linear = [&](int shift) { return srgb_to_linear((code >> shift & 0xFFU) / 255.0); };
  return Written{Rgb{linear(16), linear(8), linear(0)}};
}

template <int N>
Result<std::array<double, N>> take_numbers(Cursor& cursor) {
  std::array<double, N> numbers{};
  for (double& x : numbers) {
    const std::size_t word = cursor.word().size();
    const Result<double> number = [&]() -> Result<double> {
      double value = 0;
      std::string_view text = cursor.word();
      if (const char* const why = take_number(text, value))
        return cursor.error("NUMBER_INVALID", fmt::format("expected {} numbers, found \"{}\": {}", N, cursor.word(), why));
      if (!text.empty()) return cursor.error("NUMBER_INVALID", fmt::format("expected {} numbers, found \"{}\"", N, cursor.word()));
      return value;
    }();
    if (!number) return number.error();
    x = *number;
    cursor.skip(word);
  }
  if (!cursor.at_end()) return cursor.unexpected("nothing more");
  return numbers;
}

Result<Written> take_chromaticity(Cursor cursor) {
  const Cursor at = cursor;
  const auto xy = take_numbers<2>(cursor);
  if (!xy) return xy.error();
  const auto [x, y] = *xy;
  if (x >= 0 && y > 0 && x + y <= 1) return Written{Chromaticity{x, y}};
  return at.error("COLOUR_INVALID", fmt::format("expected a chromaticity with x >= 0, y > 0 and x + y <= 1, found {} {}", x, y));
}

Written in_kelvin(double kelvin) { return WrittenQuantity{kelvin, {Dimension::temperature}}; }

// What becomes of temperatures that lights do not have: refused, or where somebody listens clamped.
Result<double> legal(double kelvin, const Cursor& at, Diagnostics* clamped) {
  const Result<double> checked = checked_temperature(kelvin);
  if (checked) return *checked;
  const Result<ClampedTemperature> nearest = clamped != nullptr ? clamped_temperature(kelvin) : Result<ClampedTemperature>(checked.error());
  if (!nearest) return at.located(nearest.error());
  clamped->warning("TEMPERATURE_CLAMPED", fmt::format("{} K counts as {} K, the nearest there is", kelvin, nearest->kelvin),
                   at.located({}).where);
  return nearest->kelvin;
}

// "3000 K Duv -0.003", "3200 K + 137 mired".
Result<Written> take_colour_temperature(double kelvin, Cursor cursor, Diagnostics* clamped) {
  if (cursor.take("Duv")) {
    const Result<double> duv = cursor.number();
    if (!duv) return duv.error();
    cursor.skip_blanks();
    if (!cursor.at_end()) return cursor.unexpected("nothing more");
    return Written{ColourTemperature{kelvin, *duv}};
  }
  const bool minus = cursor.next() == '-';
  cursor.skip(1);
  const Cursor at = cursor;
  if (cursor.next() == '+' || cursor.next() == '-') return cursor.unexpected("a number without a second sign");
  const Result<double> shift = cursor.number();
  if (!shift) return shift.error();
  cursor.skip_blanks();
  if (!cursor.take("mired") || !cursor.at_end()) return cursor.unexpected("mired, as in 3200 K + 137 mired");
  const Result<double> shifted = shifted_by_mired(kelvin, minus ? -*shift : *shift);
  if (!shifted) return at.located(shifted.error());
  const Result<double> left = legal(*shifted, at, clamped);
  return left ? Result<Written>(in_kelvin(*left)) : left.error();
}

// ---- Quantities ----

Result<Written> written(const Result<CameraSettings>& camera) {
  if (!camera) return camera.error();
  return Written{*camera};
}

bool is_camera_unit(std::string_view word, const Cursor& behind) {
  if (word == "fps") return true;
  if (word == "deg" || word == "rad") return behind.next() == '@';
  return (word == "s" || word == "ms" || word == "us" || word == "stop") && !behind.at_end();
}

Result<Written> take_numbered(Cursor cursor, Diagnostics* clamped) {
  const Cursor start = cursor;
  const Result<double> number = cursor.number();
  if (!number) return number.error();
  Cursor ahead = cursor;
  ahead.skip_blanks();
  if (ahead.next() == '/') return written(take_camera(start));
  const std::string_view word = ahead.word();
  ahead.skip(word.size());
  if (is_camera_unit(word, ahead)) return written(take_camera(start));
  const Result<Counted> quantity = take_unit(*number, cursor);
  if (!quantity) return quantity.error();
  const Dimension dimension = quantity->unit->dimension;
  WrittenQuantity said{quantity->number, *quantity->unit};
  if (dimension == Dimension::temperature) {
    const Result<double> kelvin = legal(quantity->si(), start, clamped);
    if (!kelvin) return kelvin.error();
    if (cursor.next() == '+' || cursor.next() == '-' || cursor.next() == 'D') return take_colour_temperature(*kelvin, cursor, clamped);
    if (*kelvin != quantity->si() && cursor.at_end()) return in_kelvin(*kelvin);
  }
  while (!cursor.at_end()) {
    const Cursor at = cursor;
    if (!said.distance_m && cursor.take("@")) {
      if (dimension != Dimension::illuminance && dimension != Dimension::irradiance)
        return at.error("DIMENSION_MISMATCH",
                        fmt::format("only an illuminance has a distance, found one behind {}", with_article(name_of(dimension))));
      const Result<double> distance = take_si(cursor, Dimension::length);
      if (!distance) return distance.error();
      said.distance_m = *distance;
    } else if (!said.efficacy_lm_W && cursor.word() == "at") {
      cursor.take("at");
      const Result<double> efficacy = take_si(cursor, Dimension::efficacy);
      if (!efficacy) return efficacy.error();
      said.efficacy_lm_W = *efficacy;
    } else {
      return cursor.unexpected("nothing more, \"@\" and a distance, or \"at\" and an efficacy");
    }
  }
  return Written{said};
}

// ---- Printing ----

struct Printer {
  std::string operator()(const WrittenQuantity& w) const {
    std::string text = to_string(w.quantity());
    if (w.distance_m) text += fmt::format(" @ {} m", *w.distance_m);
    if (w.efficacy_lm_W) text += fmt::format(" at {} lm/W", *w.efficacy_lm_W);
    return text;
  }
  std::string operator()(const CameraSettings& c) const { return to_string(c); }
  std::string operator()(const ColourTemperature& t) const { return fmt::format("{} K Duv {}", t.kelvin, t.duv); }
  std::string operator()(const Chromaticity& xy) const { return fmt::format("xy {} {}", xy.x, xy.y); }
  std::string operator()(const Rgb& rgb) const { return fmt::format("rgb {} {} {}", rgb.x, rgb.y, rgb.z); }
};

// ---- All of it ----

Result<Written> parsed(std::string_view text, Diagnostics* clamped) {
  Cursor cursor(trimmed(text));
  if (cursor.is_number_start()) return take_numbered(cursor, clamped);
  if (cursor.next() == '#') return take_hex(cursor);
  if (cursor.take_name("xy")) return take_chromaticity(cursor);
  if (cursor.take_name("rgb")) {
    const auto rgb = take_numbers<3>(cursor);
    if (!rgb) return rgb.error();
    return Written{Rgb{(*rgb)[0], (*rgb)[1], (*rgb)[2]}};
  }
  for (const char* const name : {"f/", "T", "ISO", "ND"})
    if (Cursor ahead = cursor; ahead.take_name(name)) return written(take_camera(cursor));
  return cursor.error("NUMBER_INVALID",
                      fmt::format("expected a quantity such as 1500 lm, a camera setting such as f/2.8 or a colour such as "
                                  "#ffb46b, found \"{}\"",
                                  text));
}

}  // namespace

Result<Written> parse(std::string_view text) { return parsed(text, nullptr); }
Result<Written> parse(std::string_view text, Diagnostics& clamped) { return parsed(text, &clamped); }

std::string to_string(const Written& written) { return std::visit(Printer{}, written); }

}  // namespace etendue
