#include "photometric_sheet.h"

#include <fmt/format.h>

#include <filesystem>

#include "photometric_diagrams.h"
#include "svg.h"

namespace etendue::cli {
namespace {

constexpr std::string_view page_style = R"(<style>
:root{color-scheme:light dark;--paper:#fff;--ground:#f2f4f6;--ink:#1c2126;--soft:#66707a;--line:#dfe3e7;--accent:#1f5fbf;--warn:#8a5a00;--bad:#b3261e}
@media (prefers-color-scheme:dark){:root{--paper:#15181b;--ground:#0d0f11;--ink:#e8ebee;--soft:#98a3ad;--line:#2c3238;--accent:#6fa8ff;--warn:#e0b252;--bad:#ff8a80}}
*{box-sizing:border-box}
body{margin:0;background:var(--ground);color:var(--ink);font:14px/1.45 system-ui,"Segoe UI","Helvetica Neue",Arial,sans-serif}
header{position:sticky;top:0;z-index:1;display:flex;flex-wrap:wrap;gap:8px 14px;align-items:center;padding:12px 22px;background:var(--paper);border-bottom:1px solid var(--line)}
h1{font-size:18px;font-weight:600;margin:0;margin-right:auto}
header input,header select,header button{font:inherit;color:inherit;background:var(--ground);border:1px solid var(--line);border-radius:7px;padding:5px 10px}
header input{width:220px}header label{color:var(--soft)}
main{display:grid;grid-template-columns:repeat(auto-fill,minmax(330px,1fr));gap:18px;padding:20px 22px;align-items:start}
article{background:var(--paper);border:1px solid var(--line);border-radius:12px;overflow:hidden}
article svg{display:block;width:100%;height:auto}
article h2{font-size:14px;font-weight:600;margin:14px 18px 2px;overflow-wrap:anywhere}
article p{margin:0 18px 10px;color:var(--soft);font-size:12.5px;overflow-wrap:anywhere}
dl{display:grid;grid-template-columns:auto 1fr;gap:2px 14px;margin:0;padding:4px 18px 14px;font-variant-numeric:tabular-nums}
dt{color:var(--soft)}dd{margin:0;text-align:right;overflow-wrap:anywhere}
ul{margin:0;padding:10px 18px 12px 34px;border-top:1px solid var(--line);font-size:12.5px;overflow-wrap:anywhere}
li.warning{color:var(--warn)}li.error{color:var(--bad)}li.note{color:var(--soft)}
code{font:12px ui-monospace,monospace}
@media print{header{position:static}header input,header select,header button,header label{display:none}article{break-inside:avoid}}
</style>
)";

// Sorting moves the cards; a search hides those whose text lacks it.
constexpr std::string_view page_script = R"(<script>
const main=document.querySelector('main'),cards=[...main.children],by=document.getElementById('by'),find=document.getElementById('find'),order=document.getElementById('order');
let down=false;
function arrange(){
  const key=by.value,text=find.value.trim().toLowerCase();
  const value=c=>key==='name'?c.dataset.name.toLowerCase():c.dataset[key]===''?-Infinity:Number(c.dataset[key]);
  cards.sort((a,b)=>{const x=value(a),y=value(b),d=x<y?-1:x>y?1:0;return (down?-d:d)||a.dataset.name.localeCompare(b.dataset.name)});
  let shown=0;
  for(const c of cards){main.append(c);c.hidden=text!==''&&!c.textContent.toLowerCase().includes(text);shown+=!c.hidden}
  document.getElementById('count').textContent=shown+' of '+cards.length;
  order.textContent=down?'\u2193':'\u2191';
}
by.onchange=()=>{down=by.value!=='name';arrange()};find.oninput=arrange;order.onclick=()=>{down=!down;arrange()};arrange();
</script>
)";

std::string data(const char* name, const std::optional<double>& value) {
  return value ? fmt::format(" data-{}=\"{:.6g}\"", name, *value) : fmt::format(" data-{}=\"\"", name);
}

std::string angles(const IntensityWeb& web, double share) {
  const auto one = spread_about_peak(web, PlanePair::c0_180, share), other = spread_about_peak(web, PlanePair::c90_270, share);
  if (!one || !other) return "";
  return fmt::format("{:.1f}\u00B0 \u00D7 {:.1f}\u00B0", one->full_deg, other->full_deg);
}

std::string opening_text(const LuminousOpening& opening, Units units) {
  if (opening.shape == OpeningShape::point) return "point";
  const bool metric = units == Units::metric;
  const double unit = metric ? 0.001 : 0.3048;
  std::string name(name_of(opening.shape));
  for (char& c : name) c = c == '_' ? ' ' : c;
  return fmt::format("{}, {:.4g} \u00D7 {:.4g} \u00D7 {:.4g} {}", name, opening.width_m / unit, opening.length_m / unit,
                     opening.height_m / unit, metric ? "mm" : "ft");
}

}  // namespace

std::string luminaire_card(const PhotometricReading& r, Units units) {
  const std::string name = std::filesystem::path(r.file).filename().string();
  const std::size_t faults = r.error ? 1000 : r.diagnostics.all().size();
  std::string messages;
  const auto message = [&](const Diagnostic& d) {
    const char* const kind = d.severity == Severity::error ? "error" : d.severity == Severity::warning ? "warning" : "note";
    messages += fmt::format("<li class=\"{}\">{} <code>{}</code></li>\n", kind, xml_escaped(d.text), xml_escaped(d.code));
  };
  if (r.error) {
    message(to_diagnostic(*r.error));
    return fmt::format(
        "<article data-name=\"{0}\" data-faults=\"{1}\"{2}{3}{4}{5}{6}>\n<h2>{0}</h2>\n<p>not read</p>\n<ul>\n{7}</ul>\n</article>\n",
        xml_escaped(name), faults, data("flux", {}), data("peak", {}), data("efficacy", {}), data("beam", {}), data("watts", {}), messages);
  }
  for (const Diagnostic& d : r.diagnostics.all()) message(d);
  const IntensityDistribution& d = r.distribution;
  const LightOutput output = light_output(d, r.web);
  const auto beam = spread_about_peak(r.web, PlanePair::c0_180, beam_share);
  const double watts = input_watts(d);
  std::string rows;
  const auto row = [&](const char* what, const std::string& value) {
    if (!value.empty()) rows += fmt::format("<dt>{}</dt><dd>{}</dd>\n", what, xml_escaped(value));
  };
  row("flux", fmt::format("{:.5g} lm", output.flux_lm));
  if (output.lor) row("of the lamps", fmt::format("{:.1f} %", 100 * *output.lor));
  if (watts > 0) row("power", fmt::format("{:.4g} W", watts));
  if (output.efficacy_lm_w) row("efficacy", fmt::format("{:.4g} lm/W", *output.efficacy_lm_w));
  row("peak", fmt::format("{:.5g} cd", r.web.max_cd()));
  row("beam", angles(r.web, beam_share));
  row("field", angles(r.web, field_share));
  row("downwards", fmt::format("{:.1f} %", 100 * output.downward_share));
  row("opening", opening_text(opening_of(d), units));
  const auto* const ies = std::get_if<IesRecord>(&d.record);
  row("file", fmt::format("{}, type {}, {} \u00D7 {} angles", ies != nullptr ? fmt::format("LM-63-{}", name_of(ies->version)) : "EULUMDAT",
                          name_of(d.grid.type), d.grid.horizontal_deg.size(), d.grid.vertical_deg.size()));
  const std::string luminaire = keyword_of(d, "LUMINAIRE"), maker = keyword_of(d, "MANUFAC"), catalogue = keyword_of(d, "LUMCAT");
  std::string about = maker;
  for (const std::string& part : {catalogue, luminaire.empty() ? std::string() : name})
    if (!part.empty()) about += (about.empty() ? "" : " \u00B7 ") + part;
  const DrawnWeb drawn{&r.web, name};
  return fmt::format("<article data-name=\"{}\" data-faults=\"{}\"{}{}{}{}{}>\n", xml_escaped(luminaire.empty() ? name : luminaire), faults,
                     data("flux", output.flux_lm), data("peak", r.web.max_cd()), data("efficacy", output.efficacy_lm_w),
                     data("beam", beam ? std::optional<double>(beam->full_deg) : std::nullopt),
                     data("watts", watts > 0 ? std::optional<double>(watts) : std::nullopt)) +
         fmt::format("<h2>{}</h2>\n<p>{}</p>\n", xml_escaped(shortened(luminaire.empty() ? name : luminaire, 90)),
                     xml_escaped(shortened(about, 120))) +
         polar_figure(r.web) + "<dl>\n" + rows + "</dl>\n" + (messages.empty() ? "" : "<ul>\n" + messages + "</ul>\n") + "</article>\n";
}

std::string luminaire_page(const std::vector<std::string>& cards, const std::string& title) {
  std::string page = fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width=device-width\">\n"
      "<title>{0}</title>\n{1}{2}<header><h1>{0}</h1><label id=\"count\"></label>",
      xml_escaped(title), page_style, svg_style());
  page += "<input id=\"find\" type=\"search\" placeholder=\"find\" aria-label=\"find\"><label>sort <select id=\"by\">";
  for (const auto& [key, name] : {std::pair{"name", "name"},
                                  {"flux", "flux"},
                                  {"efficacy", "efficacy"},
                                  {"peak", "peak"},
                                  {"beam", "beam angle"},
                                  {"watts", "power"},
                                  {"faults", "messages"}})
    page += fmt::format("<option value=\"{}\">{}</option>", key, name);
  page += "</select></label><button id=\"order\" aria-label=\"turn the order round\">\u2191</button></header>\n<main>\n";
  for (const std::string& card : cards) page += card;
  return page + "</main>\n" + std::string(page_script) + "</html>\n";
}

}  // namespace etendue::cli
