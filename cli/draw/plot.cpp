#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include <talus/cli/app/output_file.hpp>
#include <talus/cli/draw/plot.hpp>
#include <talus/cli/draw/scene.hpp>

namespace talus::cli {

namespace {

constexpr Colour kPlotInk = rgb(0x333333);
constexpr Colour kFaint = rgb(0xE4E4E4);

void check(const Series& s) {
  if (s.x.size() == s.y.size()) return;
  throw std::invalid_argument(fmt::format("series '{}': x and y have {} and {} values, must be as many",
                                          s.name, s.x.size(), s.y.size()));
}

/// Range of the finite values with a margin; fixed ends have precedence.
class Extent {
 public:
  void add(double value) {
    if (!std::isfinite(value)) return;
    range_.low = std::min(range_.low, value);
    range_.high = std::max(range_.high, value);
  }

  Range range(const Axis& axis) const {
    Range r = range_.low <= range_.high ? range_ : Range{0.0, 1.0};
    const double margin = r.high > r.low ? 0.04 * (r.high - r.low) : std::max(0.5, 0.05 * std::abs(r.low));
    r = {axis.low.value_or(r.low - margin), axis.high.value_or(r.high + margin)};
    if (!(r.high > r.low)) r.high = r.low + 1.0;
    return r;
  }

 private:
  Range range_{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
};

/// State of one chart during drawing.
class Panel {
 public:
  Panel(Canvas& canvas, const Plot& plot, const Box& box) : canvas_(canvas), plot_(plot) {
    frame_ = {box.x + 68, box.y + 38, box.width - 68 - 18, box.height - 38 - 52};
    Extent x;
    Extent y;
    for (const Series& s : plot.series) {
      for (std::size_t i = 0; i < s.x.size(); ++i) {
        x.add(s.x[i]);
        y.add(s.y[i]);
      }
    }
    x_ = x.range(plot.x);
    y_ = y.range(plot.y);
    rows_ = std::ranges::count_if(plot.series, [](const Series& s) { return !s.name.empty(); });
    if (rows_ > 0 && !plot.y.high) y_.high += (y_.high - y_.low) / (frame_.height / legendHeight() - 1.0);
  }

  void draw() {
    axes();
    canvas_.clip(frame_);
    for (std::size_t i = 0; i < plot_.series.size(); ++i) series(plot_.series[i], colour(i));
    canvas_.unclip();
    outline(canvas_, frame_, {.colour = kPlotInk});
    legend();
  }

 private:
  Spot spot(double x, double y) const {
    return {frame_.x + (x - x_.low) / (x_.high - x_.low) * frame_.width,
            frame_.y + (y_.high - y) / (y_.high - y_.low) * frame_.height};
  }

  Colour colour(std::size_t i) const { return plot_.series[i].colour.value_or(seriesColour(i)); }

  void axes() {
    const double bottom = frame_.y + frame_.height;
    const std::vector<double> xs = ticks(x_, 6);
    const std::vector<double> ys = ticks(y_, 5);
    const auto step = [](const std::vector<double>& v) { return v.size() > 1 ? v[1] - v[0] : 1.0; };
    for (const double x : xs) {
      canvas_.line(std::array{spot(x, y_.low), spot(x, y_.high)}, {.colour = kFaint});
      canvas_.text(tickLabel(x, step(xs)), {spot(x, 0).x, bottom + 16}, {.size = 11, .anchor = 0.5});
    }
    for (const double y : ys) {
      canvas_.line(std::array{spot(x_.low, y), spot(x_.high, y)}, {.colour = kFaint});
      canvas_.text(tickLabel(y, step(ys)), {frame_.x - 6, spot(0, y).y + 4}, {.size = 11, .anchor = 1.0});
    }
    const double middle = frame_.x + frame_.width / 2;
    canvas_.text(plot_.title, {middle, frame_.y - 14}, {.size = 13, .bold = true, .anchor = 0.5});
    canvas_.text(plot_.x.label, {middle, bottom + 38}, {.anchor = 0.5});
    canvas_.text(plot_.y.label, {frame_.x - 52, frame_.y + frame_.height / 2},
                 {.anchor = 0.5, .upright = true});
  }

