// Fills the page (page/report.html, report.css and the scripts, embedded at build time) with one validation.
#include "etendue/report.h"

#include "markup.h"
#include "pictures.h"
#include "tables.h"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace etendue {
namespace embedded {
extern const unsigned char report_page[], report_style[], report_script[];
extern const unsigned report_page_size, report_style_size, report_script_size;
}  // namespace embedded

namespace {

std::string_view text_of(const unsigned char* bytes, unsigned size) { return {reinterpret_cast<const char*>(bytes), size}; }

// Replaces each {{name}} of the page, in one pass, so that nothing inserted is looked at again.
std::string filled(std::string_view page, const std::vector<std::pair<std::string_view, std::string>>& parts) {
  std::string result;
  for (std::size_t at = 0; at < page.size();) {
    const std::size_t open = page.find("{{", at);
    const std::size_t close = open == std::string_view::npos ? open : page.find("}}", open);
    if (close == std::string_view::npos) {
      result += page.substr(at);
      break;
    }
    result += page.substr(at, open - at);
    const std::string_view name = page.substr(open + 2, close - open - 2);
    for (const auto& [key, text] : parts) {
      if (key == name) result += text;
    }
    at = close + 2;
  }
  return result;
}

}  // namespace

std::string to_html(const Report& report, const Picture& ours, const Picture& reference) {
  using namespace report_detail;
  using namespace embedded;
  return filled(text_of(report_page, report_page_size), {{"title", escaped(report.title)},
                                                         {"style", std::string(text_of(report_style, report_style_size))},
                                                         {"verdict", verdict_section(report.comparison, report.lights)},
                                                         {"regions", regions_section(report.comparison)},
                                                         {"lights", lights_section(report.lights)},
                                                         {"losses", losses_section(report.losses)},
                                                         {"diagnostics", diagnostics_section(report.diagnostics)},
                                                         {"facts", facts_section(report.facts, report.comparison)},
                                                         {"data", picture_data(report, ours, reference)},
                                                         {"script", std::string(text_of(report_script, report_script_size))}});
}

}  // namespace etendue
