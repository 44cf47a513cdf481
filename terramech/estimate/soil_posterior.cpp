#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <Eigen/QR>

#include <talus/common/common.hpp>
#include <talus/terramech/estimate/soil_estimation.hpp>
#include <talus/terramech/estimate/soil_objective.hpp>
#include <talus/terramech/numerics/functions.hpp>

namespace talus::terramech {

namespace {

// Row of thesis Table 2.1: parameters that differ between the classes.
struct TableRow {
  const char* name;
  Interval cohesion_kPa;
  Interval friction_deg;
  Interval modulus_MN;
};

SoilClass classOf(const TableRow& row) {
  SoilClass soil{.name = row.name, .probability = 0.25};
  soil.parameters[kCohesion] = Marginal::uniform(1e3 * row.cohesion_kPa.low, 1e3 * row.cohesion_kPa.high);
  soil.parameters[kFriction] =
      Marginal::uniform(kDegree * row.friction_deg.low, kDegree * row.friction_deg.high);
  soil.parameters[kExponent] = Marginal::uniform(0.5, 1.2);
  soil.parameters[kModulus] = Marginal::uniform(1e6 * row.modulus_MN.low, 1e6 * row.modulus_MN.high);
  soil.parameters[kShear] = Marginal::uniform(0.01, 0.03);
  return soil;
}

SoilClass anySoil(double probability) {
  SoilClass soil{.name = "other", .probability = probability};
  soil.parameters[kCohesion] = Marginal::uniform(0.0, 2e4);
  soil.parameters[kFriction] = Marginal::uniform(15.0 * kDegree, 50.0 * kDegree);
  soil.parameters[kExponent] = Marginal::uniform(0.3, 1.8);
  soil.parameters[kModulus] = Marginal::logUniform(1e4, 1e8);
  soil.parameters[kShear] = Marginal::logUniform(0.003, 0.06);
  return soil;
}

}  // namespace

Marginal Marginal::fixed(double value) {
  Marginal m;
  m.low_ = m.high_ = value;
  return m;
}

Marginal Marginal::uniform(double low, double high) {
  RangeCheck("prior").above("upper bound", high, low);
  Marginal m;
  m.low_ = low;
  m.high_ = high;
  return m;
}

Marginal Marginal::logUniform(double low, double high) {
  RangeCheck("prior").above("lower bound", low, 0.0);
  Marginal m = uniform(std::log(low), std::log(high));
  m.shape_ = Shape::LogUniform;
  return m;
}

Marginal Marginal::normal(double mean, double std, double least) {
  RangeCheck("prior").above("std", std, 0.0);
  Marginal m;
  m.shape_ = Shape::Normal;
  m.low_ = least;
  m.mean_ = mean;
  m.std_ = std;
  return m;
}

double Marginal::at(double y) const {
  if (shape_ == Shape::Normal) return std::max(low_, mean_ + std_ * y);
  const double value = low_ + (high_ - low_) * y;
  return shape_ == Shape::LogUniform ? std::exp(value) : value;
}

double Marginal::slope(double y) const {
  if (shape_ == Shape::Normal) return mean_ + std_ * y > low_ ? std_ : 0.0;
  return shape_ == Shape::LogUniform ? at(y) * (high_ - low_) : high_ - low_;
}

ContactSoil SoilClass::at(const SoilVector& y) const {
  return {.cohesion_Pa = parameters[kCohesion].at(y[kCohesion]),
          .friction_angle_rad = parameters[kFriction].at(y[kFriction]),
          .sinkage_exponent = parameters[kExponent].at(y[kExponent]),
          .sinkage_modulus = parameters[kModulus].at(y[kModulus]),
          .shear_modulus_m = parameters[kShear].at(y[kShear]),
          .c1 = c1,
          .c2 = c2};
}

SoilVector SoilClass::slope(const SoilVector& y) const {
  SoilVector slope;
  for (int k = 0; k < kSoilParameters; ++k) slope[k] = parameters[static_cast<std::size_t>(k)].slope(y[k]);
  return slope;
}

SoilMixture thesisSoils() {
  return {classOf({"sand", {0.0, 1.0}, {30.0, 35.0}, {1.5, 2.0}}),
          classOf({"clay", {5.0, 7.0}, {20.0, 25.0}, {1.0, 1.5}}),
          classOf({"loam", {2.0, 4.0}, {20.0, 30.0}, {1.5, 2.0}}),
          classOf({"firm soil", {0.0, 1.0}, {30.0, 35.0}, {2.5, 3.0}})};
}

SoilMixture thesisSoilsOrOther(double other_probability) {
  SoilMixture prior = thesisSoils();
  for (SoilClass& soil : prior) soil.probability *= 1.0 - other_probability;
  prior.push_back(anySoil(other_probability));
  return prior;
}

namespace {

// Probability below which classes are not sampled.
constexpr double kNegligible = 1e-6;

// Replaces log weights by weights with sum 1.
void normalise(std::vector<double>& log_weights) {
  const double most = *std::ranges::max_element(log_weights);
  double sum = 0.0;
  for (double& w : log_weights) sum += w = std::exp(w - most);
  for (double& w : log_weights) w /= sum;
}

void draw(const ClassFit& fit, int index, std::span<const WheelReading> samples,
          const Eigen::MatrixXd& points, std::vector<SoilDraw>& draws, std::vector<double>& log_weights) {
  const SoilClass& soil = fit.objective.soilClass();
  const TruncatedGaussian sampler = proposal(soil, fit.mode.likelihood);
  for (Eigen::Index k = 0; k < points.cols(); ++k) {
    const auto [y, log_density] = sampler.draw(points.col(k));
    const double cost = fit.objective.cost(y, samples, fit.before) + priorCost(soil, y);
    draws.push_back({.soil = soil.at(y), .soil_class = index});
    log_weights.push_back(std::log(soil.probability) - cost - log_density);
  }
}

SoilVector vectorOf(const ContactSoil& s) {
  return {s.cohesion_Pa, s.friction_angle_rad, s.sinkage_exponent, s.sinkage_modulus, s.shear_modulus_m};
}

// Pairs (value, weight) of the draws.
using Weighted = std::vector<std::pair<double, double>>;

// Weighted quantile; `sorted` ascending.
double quantile(const Weighted& sorted, double share) {
  double below = 0.0;
  for (const auto& [value, weight] : sorted) {
    if ((below += weight) >= share) return value;
  }
  return sorted.back().first;
}

CredibleInterval interval(const std::vector<SoilDraw>& draws, double ContactSoil::*field) {
  Weighted sorted;
  for (const SoilDraw& d : draws) sorted.emplace_back(d.soil.*field, d.weight);
  std::ranges::sort(sorted);
  return {quantile(sorted, 0.025), quantile(sorted, 0.975)};
}

double ellipse95(const SoilPosterior& p) {
  Weighted sorted;
  for (const SoilDraw& d : p.draws) sorted.emplace_back(strengthDistance(p, d.soil), d.weight);
  std::ranges::sort(sorted);
  return quantile(sorted, 0.95);
}

void summarise(SoilPosterior& p) {
  SoilVector mean = SoilVector::Zero();
  double squares = 0.0;
  for (const SoilDraw& d : p.draws) {
    mean += d.weight * vectorOf(d.soil);
    p.tan_friction += d.weight * std::tan(d.soil.friction_angle_rad);
    squares += d.weight * d.weight;
  }
  for (const SoilDraw& d : p.draws) {
    const SoilVector away = vectorOf(d.soil) - mean;
    const Eigen::Vector2d strength(away[kCohesion], std::tan(d.soil.friction_angle_rad) - p.tan_friction);
    p.covariance += d.weight * away * away.transpose();
    p.strength_covariance += d.weight * strength * strength.transpose();
  }
  const ContactSoil& likeliest = std::ranges::max_element(p.draws, {}, &SoilDraw::weight)->soil;
  p.mean = {mean[kCohesion], mean[kFriction], mean[kExponent], mean[kModulus],
            mean[kShear],    likeliest.c1,    likeliest.c2};
  p.effective_draws = 1.0 / squares;
  p.ellipse_95 = ellipse95(p);
  p.cohesion_Pa = interval(p.draws, &ContactSoil::cohesion_Pa);
  p.friction_angle_rad = interval(p.draws, &ContactSoil::friction_angle_rad);
  p.shear_modulus_m = interval(p.draws, &ContactSoil::shear_modulus_m);
}

// Prior variance of each parameter.
SoilVector priorVariance(const std::vector<ClassFit>& classes) {
  constexpr Eigen::Index kPoints = 256;
  const Eigen::MatrixXd points = evenPoints(kSoilParameters, kPoints);
  SoilVector sum = SoilVector::Zero();
  SoilVector squares = SoilVector::Zero();
  for (const ClassFit& fit : classes) {
    const SoilClass& soil = fit.objective.soilClass();
    for (Eigen::Index k = 0; k < kPoints; ++k) {
      SoilVector y = points.col(k);
      for (int p = 0; p < kSoilParameters; ++p) {
        if (!soil.parameters[static_cast<std::size_t>(p)].bounded()) y[p] = normalQuantile(y[p]);
      }
      const SoilVector value = vectorOf(soil.at(y));
      sum += soil.probability / kPoints * value;
      squares += soil.probability / kPoints * value.cwiseAbs2();
    }
  }
  return squares - sum.cwiseAbs2();
}

// Lists the parameters whose standard deviation the samples reduced by less than 10 %.
void listUndetermined(const SoilVector& before, SoilPosterior& p) {
  constexpr double kSeen = 0.9;
  const std::pair<ContactColumn, const char*> names[] = {
      {kCohesion, "cohesion_Pa: the posterior is almost as wide as the prior; vary the load"},
      {kFriction, "friction_angle_rad: the posterior is almost as wide as the prior; vary the load"},
      {kShear,
       "shear_modulus_m: the posterior is almost as wide as the prior; vary the slip, mainly at low slip"}};
  for (const auto& [column, text] : names) {
    if (before[column] > 0.0 && p.covariance(column, column) > kSeen * kSeen * before[column])
      p.unseen.emplace_back(text);
  }
}

double misfitOf(const std::vector<ClassFit>& classes, std::span<const WheelReading> samples) {
  const ClassFit& best = *std::ranges::max_element(classes, {}, [](const ClassFit& fit) {
    return std::log(fit.objective.soilClass().probability) + fit.mode.log_evidence;
  });
  return best.objective.meanSquare(best.mode.likelihood.at, samples);
}

void checkSample(const WheelReading& reading) {
  const auto& [wheel, s] = reading;
  validate(wheel);
  const RangeCheck range("soil fit");
  range.above("load_N", s.load_N, 0.0);
  range.finite("torque_Nm", s.torque_Nm);
  range.above("sinkage_m", s.sinkage_m, 0.0);
  range.within("sinkage_m", s.sinkage_m, {0.0, wheel.radius_m});
  range.within("slip", s.slip, {0.0, 1.0});
}

}  // namespace

double strengthDistance(const SoilPosterior& p, const ContactSoil& soil) {
  const Eigen::Vector2d away(soil.cohesion_Pa - p.mean.cohesion_Pa,
                             std::tan(soil.friction_angle_rad) - p.tan_friction);
  const Eigen::Vector2d std = p.strength_covariance.diagonal().cwiseSqrt();
  const Eigen::Array2d rounding = 1e-9 * Eigen::Array2d(p.mean.cohesion_Pa, p.tan_friction).abs();
  const Eigen::Vector2d scale = (std.array() > rounding).select(std.cwiseInverse(), 0.0);
  const Eigen::Matrix2d correlation = scale.asDiagonal() * p.strength_covariance * scale.asDiagonal();
  const Eigen::Vector2d scaled = scale.cwiseProduct(away);
  return scaled.dot(correlation.completeOrthogonalDecomposition().solve(scaled));
}

SoilPosterior samplePosterior(const std::vector<ClassFit>& classes, std::span<const WheelReading> samples,
                              int draws) {
  SoilPosterior posterior;
  std::vector<double>& probabilities = posterior.class_probabilities;
  for (const ClassFit& fit : classes) {
    probabilities.push_back(std::log(fit.objective.soilClass().probability) + fit.mode.log_evidence);
  }
  normalise(probabilities);
  const Eigen::MatrixXd points = evenPoints(kSoilParameters, draws);
  std::vector<double> weights;
  for (std::size_t k = 0; k < classes.size(); ++k) {
    if (probabilities[k] > kNegligible)
      draw(classes[k], static_cast<int>(k), samples, points, posterior.draws, weights);
  }
  if (!std::ranges::any_of(weights, [](double w) { return std::isfinite(w); }))
    throw std::domain_error("soil fit: no soil of the prior can give these readings; check their units");
  normalise(weights);
  std::ranges::fill(probabilities, 0.0);
  for (std::size_t k = 0; k < weights.size(); ++k) {
    posterior.draws[k].weight = weights[k];
    probabilities[static_cast<std::size_t>(posterior.draws[k].soil_class)] += weights[k];
  }
  summarise(posterior);
  listUndetermined(priorVariance(classes), posterior);
  return posterior;
}

void checkFit(std::span<const WheelReading> samples, const SoilFitOptions& options) {
  for (const WheelReading& s : samples) checkSample(s);
  const RangeCheck range("soil fit");
  range.within("outlier_share", options.outlier_share, {0.0, 0.5});
  range.atLeast("draws", options.draws, 16);
}

SoilPosterior fitSoil(std::span<const WheelReading> samples, const SoilMixture& prior,
                      const SoilFitOptions& options) {
  checkFit(samples, options);
  if (samples.empty() || prior.empty()) throw std::domain_error("soil fit: no sample, or no class of soil");
  StatePopulation population;
  for (const WheelReading& s : samples) population.add(s.sample, options.noise);
  std::vector<SoilObjective> classes;
  for (const SoilClass& soil : prior)
    classes.emplace_back(soil, SoilObjective::Setting{options.noise, options.outlier_share, population, {}});
  const std::vector<ClassFit> fits = fitClasses(classes, samples, options.watch);
  if (fits.empty()) return {};
  SoilPosterior posterior = samplePosterior(fits, weighted(samples), options.draws);
  posterior.misfit = misfitOf(fits, samples);
  return posterior;
}

SoilPosterior fitSoil(const Wheel& wheel, std::span<const WheelSample> samples, const SoilMixture& prior,
                      const SoilFitOptions& options) {
  validate(wheel);
  std::vector<WheelReading> readings;
  for (const WheelSample& s : samples) readings.push_back({wheel, s});
  return fitSoil(readings, prior, options);
}

namespace {

// Number of samples up to which modes are searched without an initial value, because each sample changes the
// modes much.
constexpr std::size_t kFresh = 4;

}  // namespace

struct SoilFilter::State {
  struct Track {  // state of one class
    SoilQuadratic before;
    SoilMode mode;
  };

