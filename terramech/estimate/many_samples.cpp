#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Cholesky>

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/estimate/many_samples.hpp>
#include <talus/terramech/numerics/normal_distribution.hpp>

namespace talus::terramech {
namespace {

constexpr std::size_t kFirst = 512;    // samples of the first search
constexpr std::size_t kGrowth = 16;    // growth factor of the number of samples per stage
constexpr std::size_t kWeighed = 300;  // up to this number of samples each draw is weighted with all of them
constexpr std::size_t kCurved = 1024;  // samples for the correction of the curvature
constexpr double kHopeless = 25.0;     // log probability below that of the best class at which a class is
                                       // excluded
constexpr double kEnough = 1e-2;       // increase of log probability below which the search ends

// Progress of a search with an unknown number of passes: each pass counts as half of the remaining fraction.
class PassWatch {
 public:
  PassWatch(const ProgressMonitor& outer, double from, double to)
      : outer_(outer), from_(from), left_(to - from) {}

  ProgressMonitor watch() {
    return {.progress = [this](double fraction) { report(fraction); }, .stop = outer_.stop};
  }

 private:
  void report(double fraction) {
    if (fraction < last_) from_ += 0.5 * left_, left_ *= 0.5;
    last_ = fraction;
    outer_.report(from_ + 0.5 * left_ * fraction);
  }

  const ProgressMonitor& outer_;
  double from_, left_, last_ = 0.0;
};

struct Candidate {
  SoilObjective objective;
  SoilQuadratic likelihood = {};  // expanded about the mode
  double log_probability = -std::numeric_limits<double>::infinity();
  bool alive = true;
};

void dropHopeless(std::vector<Candidate>& candidates) {
  const double best = std::ranges::max_element(candidates, {}, &Candidate::log_probability)->log_probability;
  for (Candidate& c : candidates) {
    c.alive = c.alive && c.log_probability > best - kHopeless;
    if (!c.alive) c.log_probability = -std::numeric_limits<double>::infinity();
  }
}

bool bounded(const SoilObjective& objective, int k) {
  return objective.soilClass().parameters[static_cast<std::size_t>(k)].bounded();
}

// Adds the Gaussian priors to the likelihood.
SoilQuadratic withPrior(const SoilObjective& objective, SoilQuadratic q) {
  for (int k = 0; k < kSoilParameters; ++k) {
    if (bounded(objective, k)) continue;
    q.cost += 0.5 * q.at[k] * q.at[k];
    q.gradient[k] += q.at[k];
    q.information(k, k) += 1.0;
  }
  return q;
}

// Returns the minimum of a quadratic in the box of the prior, by coordinate descent.
SoilVector lowest(const SoilObjective& objective, const SoilQuadratic& q) {
  constexpr int kMostSweeps = 10000;
  SoilVector y = q.at;
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    double moved = 0.0;
    for (int k = 0; k < kSoilParameters; ++k) {
      const double slope = q.gradient[k] + q.information.row(k).dot(y - q.at);
      double next = y[k] - slope / q.information(k, k);
      if (bounded(objective, k)) next = std::clamp(next, 0.0, 1.0);
      if (!std::isfinite(next)) continue;  // parameter without influence on any sample
      moved = std::max(moved, std::abs(next - y[k]));
      y[k] = next;
    }
    if (moved < 1e-9) break;
  }
  return y;
}

// Difference between the curvature of the full cost and that of Gauss-Newton, which neglects that the
// covariance of a residual depends on the soil through the errors of z and i. The difference is computed from
// a subset and scaled to all samples.
SoilMatrix curvatureCorrection(const SoilObjective& objective, const SoilVector& y,
                               std::span<const WheelReading> samples) {
  constexpr double kStep = 1e-3;
  const std::vector<WheelReading> part = spreadEvenly(samples, kCurved);
  const auto expansion = [&](const SoilVector& at) { return objective.expandWhole(at, part, {}); };
  SoilMatrix correction = -expansion(y).information;
  for (int k = 0; k < kSoilParameters; ++k) {
    const SoilVector step = kStep * SoilVector::Unit(k);
    const SoilVector column = (expansion(y + step).gradient - expansion(y - step).gradient) / (2.0 * kStep);
    correction.col(k) += 0.5 * column;
    correction.row(k) += 0.5 * column.transpose();
  }
  return static_cast<double>(samples.size()) / static_cast<double>(part.size()) * correction;
}

SoilQuadratic curved(SoilQuadratic q, const SoilMatrix& correction) {
  const SoilMatrix whole = q.information + correction;
  if ((whole + SoilMatrix::Identity()).llt().info() == Eigen::Success) q.information = whole;
  return q;
}

// Finds the most likely soil of a class from `start`, by Newton's method in the box of the prior. In the
// coordinates x of findMode() the correlation of k and n (pressure k z^n) is curved; in y it is straight.
SoilQuadratic descend(const SoilObjective& objective, std::span<const WheelReading> samples,
                      const SoilVector& start) {
  constexpr int kMostPasses = 20;
  const SoilMatrix correction = curvatureCorrection(objective, start, samples);
  SoilQuadratic here = objective.expandWhole(start, samples, {});
  double damping = 0.0;
  for (int pass = 0; pass < kMostPasses; ++pass) {
    SoilQuadratic model = withPrior(objective, curved(here, correction));
    const double cost = model.cost;
    model.information.diagonal() *= 1.0 + damping;
    const SoilVector next = lowest(objective, model);
    if (cost - model.costAt(next) < kEnough) break;
    const SoilQuadratic there = objective.expandWhole(next, samples, {});
    const double gain = cost - withPrior(objective, there).cost;
    damping = gain > 0.0 ? 0.1 * damping : std::max(0.1, 10.0 * damping);
    if (gain > 0.0) here = there;
  }
  return here;
}

// Returns the mean of the truncated Gaussian approximation of a class' posterior. If the bounds of the class
// truncate the likelihood, the mean is far from the mode.
SoilVector middle(const SoilObjective& objective, const SoilQuadratic& likelihood) {
  constexpr int kDraws = 64;
  const TruncatedGaussian allowed = proposal(objective.soilClass(), likelihood);
  const Eigen::MatrixXd points = evenPoints(kSoilParameters, kDraws);
  SoilVector sum = SoilVector::Zero();
  for (Eigen::Index k = 0; k < kDraws; ++k) sum += allowed.draw(points.col(k)).at;
  return sum / kDraws;
}

double logEvidence(const SoilObjective& objective, const SoilQuadratic& likelihood) {
  SoilQuadratic q = withPrior(objective, likelihood);
  q.information += SoilMatrix::Identity();
  return -q.cost - q.information.llt().matrixL().toDenseMatrix().diagonal().array().log().sum();
}

void search(std::vector<Candidate>& candidates, std::span<const WheelReading> samples, bool first,
            const ProgressMonitor& watch) {
  const auto alive = static_cast<double>(std::ranges::count(candidates, true, &Candidate::alive));
  double done = 0.0;
  for (Candidate& c : candidates) {
    if (!c.alive) continue;
    PassWatch passes(watch, done / alive, (done + 1.0) / alive);
    const SoilObjective watched = c.objective.watchedBy(passes.watch());
    const SoilVector start = first ? findModeAfresh(watched, samples).likelihood.at : c.likelihood.at;
    c.likelihood = descend(watched, samples, start);
    c.log_probability =
        std::log(c.objective.soilClass().probability) + logEvidence(c.objective, c.likelihood);
    done += 1.0;
  }
  dropHopeless(candidates);
}

}  // namespace

