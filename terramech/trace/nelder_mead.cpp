#include <algorithm>
#include <cmath>

#include <talus/terramech/trace/nelder_mead.hpp>

namespace talus::terramech {
namespace {

struct Vertex {
  std::vector<double> x;
  double value;
};

std::vector<double> along(const std::vector<double>& from, const std::vector<double>& to, double t) {
  std::vector<double> x(from.size());
  for (std::size_t k = 0; k < x.size(); ++k) x[k] = from[k] + t * (to[k] - from[k]);
  return x;
}

}  // namespace

std::vector<double> nelderMead(const std::function<double(const std::vector<double>&)>& cost,
                               const std::vector<double>& start, const NelderMeadOptions& options) {
  const std::size_t n = start.size();
  std::vector<Vertex> simplex{{start, cost(start)}};
  for (std::size_t k = 0; k < n; ++k) {
    auto x = start;
    x[k] += options.step;
    simplex.push_back({x, cost(x)});
  }
  int left = options.evaluations - static_cast<int>(n) - 1;
  const auto lower = [](const Vertex& a, const Vertex& b) { return a.value < b.value; };
  while (left > 0) {
    std::sort(simplex.begin(), simplex.end(), lower);
    if (simplex.back().value - simplex.front().value < options.tolerance) break;
    std::vector<double> centre(n, 0.0);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = 0; k < n; ++k) centre[k] += simplex[i].x[k] / static_cast<double>(n);
    Vertex& worst = simplex.back();
    const auto attempt = [&](double t) {
      auto x = along(centre, worst.x, t);
      const double v = cost(x);
      --left;
      return Vertex{std::move(x), v};
    };
    Vertex next = attempt(-1.0);
    if (next.value < simplex.front().value) {
      Vertex further = attempt(-2.0);
      worst = further.value < next.value ? std::move(further) : std::move(next);
    } else if (next.value < simplex[n - 1].value) {
      worst = std::move(next);
    } else {
      Vertex nearer = attempt(next.value < worst.value ? -0.5 : 0.5);
      if (nearer.value < std::min(worst.value, next.value)) {
        worst = std::move(nearer);
      } else {
        for (std::size_t i = 1; i <= n; ++i) {
          simplex[i].x = along(simplex[0].x, simplex[i].x, 0.5);
          simplex[i].value = cost(simplex[i].x);
          --left;
        }
      }
    }
  }
  return std::min_element(simplex.begin(), simplex.end(), lower)->x;
}

}  // namespace talus::terramech
