#include "units_stream.h"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <cmath>

#include "csv.h"
#include "number_text.h"

namespace etendue::cli {
namespace {

// What is always the same around a number, in one piece.
void append_row(std::string& out, std::string_view before, double value, std::string_view behind) {
  std::array<char, 96> row;
  char* end = std::copy(before.begin(), before.end(), row.data());
  end = fmt::format_to(end, FMT_COMPILE("{}"), value);
  end = std::copy(behind.begin(), behind.end(), end);
  out.append(row.data(), end);
}

// Takes one field off a line: up to a comma, or in quotes, where a doubled quote is one (RFC 4180).
std::string take_field(std::string_view& line) {
  line = trimmed(line);
  std::string field;
  const bool quoted = !line.empty() && line.front() == '"';
  std::size_t at = quoted ? 1 : 0;
  for (; at < line.size() && (quoted || line[at] != ','); ++at) {
    if (quoted && line[at] == '"' && (++at == line.size() || line[at] != '"')) break;
    field += line[at];
  }
  line.remove_prefix(std::min(line.find(',', at), line.size() - 1) + 1);
  return field;
}

// {"value": 1200, "unit": "lm"} in any order, without escapes.
struct Row {
  double value = 0;
  std::string_view unit;
};
class RowScanner {
 public:
  explicit RowScanner(std::string_view text) : rest_(text) {}

  std::optional<Row> row() {
    Row row;
    bool has_value = false, has_unit = false;
    if (!take('{')) return {};
    do {
      const std::optional<std::string_view> key = string();
      if (!key || !take(':')) return {};
      if (*key == "value" && !has_value) {
        skip_blanks();
        // JSON numbers start with a digit or a minus.
        if (rest_.empty() || rest_.front() == '+' || rest_.front() == '.' || take_decimal(rest_, row.value) != nullptr) return {};
        has_value = true;
      } else if (*key == "unit" && !has_unit) {
        const std::optional<std::string_view> unit = string();
        if (!unit) return {};
        row.unit = *unit;
        has_unit = true;
      } else {
        return {};
      }
    } while (take(','));
    return take('}') && rest_.empty() && has_value && has_unit ? std::optional(row) : std::nullopt;
  }

