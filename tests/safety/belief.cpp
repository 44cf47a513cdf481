#include "belief.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace safety {
namespace {

constexpr double kFloor = 0.022;
constexpr std::size_t kPlacesToRise = 3;

double rho(Place a, Place b) {
  const double d = std::hypot(a.x_m - b.x_m, a.y_m - b.y_m) / Belief::kRange_m;
  if (d >= 1.0) return 0.0;
  const double turn = 2.0 * std::numbers::pi * d;
  return (2.0 + std::cos(turn)) / 3.0 * (1.0 - d) + std::sin(turn) / (2.0 * std::numbers::pi);
}

// DP/W of a wheel by thesis Eq. 3.12 from its torque and sinkage. NaN if torque or sinkage is missing.
double pullBySinkage(const JournalRow& row, const Rover& rover) {
  const double depth = row.sinkage_m / rover.wheel_radius_m;
  if (!(depth > 0.0 && depth < 1.0)) return std::nan("");
  const double entry = std::acos(1.0 - depth), quarter = 0.25 * entry;
  const double sinc = std::sin(quarter) / quarter;
  return -std::tan(0.5 * entry) +
         sinc * sinc / std::cos(0.5 * entry) * row.torque_Nm / (rover.wheel_radius_m * row.load_N);
}

struct Seen {
  const JournalRow* row;
  int class_number;
  double expected;   // DP/N of the class at the row's slip
  double steepness;  // change of `expected` over a slip of 0.03
  double by_sinkage;
};

double carried(double slip, double departure) {
  return std::min(std::abs(slip - PullCurve::kReferenceSlip), 0.25) * (0.06 + 1.2 * std::abs(departure));
}

}  // namespace

Belief::Belief(const Site& site, const std::vector<JournalRow>& rows) {
  for (std::size_t first = 0; first < rows.size();) {
    std::vector<const JournalRow*> together;
    std::size_t i = first;
    while (i < rows.size() && rows[i].source == rows[first].source &&
           (i == first || rows[i].time_s == rows[first].time_s))
      together.push_back(&rows[i++]);
    moment(site, together);
    first = i;
  }
  solve(site);
}

void Belief::moment(const Site& site, const std::vector<const JournalRow*>& rows) {
  std::vector<Seen> seen;
  double load = 0.0, departure = 0.0, felt_load = 0.0, felt = 0.0;
  for (const JournalRow* row : rows) {
    const auto number = site.classAt(row->place);
    if (!number || !(row->load_N > 0.0) || std::isnan(row->slip)) continue;
    const GroundKind& kind = *site.kinds.at(*number);
    const PullCurve& curve = row->pass > 1 ? kind.rut : kind.fresh;
    const Seen s{row, *number, curve.pull(row->slip),
                 0.5 * (curve.pull(row->slip + 0.03) - curve.pull(row->slip - 0.03)),
                 pullBySinkage(*row, site.rover)};
    seen.push_back(s);
    load += row->load_N;
    departure += row->load_N * (row->gradient - s.expected);
    if (std::isnan(s.by_sinkage)) continue;
    felt_load += row->load_N;
    felt += row->load_N * (s.by_sinkage - s.expected);
    if (row->pass <= 1 && row->accepted) {
      Square& square = squareAt(*number, row->place);
      square.depth_ratio +=
          row->sinkage_m / site.rover.wheel_radius_m / std::max(curve.sinkage(row->slip), 1e-3);
      ++square.depths;
    }
  }
  for (const Seen& s : seen) {
    const double own = std::isnan(s.by_sinkage) ? 0.0 : s.by_sinkage - s.expected - felt / felt_load;
    const bool balanced = std::isfinite(departure);
    const double mean = balanced ? departure / load + own : s.by_sinkage - s.expected;
    if (std::isnan(mean) || (!s.row->accepted && mean > 0.0)) continue;
    const double deviation = balanced ? std::hypot(std::hypot(0.01, 0.02, 0.5 * own), s.steepness) : 0.08;
    put(s.class_number, s.row->place, mean, std::hypot(deviation, carried(s.row->slip, mean)));
  }
}

Belief::Square& Belief::squareAt(int class_number, Place p) {
  const int column = static_cast<int>(std::floor(p.x_m / kSquare_m)),
            row = static_cast<int>(std::floor(p.y_m / kSquare_m));
  Square& square = squares_[class_number][{column, row}];
  square.middle = {(column + 0.5) * kSquare_m, (row + 0.5) * kSquare_m};
  return square;
}

