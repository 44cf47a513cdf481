#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <talus/terramech/contact/contact_response.hpp>

/// Prior of a soil: a mixture of soil classes.
namespace talus::terramech {

/// Number of parameters: cohesion c, friction angle phi, sinkage exponent n, sinkage modulus k, shear modulus
/// K, in the order of the first columns of ContactDerivative.
inline constexpr int kSoilParameters = 5;
using SoilVector = Eigen::Matrix<double, kSoilParameters, 1>;
using SoilMatrix = Eigen::Matrix<double, kSoilParameters, kSoilParameters>;

/// Prior of one parameter as a function of a coordinate y, which is uniform on [0, 1] (bounded) or standard
/// normal.
class Marginal {
 public:
  Marginal() = default;  ///< fixed at 0

  /// Exactly known value.
  static Marginal fixed(double value);

  /// Uniform between two bounds, low < high: value = low + (high - low) y. Throws std::invalid_argument
  /// otherwise.
  static Marginal uniform(double low, double high);

  /// Log-uniform between two bounds, 0 < low < high. Throws std::invalid_argument otherwise.
  static Marginal logUniform(double low, double high);

  /// Gaussian; values below `least` are set to `least`. Throws std::invalid_argument unless std > 0.
  static Marginal normal(double mean, double std, double least);

  /// Returns the parameter value at coordinate y.
  double at(double y) const;
  double slope(double y) const;  ///< d at(y) / dy
  /// Returns true if y is in [0, 1]; otherwise y is standard normal.
  bool bounded() const { return shape_ != Shape::Normal; }

 private:
  enum class Shape { Uniform, LogUniform, Normal };

  Shape shape_ = Shape::Uniform;
  double low_ = 0.0;  // Normal: least
  double high_ = 0.0;
  double mean_ = 0.0;
  double std_ = 0.0;
};

/// Soil class: independent priors of the five parameters.
struct SoilClass {
  std::string name;
  double probability = 1.0;  ///< prior probability; the classes of a mixture should have sum 1
  std::array<Marginal, kSoilParameters> parameters{};  ///< c [Pa], phi [rad], n, k [N/m^(n+2)], K [m]
  double c1 = 0.43;
  double c2 = 0.32;

  /// Returns the soil at coordinates y, and the derivative of each parameter by its coordinate.
  ContactSoil at(const SoilVector& y) const;
  SoilVector slope(const SoilVector& y) const;
};

/// Mixture of soil classes.
using SoilMixture = std::vector<SoilClass>;

/// Returns sand, clay, loam and firm soil with the ranges of thesis Table 2.1, each with probability 0.25.
SoilMixture thesisSoils();

/// Returns thesisSoils() plus, with the given probability in [0, 1), a class "other" that covers natural and
/// simulant soils: c 0 to 20 kPa, phi 15 to 50 deg, n 0.3 to 1.8, k 1e4 to 1e8, K 3 to 60 mm (ranges ours,
/// around thesis Tables 2.3 and A.1).
SoilMixture thesisSoilsOrOther(double other_probability = 0.02);

}  // namespace talus::terramech
