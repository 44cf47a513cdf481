#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <talus/cli/app/output_file.hpp>
#include <talus/cli/draw/scene.hpp>

#include "thesis_figures.hpp"

namespace talus::reproduce {
namespace {

using namespace cli;

constexpr int kWidth = 520, kHeight = 380;  // of a panel [pixels]

// Range of the finite values with a margin of 4 %, above them of `above`; stated ends have precedence.
Range rangeOf(const Axis& axis, const std::vector<Series>& series, std::vector<double> Series::*values,
              double above = 0.04) {
  Range r{INFINITY, -INFINITY};
  for (const Series& s : series)
    for (const double v : s.*values)
      if (std::isfinite(v)) r = {std::min(r.low, v), std::max(r.high, v)};
  const double span = std::max(r.high - r.low, 1e-5);
  return {axis.low.value_or(r.low - 0.04 * span), axis.high.value_or(r.high + above * span)};
}

class Panel {
 public:
  Panel(Canvas& canvas, const Plot& plot, const Spot& corner)
      : canvas_(canvas),
        plot_(plot),
        frame_{corner.x + 68, corner.y + 54, kWidth - 86, kHeight - 106},
        x_(rangeOf(plot.x, plot.series, &Series::x)),
        y_(rangeOf(plot.y, plot.series, &Series::y, 0.04 + 0.06 * static_cast<double>(plot.series.size()))) {}

  void draw() {
    axis(x_, true);
    axis(y_, false);
    const double middle = frame_.x + frame_.width / 2;
    canvas_.text(plot_.title, {middle, frame_.y - 26}, {.size = 13, .bold = true, .anchor = 0.5});
    canvas_.text(plot_.x.label, {middle, frame_.y + frame_.height + 38}, {.anchor = 0.5});
    canvas_.text(plot_.y.label, {frame_.x - 52, frame_.y - 8});
    outline(canvas_, frame_, {.colour = rgb(0x333333)});
    canvas_.clip(frame_);
    Spot name{frame_.x + frame_.width - 8, frame_.y + 16};
    for (std::size_t i = 0; i < plot_.series.size(); ++i) {
      const Series& s = plot_.series[i];
      const Colour colour = s.colour.value_or(seriesColour(i));
      series(s, colour);
      canvas_.text(s.name, name, {.size = 11, .colour = colour, .bold = true, .anchor = 1.0, .halo = true});
      name.y += s.name.empty() ? 0 : 15;
    }
    canvas_.unclip();
  }

 private:
  Spot spot(double x, double y) const {
    return {frame_.x + (x - x_.low) / (x_.high - x_.low) * frame_.width,
            frame_.y + (y_.high - y) / (y_.high - y_.low) * frame_.height};
  }

  // Lines and labels at multiples of 1, 2 or 5 times a power of ten.
  void axis(Range range, bool across) {
    const double step = roundBelow((range.high - range.low) / 4.0);
    for (double k = std::ceil(range.low / step); k * step <= range.high; ++k) {
      const double at = k * step + 0.0;  // no -0
      const Spot low = across ? spot(at, y_.low) : spot(x_.low, at),
                 high = across ? spot(at, y_.high) : spot(x_.high, at);
      canvas_.line(std::array{low, high}, {.colour = rgb(0xE4E4E4)});
      canvas_.text(fmt::format("{:.4g}", at), across ? Spot{low.x, low.y + 16} : Spot{low.x - 6, low.y + 4},
                   {.size = 11, .anchor = across ? 0.5 : 1.0});
    }
  }

  // A line between consecutive interruptions, or a disc for each point.
  void series(const Series& s, Colour colour) {
    std::vector<Spot> run;
    for (std::size_t i = 0; i <= s.x.size(); ++i) {
      const bool known = i < s.x.size() && std::isfinite(s.x[i]) && std::isfinite(s.y[i]);
      if (known) run.push_back(spot(s.x[i], s.y[i]));
      if (known && s.mark == Series::Mark::Points)
        canvas_.disc(run.back(), s.x.size() > 400 ? 1.3 : 2.8, colour);
      if (known) continue;
      if (run.size() > 1 && s.mark == Series::Mark::Line)
        canvas_.line(run, {.colour = colour, .width = s.dashed ? 0.9 : 1.8});
      run.clear();
    }
  }

  Canvas& canvas_;
  const Plot& plot_;
  Box frame_;
  Range x_, y_;
};

}  // namespace

void saveFigure(const std::filesystem::path& path, const std::vector<Plot>& plots) {
  const int count = static_cast<int>(plots.size());
  Canvas canvas({.width = std::min(count, 2) * kWidth, .height = (count + 1) / 2 * kHeight});
  for (int i = 0; i < count; ++i)
    Panel(canvas, plots[static_cast<std::size_t>(i)], {1.0 * (i % 2) * kWidth, 1.0 * (i / 2) * kHeight})
        .draw();
  writeFile(path, canvas.bytes());
}

}  // namespace talus::reproduce
