#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include <talus/cli/draw/page.hpp>
#include <talus/cli/draw/plot.hpp>
#include <talus/terramech/io/csv_reader.hpp>

namespace talus::cli {

namespace {

using Json = nlohmann::ordered_json;

// Six significant digits; null for NaN and infinity.
Json sixDigits(double value) {
  return std::isfinite(value) ? Json(std::stod(fmt::format("{:.6g}", value))) : Json();
}

Json axisJson(const Axis& axis) {
  Json json{{"label", axis.label}, {"log", axis.logarithmic}};
  if (axis.low) json["low"] = *axis.low;
  if (axis.high) json["high"] = *axis.high;
  return json;
}

// Returns the index of a value among kSquares equal parts of the range of the finite values.
auto squaresOf(const std::vector<double>& values) {
  constexpr double kSquares = 180.0;
  double low = INFINITY, high = -INFINITY;
  for (const double v : values)
    if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
  return [low, side = (high - low) / kSquares](double v) { return std::floor((v - low) / side); };
}

// Of a cloud of points, one point in each square is kept.
Json valuesJson(const Series& s) {
  if (s.x.size() != s.y.size())
    throw std::invalid_argument(fmt::format("series '{}': x and y have {} and {} values, must be as many",
                                            s.name, s.x.size(), s.y.size()));
  const auto column = squaresOf(s.x), row = squaresOf(s.y);
  Json json = Json::array();
  std::set<std::pair<double, double>> taken;
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    const bool point = s.mark == Series::Mark::Points;
    if (point && !std::isfinite(s.x[i] + s.y[i])) continue;
    if (point && s.x.size() > 400 && !taken.emplace(column(s.x[i]), row(s.y[i])).second) continue;
    json.push_back({sixDigits(s.x[i]), sixDigits(s.y[i])});
  }
  return json;
}

Json chartJson(const Plot& plot) {
  Json series = Json::array();
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    const Series& s = plot.series[i];
    series.push_back({{"name", s.name},
                      {"colour", hex(s.colour.value_or(seriesColour(i)))},
                      {"points", s.mark == Series::Mark::Points},
                      {"dashed", s.dashed},
                      {"values", valuesJson(s)}});
  }
  return {{"title", plot.title}, {"x", axisJson(plot.x)}, {"y", axisJson(plot.y)}, {"series", series}};
}

bool isNumber(const std::string& text) {
  char* end = nullptr;
  std::strtod(text.c_str(), &end);
  return end != text.c_str() && (*end == '\0' || *end == ' ' || *end == '%');
}

}  // namespace

std::string tableText(const Table& table) {
  std::string text;
  std::vector<std::size_t> widths(table.front().size());
  for (const auto& row : table)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  for (const auto& row : table) {
    for (std::size_t i = 0; i < row.size(); ++i)
      text += fmt::format(fmt::runtime(isNumber(table.back()[i]) ? "{:>{}}{}" : "{:<{}}{}"), row[i],
                          widths[i], i + 1 < row.size() ? "  " : "");
    text.erase(text.find_last_not_of(' ') + 1);
    text += '\n';
  }
  return text;
}

std::string csvText(const Table& table) {
  std::string text;
  for (const auto& row : table) {
    std::string line;
    for (const std::string& cell : row) line += ',' + terramech::csvField(cell);
    text += line.substr(1) + '\n';
  }
  return text;
}

void Report::heading(const std::string& text) {
  text_ += "\n" + text + "\n";
  body_ += fmt::format("<h2>{}</h2>\n", escaped(text));
}

void Report::paragraph(const std::string& text) {
  text_ += text + "\n";
  body_ += fmt::format("<p>{}</p>\n", escaped(text));
}

void Report::table(const Table& table) {
  text_ += tableText(table);
  body_ += "<div class=\"table\"><table>\n";
  for (const auto& row : table) {
    const bool head = &row == &table.front();
    body_ += "<tr>";
    for (const std::string& cell : row)
      body_ += fmt::format("<{0}{1}>{2}</{0}>", head ? "th" : "td",
                           !head && isNumber(cell) ? " class=\"number\"" : "", escaped(cell));
    body_ += "</tr>\n";
  }
  body_ += "</table></div>\n";
}

void Report::charts(const std::vector<Plot>& plots, const std::string& caption) {
  body_ += "<div class=\"charts\">\n";
  for (const Plot& plot : plots) {
    body_ += fmt::format("<figure class=\"chart\" id=\"chart{}\" aria-label=\"{}\"></figure>\n",
                         charts_.size(), escaped(plot.title));
    charts_.push_back(chartJson(plot));
  }
  body_ += fmt::format("</div>\n<p>{}</p>\n", escaped(caption));
}

std::string Report::html() const {
  return filledPage(reportTemplate(), title_, body_, charts_);
}

}  // namespace talus::cli