void Belief::put(int class_number, Place p, double departure, double deviation) {
  Square& square = squareAt(class_number, p);
  const double weight = 1.0 / (deviation * deviation);
  square.departure += weight * departure;
  square.weight += weight;
}

void Belief::solve(const Site& site) {
  for (const auto& [number, kind] : site.kinds) {
    Process& p = processes_[number];
    p.class_variance = kind->class_deviation * kind->class_deviation;
    p.place_variance = kind->place_deviation * kind->place_deviation;
    for (const auto& [key, square] : squares_[number])
      if (square.weight > 0.0) p.squares.push_back(square);
    const std::size_t n = p.squares.size();
    p.factor.assign(n * n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
      p.squares[i].departure /= p.squares[i].weight;
      for (std::size_t j = 0; j <= i; ++j) {
        double sum = p.class_variance + p.place_variance * rho(p.squares[i].middle, p.squares[j].middle);
        if (i == j) sum += kFloor * kFloor + 1.0 / p.squares[i].weight;
        for (std::size_t k = 0; k < j; ++k) sum -= p.factor[i * n + k] * p.factor[j * n + k];
        p.factor[i * n + j] = i == j ? std::sqrt(sum) : sum / p.factor[j * n + j];
      }
    }
    std::vector<double> y;
    for (const Square& square : p.squares) y.push_back(square.departure);
    p.solved = p.halfSolved(std::move(y));
    for (std::size_t i = n; i-- > 0;) {
      for (std::size_t k = i + 1; k < n; ++k) p.solved[i] -= p.factor[k * n + i] * p.solved[k];
      p.solved[i] /= p.factor[i * n + i];
    }
  }
}

std::vector<double> Belief::Process::halfSolved(std::vector<double> x) const {
  const std::size_t n = x.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) x[i] -= factor[i * n + k] * x[k];
    x[i] /= factor[i * n + i];
  }
  return x;
}

std::vector<double> Belief::Process::towards(Place p) const {
  std::vector<double> k;
  for (const Square& square : squares) k.push_back(class_variance + place_variance * rho(p, square.middle));
  return k;
}

Departure Belief::at(int class_number, Place p) const {
  const Process& process = processes_.at(class_number);
  const double prior = process.class_variance + process.place_variance;
  if (process.squares.empty()) return {0.0, std::sqrt(prior), 0.0};
  const std::vector<double> k = process.towards(p);
  Departure out;
  for (std::size_t i = 0; i < k.size(); ++i) out.mean += k[i] * process.solved[i];
  double explained = 0.0;
  for (const double v : process.halfSolved(k)) explained += v * v;
  out.deviation = std::sqrt(std::max(prior - explained, 0.0));
  out.learned = std::sqrt(std::max(explained, 0.0));
  if (process.squares.size() < kPlacesToRise) out.mean = std::min(out.mean, 0.0);
  return out;
}

std::vector<double> Belief::covariance(int class_number, const std::vector<Place>& at) const {
  const Process& process = processes_.at(class_number);
  std::vector<std::vector<double>> half;
  for (const Place& p : at) half.push_back(process.halfSolved(process.towards(p)));
  const std::size_t n = at.size();
  std::vector<double> out(n * n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      double sum = process.class_variance + process.place_variance * rho(at[i], at[j]);
      for (std::size_t k = 0; k < half[i].size(); ++k) sum -= half[i][k] * half[j][k];
      out[i * n + j] = sum;
    }
  return out;
}

double Belief::deeper(int class_number, Place p) const {
  const auto of_class = squares_.find(class_number);
  if (of_class == squares_.end()) return 1.0;
  const auto square = of_class->second.find(
      {static_cast<int>(std::floor(p.x_m / kSquare_m)), static_cast<int>(std::floor(p.y_m / kSquare_m))});
  const bool known = square != of_class->second.end() && square->second.depths >= 3;
  return known ? square->second.depth_ratio / square->second.depths : 1.0;
}

std::size_t Belief::places(int class_number) const {
  const auto process = processes_.find(class_number);
  return process == processes_.end() ? 0 : process->second.squares.size();
}

}  // namespace safety
