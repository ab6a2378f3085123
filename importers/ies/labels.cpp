// The part before the numbers: version, keywords, TILT.
#include <fmt/format.h>

#include <algorithm>

#include "reader.h"

namespace etendue::ies {
namespace {

using photometric::squeezed;
using photometric::to_utf8;
using photometric::trimmed;

struct Tag {
  std::string_view squeezed;
  IesVersion version;
};
// As the standards write them, then as files do. IESNA94 is a draft of 1995.
constexpr Tag tags[] = {
    {"IESNA91", IesVersion::lm_63_1991},        {"IESNA:LM-63-1995", IesVersion::lm_63_1995}, {"IESNA:LM-63-2002", IesVersion::lm_63_2002},
    {"IES:LM-63-2019", IesVersion::lm_63_2019}, {"IESNA:LM-63-2019", IesVersion::lm_63_2019}, {"IES:LM-63-2002", IesVersion::lm_63_2002},
    {"IES:LM-63-1995", IesVersion::lm_63_1995}, {"IESNA:LM-63-1991", IesVersion::lm_63_1991}, {"IESNA:LM-63-1986", IesVersion::lm_63_1986},
    {"IESNA:LM-63-02", IesVersion::lm_63_2002}, {"IESNA:LM-63-95", IesVersion::lm_63_1995},   {"IESNA:LM-63-91", IesVersion::lm_63_1991},
    {"IESNA:LM-63-86", IesVersion::lm_63_1986}, {"IESNALM-63-2002", IesVersion::lm_63_2002},  {"IESNALM-63-1995", IesVersion::lm_63_1995},
    {"IESNA2002", IesVersion::lm_63_2002},      {"IESNA95", IesVersion::lm_63_1995},          {"IESNA94", IesVersion::lm_63_1995},
    {"IESNA86", IesVersion::lm_63_1986},        {"IESNA:", IesVersion::lm_63_1995},
};
constexpr std::size_t standard_tags = 4;

constexpr std::size_t most_label_lines = 4096;

// What ends a text on DOS counts as a blank here, as it does where a label is written.
std::string_view without_blanks(std::string_view text) {
  const auto blank = [](char c) { return photometric::is_blank(c) || photometric::is_eol(c) || c == '\x1a'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

// "TILT", blanks, "=": the value behind it.
std::optional<std::string_view> tilt_value(std::string_view line) {
  std::string_view rest = without_blanks(line);
  constexpr std::string_view word = "TILT";
  if (rest.size() <= word.size() || rest.front() == '[') return {};
  for (std::size_t i = 0; i < word.size(); ++i)
    if ((rest[i] & ~0x20) != word[i]) return {};
  rest = without_blanks(rest.substr(word.size()));
  if (!rest.starts_with('=')) return {};
  return without_blanks(rest.substr(1));
}

}  // namespace

bool Reader::read_version(IesRecord& record) {
  const char* p = text_.data();
  const std::string_view line = photometric::take_line(p, numbers_.end());
  const std::size_t bracket = std::min(line.find('['), line.size());
  const std::string_view written = line.substr(0, bracket);
  std::string tag = squeezed(written);
  while (tag.starts_with(photometric::byte_order_mark))
    tag.erase(0, photometric::byte_order_mark.size());  // behind blanks, or a second one
  if (!tag.starts_with("IESNA") && !tag.starts_with("IES:")) {
    record.version = IesVersion::lm_63_1986;
    return true;
  }
  numbers_.move_to(p);
  const auto known = std::find_if(std::begin(tags), std::end(tags), [&](const Tag& t) { return tag == t.squeezed; });
  if (known == std::end(tags)) {
    record.version = IesVersion::lm_63_2002;
    if (!repair("VERSION_UNKNOWN",
                fmt::format("expected a version of LM-63, found \"{}\"; read as LM-63-2002", to_utf8(trimmed(written).substr(0, 60))),
                line.data(), "known: IESNA91, IESNA:LM-63-1995, IESNA:LM-63-2002, IES:LM-63-2019"))
      return false;
  } else {
    record.version = known->version;
    if ((known - std::begin(tags) >= static_cast<std::ptrdiff_t>(standard_tags) || written != known->squeezed) &&
        !repair("VERSION_TAG_VARIANT",
                fmt::format("\"{}\" is no version line as the standard writes it; read as LM-63-{}",
                            to_utf8(trimmed(written).substr(0, 60)), name_of(record.version)),
                line.data()))
      return false;
  }
  if (bracket == line.size()) return true;
  return repair("VERSION_SHARES_LINE", "expected the first keyword on a line of its own", line.data() + bracket) &&
         read_label(record, line.substr(bracket));
}

bool Reader::read_label(IesRecord& record, std::string_view line) {
  const std::string_view label = trimmed(line);
  if (label.starts_with('[')) {
    const std::size_t close = label.find(']');
    // Without a name the brackets are text: "[]TILT=NONE" must not come back as the line that ends the header.
    if (close != std::string_view::npos && !trimmed(label.substr(1, close - 1)).empty()) {
      record.keywords.push_back({to_utf8(trimmed(label.substr(1, close - 1))), to_utf8(trimmed(label.substr(close + 1)))});
      return true;
    }
  }
  if (record.version != IesVersion::lm_63_1986) {
    if (label.empty()) return true;
    if (!repair("LABEL_WITHOUT_KEYWORD", "expected [KEYWORD] text before TILT; kept as free text", label.data())) return false;
  }
  record.keywords.push_back({"", to_utf8(label)});
  return true;
}

bool Reader::read_labels(IesRecord& record, std::string_view& tilt) {
  const char* p = numbers_.position();
  const char* too_long = nullptr;
  constexpr std::size_t usual = 16;
  record.keywords.reserve(usual);
  for (std::size_t lines = 0; p != numbers_.end(); ++lines) {
    const std::string_view line = photometric::take_line(p, numbers_.end());
    if (const auto value = tilt_value(line)) {
      tilt = *value;
      numbers_.move_to(p);
      if (too_long != nullptr) reporter_.note("LABEL_TOO_LONG", "label lines are longer than the 80 characters of this version", too_long);
      const bool exact = line == "TILT=NONE" || line == "TILT=INCLUDE" || (line.starts_with("TILT=") && line.size() == 5 + tilt.size());
      return exact ||
             repair("TILT_SPELLING",
                    fmt::format("expected TILT=NONE, TILT=INCLUDE or TILT=<file>, found \"{}\"", to_utf8(trimmed(line).substr(0, 60))),
                    line.data());
    }
    if (lines == most_label_lines)
      return fail("HEADER_TOO_LONG", fmt::format("expected TILT= within {} lines", most_label_lines), line.data(),
                  "this may be no LM-63 file");
    if (record.version <= IesVersion::lm_63_1995 && line.size() > 80 && too_long == nullptr) too_long = line.data();
    if (!read_label(record, line)) return false;
  }
  return fail("TILT_MISSING", "expected a line that begins with TILT=, found the end of the file", p,
              "every LM-63 file has one; this may be another format, or damaged");
}

bool Reader::require_keywords(const IesRecord& record) {
  const auto has = [&](std::string_view name) {
    return std::any_of(record.keywords.begin(), record.keywords.end(), [&](const Keyword& k) { return k.name == name; });
  };
  if (record.version == IesVersion::lm_63_1986) {
    if (std::all_of(record.keywords.begin(), record.keywords.end(), [](const Keyword& k) { return k.name.empty(); })) return true;
    return repair("VERSION_MISSING", "keywords without a version line; read as LM-63-1986, whose ballast-lamp factor multiplies",
                  text_.data());
  }
  std::string missing;
  const bool four = record.version >= IesVersion::lm_63_2002;
  for (const std::string_view name : {"TEST", "MANUFAC", "TESTLAB", "ISSUEDATE"}) {
    const bool required = record.version == IesVersion::lm_63_1991 ? name == "TEST" || name == "MANUFAC" : four;
    if (required && !has(name)) missing += fmt::format("{}[{}]", missing.empty() ? "" : " ", name);
  }
  return missing.empty() || repair("KEYWORD_MISSING", fmt::format("this version requires {}", missing), text_.data());
}

bool Reader::read_tilt(IesRecord& record, std::string_view value) {
  const std::string word = squeezed(value);
  if (word == "NONE") return true;
  if (value.empty())
    return fail("TILT_MISSING", "expected NONE, INCLUDE or a file behind TILT=, found nothing", value.data(),
                "write TILT=NONE if there is no tilt");
  // Written with a blank in its place the name would be another one, or a word with a meaning.
  if (value.find('\x1a') != std::string_view::npos)
    return fail("TILT_MISSING", "expected NONE, INCLUDE or a file behind TILT=, found a name with a control character", value.data(),
                "write TILT=NONE if there is no tilt");
  record.tilt.emplace();
  if (word == "INCLUDE") return read_tilt_records(numbers_, reporter_, *record.tilt);
  record.tilt->file = to_utf8(value);
  return read_tilt_file(*record.tilt, value);
}

bool Reader::read_tilt_records(photometric::NumberReader& numbers, const photometric::Reporter& reporter, LampTilt& tilt) {
  double geometry = 0, count = 0;
  if (!numbers.read(geometry)) return fail(numbers.failure(reporter, "the lamp's geometry (1, 2 or 3)"));
  if (!(geometry == 1 || geometry == 2 || geometry == 3))
    return fail(reporter.error("TILT_GEOMETRY", fmt::format("expected a lamp-to-luminaire geometry of 1, 2 or 3, found {}", geometry),
                               numbers.token(), "1: vertical lamp, 2: horizontal and stays so, 3: horizontal and tilts"));
  if (!numbers.read(count)) return fail(numbers.failure(reporter, "the number of tilt angles"));
  // An angle and its factor take two characters each at least; nothing need follow the last.
  const std::size_t most = numbers.bytes_left() / 4 + 1;
  if (!(count >= 1 && count <= static_cast<double>(most)) || count != static_cast<double>(static_cast<std::size_t>(count)))
    return fail(reporter.error("COUNT_INVALID", fmt::format("expected a number of tilt angles that the file can hold, found {}", count),
                               numbers.token(), "count the angles"));
  tilt.geometry = static_cast<int>(geometry);
  tilt.angles_deg.resize(static_cast<std::size_t>(count));
  tilt.factors.resize(tilt.angles_deg.size());
  if (!numbers.read(tilt.angles_deg)) return fail(numbers.failure(reporter, fmt::format("{} tilt angles", count)));
  if (std::adjacent_find(tilt.angles_deg.begin(), tilt.angles_deg.end(), [](double a, double b) { return !(a < b); }) !=
      tilt.angles_deg.end())
    return fail(
        reporter.error("ANGLES_NOT_INCREASING", "expected tilt angles that increase", numbers.token(), "sort them, with their factors"));
  if (!numbers.read(tilt.factors)) return fail(numbers.failure(reporter, fmt::format("{} tilt factors", count)));
  return true;
}

// The file's name is data: what it opens is the caller's business.
bool Reader::read_tilt_file(LampTilt& tilt, std::string_view place) {
  tilt.resolved = false;
  const auto unresolved = [&](const std::string& why) {
    return repair("TILT_UNRESOLVED", fmt::format("the tilt file \"{}\" was not read: {}", tilt.file, why), place.data(),
                  "tilt is not applied to the candelas; only their dependence on the mounting is unknown");
  };
  if (!options_.tilt_file) return unresolved("nobody was asked to find it");
  const Result<std::vector<std::byte>> bytes = options_.tilt_file(tilt.file);
  if (!bytes) return unresolved(bytes.error().text);
  std::string storage;
  Diagnostics ignored;
  const Result<std::string_view> text = photometric::decode(*bytes, tilt.file, storage, ignored);
  if (!text) return unresolved(text.error().text);
  const photometric::Reporter reporter(*text, tilt.file, true, ignored);
  photometric::NumberReader numbers(text->data(), text->data() + text->size(), photometric::Comma::separates);
  if (!read_tilt_records(numbers, reporter, tilt)) return false;
  tilt.resolved = true;
  return true;
}

}  // namespace etendue::ies
