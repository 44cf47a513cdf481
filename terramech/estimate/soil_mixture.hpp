#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <talus/terramech/contact/contact_response.hpp>

/// Prior of a soil as a mixture of soil classes (sand, clay, ...).
namespace talus::terramech {

/// Number of soil parameters that are estimated: cohesion c, friction angle phi, sinkage exponent n, sinkage
/// modulus k, shear modulus K. Their order is that of the first columns of ContactDerivative.
inline constexpr int kSoilParameters = 5;
using SoilVector = Eigen::Matrix<double, kSoilParameters, 1>;
using SoilMatrix = Eigen::Matrix<double, kSoilParameters, kSoilParameters>;

/// Prior of one soil parameter. The parameter is a function of a coordinate y that is uniform on [0, 1]
/// (bounded prior) or standard normal.
class Marginal {
 public:
  Marginal() = default;  ///< parameter fixed at 0

  /// Returns the prior of an exactly known parameter.
  static Marginal fixed(double value);

  /// Returns a uniform prior between two bounds: value = low + (high - low) y. Throws std::invalid_argument
  /// unless low < high.
  static Marginal uniform(double low, double high);

  /// Returns a log-uniform prior between two bounds. Throws std::invalid_argument unless 0 < low < high.
  static Marginal logUniform(double low, double high);

  /// Returns a Gaussian prior; a value below `least` is replaced by `least`. Throws std::invalid_argument
  /// unless std > 0.
  static Marginal normal(double mean, double std, double least);

  /// Returns the value of the parameter at the coordinate y.
  double at(double y) const;
  double slope(double y) const;  ///< returns d at(y) / dy
  /// Returns true if y is uniform on [0, 1], false if y is standard normal.
  bool bounded() const { return shape_ != Shape::Normal; }

 private:
  enum class Shape { Uniform, LogUniform, Normal };

  Shape shape_ = Shape::Uniform;
  double low_ = 0.0;  // smallest value `least` if the shape is Normal
  double high_ = 0.0;
  double mean_ = 0.0;
  double std_ = 0.0;
};

/// Soil class: independent priors of the five soil parameters.
struct SoilClass {
  std::string name;
  double probability = 1.0;  ///< prior probability of the class; the classes of a mixture should have sum 1
  /// Priors of c [Pa], phi [rad], n, k [N/m^(n+2)], K [m].
  std::array<Marginal, kSoilParameters> parameters{};
  double c1 = 0.43;  ///< ratio theta_m / theta_1 of stress-peak angle to entry angle at slip 0 [-]
  double c2 = 0.32;  ///< increase of theta_m / theta_1 per unit slip [-]

  /// Return the soil at the coordinates y of its parameters, and the derivative of each parameter with
  /// respect to its coordinate.
  ContactSoil at(const SoilVector& y) const;
  SoilVector slope(const SoilVector& y) const;
};

/// Prior of a soil as a mixture of soil classes.
using SoilMixture = std::vector<SoilClass>;

/// Returns the classes sand, clay, loam and firm soil with the ranges of thesis Table 2.1, each with
/// probability 0.25.
SoilMixture thesisSoils();

/// Returns thesisSoils() plus a class "other" with the given probability in [0, 1), which covers natural and
/// simulant soils: c 0 to 20 kPa, phi 15 to 50 deg, n 0.3 to 1.8, k 1e4 to 1e8, K 3 to 60 mm (ranges ours,
/// around thesis Tables 2.3 and A.1).
SoilMixture thesisSoilsOrOther(double other_probability = 0.02);

}  // namespace talus::terramech