  SoilObjective objective(std::size_t soil_class) const {
    return {prior[soil_class], {options.fit.noise, options.fit.outlier_share, population, {}}};
  }

  Wheel wheel;
  SoilMixture prior;
  Options options;
  std::vector<Track> tracks{};
  std::vector<WheelReading> window{};  // oldest first
  StatePopulation population{};        // population of all samples
  std::size_t count = 0;
};

SoilFilter::SoilFilter(const Wheel& wheel, SoilMixture prior, const Options& options)
    : state_(new State{.wheel = wheel, .prior = std::move(prior), .options = options}) {
  validate(wheel);
  checkFit({}, options.fit);
  if (state_->prior.empty() || options.window < 1)
    throw std::invalid_argument("soil filter: no class of soil, or no window");
  state_->tracks.resize(state_->prior.size());
}

SoilFilter::SoilFilter(const SoilFilter& other) : state_(new State(*other.state_)) {}
SoilFilter::SoilFilter(SoilFilter&&) noexcept = default;
SoilFilter::~SoilFilter() = default;

SoilFilter& SoilFilter::operator=(SoilFilter other) noexcept {
  state_.swap(other.state_);
  return *this;
}

std::size_t SoilFilter::samples() const {
  return state_->count;
}

void SoilFilter::add(const WheelSample& sample) {
  add({state_->wheel, sample});
}

void SoilFilter::add(const WheelReading& reading) {
  State& s = *state_;
  checkFit({&reading, 1}, s.options.fit);
  s.window.push_back(reading);
  s.population.add(reading.sample, s.options.fit.noise);
  ++s.count;
  const bool full = s.window.size() > s.options.window;
  for (std::size_t k = 0; k < s.tracks.size(); ++k) {
    State::Track& track = s.tracks[k];
    if (full) {  // remove the oldest sample, keep its quadratic about the mode
      track.before = s.objective(k).expand(track.mode.likelihood.at, std::span(s.window).first(1),
                                           track.before, SoilObjective::Gradient::Whole);
    }
    const auto kept = std::span(s.window).subspan(full ? 1 : 0);
    constexpr auto kQuick = SoilObjective::Gradient::GaussNewton;
    track.mode = !full && s.count <= kFresh
                     ? findModeAfresh(s.objective(k), kept, kQuick)
                     : findMode(s.objective(k), kept, track.before, track.mode.x, kQuick);
  }
  if (full) s.window.erase(s.window.begin());
}

SoilPosterior SoilFilter::posterior() const {
  const State& s = *state_;
  if (s.count == 0) throw std::domain_error("soil filter: no sample yet");
  std::vector<ClassFit> classes;
  for (std::size_t k = 0; k < s.tracks.size(); ++k)
    classes.push_back({s.objective(k), s.tracks[k].before, s.tracks[k].mode});
  SoilPosterior posterior = samplePosterior(classes, s.window, s.options.fit.draws);
  posterior.misfit = misfitOf(classes, s.window);
  return posterior;
}

}  // namespace talus::terramech
