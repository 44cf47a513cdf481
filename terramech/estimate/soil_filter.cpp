#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <talus/terramech/estimate/soil_filter.hpp>

namespace talus::terramech {
namespace {

// So many samples are fitted afresh, until the modes stand where later samples only nudge them.
constexpr std::size_t kFresh = 4;

}  // namespace

SoilFilter::SoilFilter(const Wheel& wheel, SoilMixture prior, const Options& options)
    : wheel_(wheel), prior_(std::move(prior)), options_(options), tracks_(prior_.size()) {
  validate(wheel_);
  checkFit({}, options_.fit);
  if (prior_.empty() || options_.window < 1)
    throw std::invalid_argument("soil filter: no class of soil, or no window");
}

SoilObjective SoilFilter::objective(std::size_t soil_class) const {
  return {prior_[soil_class], {options_.fit.noise, options_.fit.outlier_share, population_, {}}};
}

void SoilFilter::add(const WheelReading& reading) {
  checkFit({&reading, 1}, options_.fit);
  window_.push_back(reading);
  population_.add(reading.sample, options_.fit.noise);
  ++count_;
  const bool full = window_.size() > options_.window;
  for (std::size_t k = 0; k < tracks_.size(); ++k) {
    Track& track = tracks_[k];
    if (full) {  // the oldest sample leaves: its quadratic about the mode stays
      track.before =
          objective(k).expandWhole(track.mode.likelihood.at, std::span(window_).first(1), track.before);
    }
    const auto kept = std::span(window_).subspan(full ? 1 : 0);
    track.mode = !full && count_ <= kFresh ? findModeAfresh(objective(k), kept)
                                           : findMode(objective(k), kept, track.before, track.mode.x);
  }
  if (full) window_.erase(window_.begin());
}

SoilPosterior SoilFilter::posterior() const {
  if (count_ == 0) throw std::domain_error("soil filter: no sample yet");
  std::vector<ClassFit> classes;
  for (std::size_t k = 0; k < tracks_.size(); ++k)
    classes.push_back({objective(k), tracks_[k].before, tracks_[k].mode});
  return samplePosterior(classes, window_, options_.fit.draws);
}

std::vector<double> SoilFilter::classProbabilities() const {
  std::vector<double> p;
  for (std::size_t k = 0; k < tracks_.size(); ++k) {
    p.push_back(std::log(prior_[k].probability) + tracks_[k].mode.log_evidence);
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
  return prior_[best].at(count_ == 0 ? SoilVector(SoilVector::Constant(0.5))
                                     : tracks_[best].mode.likelihood.at);
}

}  // namespace talus::terramech