 private:
  void skip_blanks() {
    while (!rest_.empty() && (rest_.front() == ' ' || rest_.front() == '\t')) rest_.remove_prefix(1);
  }
  bool take(char c) {
    skip_blanks();
    if (rest_.empty() || rest_.front() != c) return false;
    rest_.remove_prefix(1);
    return true;
  }
  std::optional<std::string_view> string() {
    if (!take('"')) return {};
    const std::size_t end = rest_.find_first_of("\"\\");
    if (end == std::string_view::npos || rest_[end] != '"') return {};
    const std::string_view text = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    return text;
  }
  std::string_view rest_;
};

std::string text_of(const Answer& a) {
  return a.value.size() == 1 ? fmt::format("{}", a.value[0]) : fmt::format("{}", fmt::join(a.value, " "));
}

}  // namespace

RowConverter::RowConverter(Target target, LightSetup setup, const UnitsOptions& options)
    : target_(std::move(target)),
      setup_(std::move(setup)),
      options_(options),
      csv_tail_(',' + target_.name + ",\n"),
      json_tail_(",\"unit\":\"" + target_.name + "\"}\n") {}

const Conversion* RowConverter::conversion_from(std::string_view spelling) {
  if (spelling == last_spelling_) return last_;
  const NamedUnit* const unit = find_unit(spelling);
  last_spelling_ = spelling;
  last_ = nullptr;
  if (unit == nullptr || target_.kind != Target::Kind::unit) return last_;
  auto [entry, is_new] = conversions_.try_emplace(unit);
  if (is_new)
    if (const Result<Conversion> made = Conversion::between(*unit, target_.unit, setup_)) entry->second = *made;
  if (entry->second) last_ = &*entry->second;
  return last_;
}

std::optional<double> RowConverter::quickly(double value, std::string_view spelling) {
  const Conversion* const conversion = conversion_from(spelling);
  if (conversion == nullptr) return {};
  const Result<double> result = (*conversion)(value);
  return result ? std::optional(*result) : std::nullopt;
}

Result<Answer> RowConverter::slowly(std::string_view text, Diagnostics& told) const {
  const Result<Written> written = read_quantity(text, options_, told);
  if (!written) return written.error();
  return answer(*written, target_, setup_, options_);
}

void RowConverter::csv(std::string_view line, std::string& out) {
  line = trimmed(line);
  if (line.empty()) return;
  ++rows;
  double value = 0;
  std::string_view rest = line;
  if (take_decimal(rest, value) == nullptr && (rest = trimmed(rest), !rest.empty() && rest.front() == ',')) {
    if (const std::optional<double> result = quickly(value, trimmed(rest.substr(1)))) {
      append_row(out, "", *result, csv_tail_);
      return;
    }
  }
  std::string text = take_field(line);
  while (!line.empty()) text += " " + take_field(line);
  Diagnostics told;
  const Result<Answer> found = slowly(text, told);
  if (found) {
    append_field(out, text_of(*found));
    out += ',' + found->unit + ',';
    for (const Diagnostic& d : told.all()) append_field(out, d.code + ": " + d.text);
    out += '\n';
    return;
  }
  ++refused;
  out += ',' + target_.name + ',';
  append_field(out, found.error().code + ": " + found.error().text);
  out += '\n';
}

void RowConverter::json(std::string_view line, std::string& out) {
  line = trimmed(line);
  if (line.empty()) return;
  ++rows;
  if (const std::optional<Row> row = RowScanner(line).row()) {
    if (const std::optional<double> result = quickly(row->value, row->unit)) {
      append_row(out, "{\"value\":", *result, json_tail_);
      return;
    }
  }
  Diagnostics told;
  const Json read = Json::parse(line, nullptr, false);
  Result<Answer> found =
      Error{"JSON_INVALID", fmt::format("expected {{\"value\": 1200, \"unit\": \"lm\"}} or \"1200 lm\", found {}", line), {}, {}, {}};
  if (read.is_string())
    found = slowly(read.get_ref<const std::string&>(), told);
  else if (read.is_object() && read.size() == 2 && read.contains("value") && read["value"].is_number() && read.contains("unit") &&
           read["unit"].is_string())
    found = slowly(fmt::format("{} {}", read["value"].get<double>(), read["unit"].get_ref<const std::string&>()), told);
  Json written;
  if (found) {
    written = {{"value", found->value.size() == 1 ? Json(found->value[0]) : Json(found->value)}, {"unit", found->unit}};
    if (!told.all().empty()) written["clamped"] = true;
  } else {
    ++refused;
    written = {{"error", {{"code", found.error().code}, {"text", found.error().text}}}};
  }
  out += written.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n';
}

Status convert_rows(RowConverter& rows, bool json_lines, std::FILE* in, std::FILE* out) {
  constexpr std::size_t block = std::size_t{1} << 20;
  std::string buffer(block, '\0'), written;
  written.reserve(4 * block);
  std::size_t held = 0;  // bytes of an unfinished line
  bool first = !json_lines;
  if (first) written += "value,unit,error\n";
  const auto take_line = [&](std::string_view line) {
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    const bool heading = first && line == "value,unit";
    first = false;
    if (heading) return;
    json_lines ? rows.json(line, written) : rows.csv(line, written);
  };
  while (true) {
    if (held == block) return Error{"LINE_TOO_LONG", fmt::format("expected lines shorter than {} bytes", block), {}, {}, {}};
    if (interrupted()) return Error{"CANCELLED", "stopped", {}, {}, {}};
    const std::size_t got = std::fread(buffer.data() + held, 1, block - held, in);
    if (got == 0 && std::ferror(in) != 0) return Error{"FILE_UNREADABLE", "the input cannot be read", {}, {}, {}};
    std::string_view text(buffer.data(), held + got);
    for (std::size_t end = text.find('\n'); end != std::string_view::npos; end = text.find('\n')) {
      take_line(text.substr(0, end));
      text.remove_prefix(end + 1);
    }
    if (got == 0 && !text.empty()) take_line(text);
    if (std::fwrite(written.data(), 1, written.size(), out) != written.size() || std::fflush(out) != 0)
      return Error{"FILE_UNWRITABLE", "the output cannot be written", {}, {}, {}};
    written.clear();
    if (got == 0) return Done{};
    held = text.size();
    std::copy(text.begin(), text.end(), buffer.begin());
  }
}

}  // namespace etendue::cli
