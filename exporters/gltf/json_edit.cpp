#include "json_edit.h"

#include <vector>

namespace etendue::gltf {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }

// Where the parts of a valid text stand.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {}

  std::size_t behind_blanks(std::size_t at) const {
    while (at < text_.size() && is_blank(text_[at])) ++at;
    return at;
  }
  std::size_t behind_string(std::size_t at) const {
    for (++at; text_[at] != '"'; ++at)
      if (text_[at] == '\\') ++at;
    return at + 1;
  }
  std::size_t behind_value(std::size_t at) const {
    if (text_[at] == '"') return behind_string(at);
    if (text_[at] != '{' && text_[at] != '[') return std::min(text_.find_first_of(",]} \n\r\t", at), text_.size());
    for (int depth = 0;;) {
      const char c = text_[at];
      if (c == '"') {
        at = behind_string(at);
        continue;
      }
      depth += c == '{' || c == '[' ? 1 : c == '}' || c == ']' ? -1 : 0;
      ++at;
      if (depth == 0) return at;
    }
  }

 private:
  std::string_view text_;
};

struct Item {
  std::string_view gap;  // the blanks before it
  std::string_view key;  // as it stands, with its quotes and the colon; nothing in an array
  std::string_view value;
};

struct Container {
  std::vector<Item> items;
  std::string_view tail;  // the blanks behind the last one
};

Container taken_apart(std::string_view text) {
  const Scanner scan(text);
  Container out;
  const bool is_object = text.front() == '{';
  std::size_t at = scan.behind_blanks(1), behind = 1;
  while (text[at] != '}' && text[at] != ']') {
    Item item;
    item.gap = text.substr(behind, at - behind);
    if (is_object) {
      const std::size_t value = scan.behind_blanks(scan.behind_blanks(scan.behind_string(at)) + 1);
      item.key = text.substr(at, value - at);
      at = value;
    }
    behind = scan.behind_value(at);
    item.value = text.substr(at, behind - at);
    out.items.push_back(item);
    at = scan.behind_blanks(behind);
    if (text[at] == ',') {
      behind = at + 1;
      at = scan.behind_blanks(behind);
    }
  }
  out.tail = text.substr(behind, text.size() - 1 - behind);
  return out;
}

// In the style of its neighbours: on lines of its own where they are.
std::string dumped(const Json& value, std::string_view gap) {
  const std::size_t line = gap.rfind('\n');
  if (line == std::string_view::npos) return value.dump();
  std::string out;
  for (const char c : value.dump(2)) {
    if (c == '\n')
      out += gap.substr(line);
    else
      out += c;
  }
  return out;
}

// The items of a container that is written again.
class Items {
 public:
  explicit Items(const Container& parts) : parts_(parts), last_gap_(parts.items.back().gap) {}
  void keep(const Item& item, const std::string& value) { add(item.gap, std::string(item.key) + value); }
  void add_new(const std::string& key, const Json& value) { add(last_gap_, key + dumped(value, last_gap_)); }
  std::string text(char open, char close) const { return open + text_ + std::string(parts_.tail) + close; }

 private:
  void add(std::string_view gap, const std::string& item) {
    if (!text_.empty()) text_ += ',';
    text_ += gap;
    text_ += item;
  }
  const Container& parts_;
  std::string_view last_gap_;
  std::string text_;
};

std::string edited_object(std::string_view text, const Json& before, const Json& now) {
  const Container parts = taken_apart(text);
  Items items(parts);
  std::size_t i = 0;
  for (const auto& [name, value] : before.items()) {
    const Item& item = parts.items[i++];
    if (const auto kept = now.find(name); kept != now.end()) items.keep(item, edited(item.value, value, *kept));
  }
  for (const auto& [name, value] : now.items())
    if (!before.contains(name)) items.add_new(Json(name).dump() + ": ", value);
  return items.text('{', '}');
}

std::string edited_array(std::string_view text, const Json& before, const Json& now) {
  const Container parts = taken_apart(text);
  Items items(parts);
  std::size_t old = 0;
  for (const Json& value : now) {
    // In a shorter array some went away: those before the next one that is still there as it was.
    if (now.size() < before.size()) {
      std::size_t same = old;
      while (same < before.size() && !(before[same] == value)) ++same;
      if (same < before.size()) old = same;
    }
    if (old < before.size())
      items.keep(parts.items[old], edited(parts.items[old].value, before[old], value));
    else
      items.add_new("", value);
    ++old;
  }
  return items.text('[', ']');
}

}  // namespace

std::string edited(std::string_view text, const Json& before, const Json& now) {
  if (before == now) return std::string(text);
  const std::size_t begin = Scanner(text).behind_blanks(0), end = Scanner(text).behind_value(begin);
  const std::string_view value = text.substr(begin, end - begin);
  std::string out(text.substr(0, begin));
  if (before.empty() || now.empty() || before.type() != now.type() || !before.is_structured())
    out += now.dump();
  else
    out += before.is_object() ? edited_object(value, before, now) : edited_array(value, before, now);
  return out += text.substr(end);
}

}  // namespace etendue::gltf
