#include <algorithm>
#include <cstdlib>
#include <utility>

#include <fmt/format.h>

#include <talus/cli/draw/html_report.hpp>

namespace talus::cli {
namespace {

constexpr const char* kStyle = R"(
body { font: 15px/1.4 system-ui, sans-serif; color: #222; max-width: 1400px; margin: 0 auto; padding: .6rem .8rem; box-sizing: border-box; }
h1 { font-size: 1.25rem; margin: 0 0 .4rem; overflow-wrap: anywhere; } h2 { font-size: 1.05rem; margin: 1rem 0 .3rem; }
p { margin: .3rem 0; max-width: 60rem; overflow-wrap: anywhere; }
div.charts { display: flex; flex-wrap: wrap; gap: .3rem; margin: .4rem 0; }
div.charts img { flex: 1 1 20rem; min-width: 0; max-width: 30rem; height: auto; }
div.table { overflow-x: auto; }
table { border-collapse: collapse; font-size: .85rem; font-variant-numeric: tabular-nums; }
th, td { padding: .12rem .7rem .12rem 0; border-bottom: 1px solid #ddd; text-align: left; }
td.number { text-align: right; })";

bool isNumber(const std::string& text) {
  char* end = nullptr;
  std::strtod(text.c_str(), &end);
  return end != text.c_str() && (*end == '\0' || *end == ' ' || *end == '%');
}

}  // namespace

std::string escaped(const std::string& text) {
  constexpr std::pair<char, const char*> kEntities[] = {
      {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'\'', "&#39;"}, {'"', "&quot;"}};
  std::string html;
  for (const char c : text) {
    const auto* const entity = std::ranges::find(kEntities, c, &std::pair<char, const char*>::first);
    entity == std::end(kEntities) ? html += c : html += entity->second;
  }
  return html;
}

void HtmlReport::heading(const std::string& text) {
  body_ += fmt::format("<h2>{}</h2>\n", escaped(text));
}

void HtmlReport::paragraph(const std::string& text) {
  body_ += fmt::format("<p>{}</p>\n", escaped(text));
}

void HtmlReport::table(const std::vector<std::string>& header,
                       const std::vector<std::vector<std::string>>& rows) {
  body_ += "<div class=\"table\"><table>\n<tr>";
  for (const std::string& cell : header) body_ += fmt::format("<th>{}</th>", escaped(cell));
  body_ += "</tr>\n";
  for (const auto& row : rows) {
    body_ += "<tr>";
    for (const std::string& cell : row)
      body_ += fmt::format("<td{}>{}</td>", isNumber(cell) ? " class=\"number\"" : "", escaped(cell));
    body_ += "</tr>\n";
  }
  body_ += "</table></div>\n";
}

void HtmlReport::charts(const std::vector<Plot>& plots) {
  body_ += "<div class=\"charts\">\n";
  for (const Plot& plot : plots)
    body_ += fmt::format(
        "<img alt=\"{}\" src=\"data:image/svg+xml;base64,{}\">\n", escaped(plot.title),
        base64(draw({plot}, Canvas::Kind::Svg, {.columns = 1, .panel_width = 400, .panel_height = 270})));
  body_ += "</div>\n";
}

std::string HtmlReport::html() const {
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; style-src "
      "'unsafe-inline'\">\n<title>{0}</title>\n<style>{1}</style>\n<h1>{0}</h1>\n{2}</html>\n",
      escaped(title_), kStyle, body_);
}

}  // namespace talus::cli