  void series(const Series& s, Colour c) {
    if (s.mark == Series::Mark::Line) return runs(s, c);
    std::vector<Spot> spots;
    for (std::size_t i = 0; i < s.x.size(); ++i)
      if (std::isfinite(s.x[i]) && std::isfinite(s.y[i])) spots.push_back(spot(s.x[i], s.y[i]));
    const bool many = spots.size() > 400;
    if (many) leaveOutCovered(spots);
    canvas_.discs(spots, many ? 1.6 : 2.8, faded(c, many ? 0.5 : 0.85));
  }

  /// Keeps one disc per square of two pixels, because all discs of a series are drawn as one shape.
  static void leaveOutCovered(std::vector<Spot>& spots) {
    const auto square = [](const Spot& spot) {
      return std::pair{std::floor(spot.x / 2.0), std::floor(spot.y / 2.0)};
    };
    std::ranges::sort(spots, {}, square);
    spots.erase(std::unique(spots.begin(), spots.end(),
                            [&](const Spot& a, const Spot& b) { return square(a) == square(b); }),
                spots.end());
  }

  /// Draws a line between consecutive interruptions.
  void runs(const Series& s, Colour c) {
    std::vector<Spot> run;
    for (std::size_t i = 0; i <= s.x.size(); ++i) {
      if (i < s.x.size() && std::isfinite(s.x[i]) && std::isfinite(s.y[i])) {
        run.push_back(spot(s.x[i], s.y[i]));
        continue;
      }
      if (run.size() > 1) canvas_.line(run, {.colour = c, .width = 1.8, .dashed = s.dashed});
      run.clear();
    }
  }

  double legendHeight() const { return 17.0 * static_cast<double>(rows_) + 10.0; }

  void legend() {
    if (rows_ == 0) return;
    double width = 0.0;
    for (const Series& s : plot_.series) width = std::max(width, canvas_.textWidth(s.name, {.size = 11}));
    const Box box{frame_.x + frame_.width - width - 50, frame_.y + 4, width + 42, legendHeight()};
    canvas_.fill(box, faded(rgb(0xFFFFFF), 0.85));
    outline(canvas_, box, {.colour = kFaint});
    double y = box.y + 16;
    for (std::size_t i = 0; i < plot_.series.size(); ++i) {
      const Series& s = plot_.series[i];
      if (s.name.empty()) continue;
      if (s.mark == Series::Mark::Line)
        canvas_.line(std::array{Spot{box.x + 8, y - 4}, Spot{box.x + 28, y - 4}},
                     {.colour = colour(i), .width = 1.8, .dashed = s.dashed});
      else
        canvas_.disc({box.x + 18, y - 4}, 3.0, colour(i));
      canvas_.text(s.name, {box.x + 34, y}, {.size = 11});
      y += 17;
    }
  }

  Canvas& canvas_;
  const Plot& plot_;
  Box frame_;
  std::ptrdiff_t rows_ = 0;  // of the legend, which stands above the data
  Range x_;
  Range y_;
};

}  // namespace

std::string draw(const std::vector<Plot>& plots, Canvas::Kind kind, const PlotLayout& layout) {
  for (const Plot& plot : plots)
    for (const Series& s : plot.series) check(s);
  const int count = std::max(1, static_cast<int>(plots.size()));
  const int columns = std::clamp(layout.columns, 1, count);
  const int rows = (count + columns - 1) / columns;
  Canvas canvas({.width = columns * layout.panel_width, .height = rows * layout.panel_height, .kind = kind});
  for (int i = 0; i < static_cast<int>(plots.size()); ++i) {
    const int column = i % columns;
    const int row = i / columns;
    const Box box{static_cast<double>(column * layout.panel_width),
                  static_cast<double>(row * layout.panel_height), static_cast<double>(layout.panel_width),
                  static_cast<double>(layout.panel_height)};
    Panel(canvas, plots[static_cast<std::size_t>(i)], box).draw();
  }
  return canvas.bytes();
}

void save(const std::filesystem::path& path, const std::vector<Plot>& plots, const PlotLayout& layout) {
  writeFile(path, draw(plots, isNamed(path, ".svg") ? Canvas::Kind::Svg : Canvas::Kind::Png, layout));
}

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
