#include <cmath>

#include <talus/terramech/calibration/search/trace_result.hpp>

namespace talus::terramech {

ChannelErrors rmseOf(const RefinedModel& model, const Trial& trial) {
  SolvedContacts solved;
  return rmseOf(predictRows(model, trial, solved), trial);
}

ChannelErrors rmseOf(const Eigen::MatrixXd& predicted, const Trial& trial) {
  const Eigen::MatrixXd residual = trial.measured - predicted;
  ChannelErrors errors{};
  for (int c = 0; c < kChannels; ++c) {
    double sum = 0.0;
    int count = 0;
    for (double r : residual.col(c))
      if (std::isfinite(r)) sum += r * r, ++count;
    errors[static_cast<std::size_t>(c)] = count ? std::sqrt(sum / count) : std::nan("");
  }
  return errors;
}

}  // namespace talus::terramech
