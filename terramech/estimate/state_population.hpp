#pragma once

#include <talus/terramech/estimate/reading_errors.hpp>
#include <talus/terramech/numerics/estimate.hpp>

/// Where the loads and slips of a drive lie, learned from their readings (ours: empirical Bayes). A reading
/// far from all others is more likely far by error than in truth; an estimator that does not know this
/// mistakes the errors' scatter for the drive's and answers wrongly, the more surely the more rows it has.
namespace talus::terramech {

/// Mean and spread of the true ln W and of the true slip, taken as Gaussian; one reading at a time, in
/// constant memory. Without readings, or too few to tell a spread, it knows nothing and leaves readings as
/// they are.
class StatePopulation {
 public:
  void add(const WheelSample& sample, const ReadingErrors& errors);

  /// The reading of the load [N] or slip [-] combined with what the others say of it: W* = mean + s (W -
  /// mean), s = V/(V + std^2), of standard deviation sqrt(s) std.
  Estimate load(const WheelSample& sample, const ReadingErrors& errors) const;
  Estimate slip(const WheelSample& sample, const ReadingErrors& errors) const;

 private:
  struct Spread {
    void add(const Estimate& reading);
    Estimate combine(const Estimate& reading) const;

    double count = 0.0, mean = 0.0, squares = 0.0, error_variance = 0.0;
  };

  Spread log_load_, slip_;
};

}  // namespace talus::terramech
