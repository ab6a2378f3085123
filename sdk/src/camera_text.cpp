#include "camera_text.h"

#include "article.h"
#include "parameter_error.h"

namespace etendue {
namespace {

// A setting: its member of CameraSettings, that member's name, and what it is in words.
struct Setting {
  std::optional<double> CameraSettings::*member;
  const char *name, *what;
};
constexpr Setting f_number{&CameraSettings::f_number, "f_number", "an f-number"}, t_stop{&CameraSettings::t_stop, "t_stop", "a T-stop"},
    shutter{&CameraSettings::shutter_s, "shutter_s", "a shutter time in seconds"},
    shutter_angle{&CameraSettings::shutter_angle_rad, "shutter_angle_rad", "a shutter angle"},
    frame_rate{&CameraSettings::frames_per_s, "frames_per_s", "a frame rate"}, iso{&CameraSettings::iso, "iso", "a sensitivity (ISO)"};

Status set(CameraSettings& camera, const Setting& setting, double value, const Cursor& at) {
  if (camera.*setting.member)
    return about(setting.name, at.error("CAMERA_SETTING_AMBIGUOUS", fmt::format("expected {} once, found a second one", setting.what)));
  if (!(value > 0 && std::isfinite(value)))
    return about(setting.name,
                 at.error("CAMERA_SETTING_INVALID", fmt::format("expected {} above 0 and finite, found {}", setting.what, value)));
  camera.*setting.member = value;
  return Done{};
}
Status take_setting(CameraSettings& camera, const Setting& setting, Cursor& cursor) {
  const Cursor at = cursor;
  const Result<double> value = cursor.number();
  if (!value) return value.error();
  cursor.skip_blanks();
  return set(camera, setting, *value, at);
}

// "1/60 s", "1/60", "8 ms", "180 deg @ 24 fps", "24 fps", "+1.5 stop".
Status take_counted(CameraSettings& camera, bool& compensated, Cursor& cursor) {
  const Cursor at = cursor;
  const Result<double> number = cursor.number();
  if (!number) return number.error();
  if (cursor.take("/")) {
    const Result<double> below = cursor.number();
    if (!below) return below.error();
    cursor.skip_blanks();
    if (cursor.word() == "s") cursor.take("s");
    return set(camera, shutter, *number / *below, at);
  }
  cursor.skip_blanks();
  const std::string_view word = cursor.word();
  if (word == "fps") {
    cursor.take("fps");
    return set(camera, frame_rate, *number, at);
  }
  const NamedUnit* const unit = find_unit(word);
  if (unit == nullptr)
    return word.empty() ? at.error("UNIT_MISSING", fmt::format("expected a unit behind {}, found none", *number), "for example 1/60 s")
                        : cursor.located(unit_named(word).error());
  cursor.skip(word.size());
  const double si = unit->to_si(*number);
  switch (unit->dimension) {
    case Dimension::duration:
      return set(camera, shutter, si, at);
    case Dimension::angle:
      cursor.take("@");
      return set(camera, shutter_angle, si, at);
    case Dimension::stop:
      if (compensated)
        return about("compensation_stop",
                     at.error("CAMERA_SETTING_AMBIGUOUS", "expected an exposure compensation once, found a second one"));
      compensated = true;
      camera.compensation_stop = si;
      return Done{};
    default:
      return at.error("DIMENSION_MISMATCH", fmt::format("expected a camera setting, found {}", with_article(name_of(unit->dimension))));
  }
}

Status take_camera_setting(CameraSettings& camera, bool& compensated, Cursor& cursor) {
  if (cursor.take_name("f/")) return take_setting(camera, f_number, cursor);
  if (cursor.take_name("T")) return take_setting(camera, t_stop, cursor);
  if (cursor.take_name("ISO")) return take_setting(camera, iso, cursor);
  if (cursor.take_name("ND")) {
    const Cursor at = cursor;
    const Result<double> density = cursor.number();
    if (!density) return density.error();
    cursor.skip_blanks();
    if (!(*density >= 0))
      return about("nd_density",
                   at.error("CAMERA_SETTING_INVALID", fmt::format("expected a filter's density from 0 upwards, found {}", *density)));
    camera.nd_density += *density;
    return Done{};
  }
  if (cursor.is_number_start()) return take_counted(camera, compensated, cursor);
  return cursor.unexpected("a camera setting such as f/2.8, T2.8, 1/60 s, ISO 400, ND 0.9 or +1 stop");
}

// "1/60 s" where that reads back as the same number.
std::string shutter_text(double seconds) {
  const double below = std::round(1 / seconds);
  return seconds < 1 && 1 / below == seconds ? fmt::format("1/{} s", below) : fmt::format("{} s", seconds);
}

}  // namespace

Result<CameraSettings> take_camera(Cursor cursor) {
  CameraSettings camera;
  bool compensated = false;
  while (!cursor.at_end())
    if (const Status taken = take_camera_setting(camera, compensated, cursor); !taken) return taken.error();
  if (camera.f_number && camera.t_stop)
    return about("t_stop", cursor.error("CAMERA_SETTING_AMBIGUOUS", "expected either an f-number or a T-stop, found both"));
  if (camera.shutter_s && camera.shutter_angle_rad)
    return about("shutter_angle_rad",
                 cursor.error("CAMERA_SETTING_AMBIGUOUS", "expected either a shutter time or a shutter angle, found both"));
  if (!std::isfinite(camera.nd_density))
    return about("nd_density", cursor.error("CAMERA_SETTING_INVALID", "the densities add up beyond the range of a double"));
  return camera;
}

std::string to_string(const CameraSettings& c) {
  std::string text;
  const auto add = [&](const std::string& setting) { text += (text.empty() ? "" : " ") + setting; };
  if (c.f_number) add(fmt::format("f/{}", *c.f_number));
  if (c.t_stop) add(fmt::format("T{}", *c.t_stop));
  if (c.shutter_s) add(shutter_text(*c.shutter_s));
  if (c.shutter_angle_rad) add(fmt::format("{} rad @", *c.shutter_angle_rad));
  if (c.frames_per_s) add(fmt::format("{} fps", *c.frames_per_s));
  if (c.iso) add(fmt::format("ISO {}", *c.iso));
  if (c.nd_density != 0 || text.empty()) add(fmt::format("ND {}", c.nd_density));
  if (c.compensation_stop != 0) add(fmt::format("{:+} stop", c.compensation_stop));
  return text;
}

}  // namespace etendue
