#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <talus/terramech/estimate/soil_estimation.hpp>
#include <talus/terramech/estimate/soil_objective.hpp>

namespace talus::terramech {
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
      track.before =
          s.objective(k).expandWhole(track.mode.likelihood.at, std::span(s.window).first(1), track.before);
    }
    const auto kept = std::span(s.window).subspan(full ? 1 : 0);
    track.mode = !full && s.count <= kFresh ? findModeAfresh(s.objective(k), kept)
                                            : findMode(s.objective(k), kept, track.before, track.mode.x);
  }
  if (full) s.window.erase(s.window.begin());
}

SoilPosterior SoilFilter::posterior() const {
  const State& s = *state_;
  if (s.count == 0) throw std::domain_error("soil filter: no sample yet");
  std::vector<ClassFit> classes;
  for (std::size_t k = 0; k < s.tracks.size(); ++k)
    classes.push_back({s.objective(k), s.tracks[k].before, s.tracks[k].mode});
  return samplePosterior(classes, s.window, s.options.fit.draws);
}

std::vector<double> SoilFilter::classProbabilities() const {
  std::vector<double> p;
  for (std::size_t k = 0; k < state_->tracks.size(); ++k) {
    p.push_back(std::log(state_->prior[k].probability) + state_->tracks[k].mode.log_evidence);
  }
  const double most = *std::ranges::max_element(p);
  double sum = 0.0;
  for (double& value : p) sum += value = std::exp(value - most);
  for (double& value : p) value /= sum;
  return p;
}

ContactSoil SoilFilter::mode() const {
  const auto p = classProbabilities();
  const auto best = static_cast<std::size_t>(std::ranges::max_element(p) - p.begin());
  return state_->prior[best].at(state_->count == 0 ? SoilVector(SoilVector::Constant(0.5))
                                                   : state_->tracks[best].mode.likelihood.at);
}

}  // namespace talus::terramech