std::vector<WheelReading> spreadEvenly(std::span<const WheelReading> samples, std::size_t count) {
  if (samples.size() <= count) return {samples.begin(), samples.end()};
  std::vector<WheelReading> chosen;
  const double stretch = static_cast<double>(samples.size()) / static_cast<double>(count);
  for (std::size_t k = 0; k < count; ++k) {  // irregular places, against aliasing
    const double place = std::fmod(std::numbers::phi * static_cast<double>(k), 1.0);
    chosen.push_back(samples[static_cast<std::size_t>((static_cast<double>(k) + place) * stretch)]);
  }
  return chosen;
}

namespace {

// First-order propagation of the errors of sinkage and slip causes an error of up to 2 % in friction angle
// and shear modulus for any number of samples. Above kTrusted samples the likelihood is therefore not
// sharpened further (ours; docs/measurements/terramech.md).
SoilQuadratic limitSharpness(SoilQuadratic q, std::size_t samples) {
  constexpr double kTrusted = 4000.0;
  const double share = std::min(1.0, kTrusted / static_cast<double>(samples));
  q.cost *= share;
  q.gradient *= share;
  q.information *= share;
  return q;
}

}  // namespace

SoilPosterior fitManySamples(const std::vector<SoilObjective>& classes, std::span<const WheelReading> samples,
                             const SoilFitOptions& options) {
  std::vector<Candidate> candidates;
  candidates.reserve(classes.size());
  for (const SoilObjective& objective : classes) candidates.push_back({objective});
  for (std::size_t count = kFirst;; count *= kGrowth) {
    const bool all = count >= samples.size();
    search(candidates, spreadEvenly(samples, count), count == kFirst,
           all ? options.watch : ProgressMonitor{{}, options.watch.stop});
    if (options.watch.stopped()) return {};
    if (all) break;
  }
  options.watch.report(1.0);
  const bool weighed = samples.size() <= kWeighed;
  std::vector<ClassFit> fits;
  for (Candidate& c : candidates) {
    if (c.alive) {
      const SoilVector at = middle(c.objective, c.likelihood);
      c.likelihood = limitSharpness(
          curved(c.objective.expandWhole(at, samples, {}), curvatureCorrection(c.objective, at, samples)),
          samples.size());
    }
    fits.push_back(
        {.objective = c.objective,
         .before = weighed ? SoilQuadratic{} : c.likelihood,
         .mode = {.x = {},
                  .likelihood = c.likelihood,
                  .log_evidence = c.log_probability - std::log(c.objective.soilClass().probability)}});
  }
  SoilPosterior posterior =
      samplePosterior(fits, weighed ? samples : std::span<const WheelReading>{}, options.draws);
  const Candidate& best = *std::ranges::max_element(candidates, {}, &Candidate::log_probability);
  posterior.misfit = best.objective.meanSquare(best.likelihood.at, samples);
  return posterior;
}

}  // namespace talus::terramech
