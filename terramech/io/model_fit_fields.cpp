#include <algorithm>
#include <cmath>
#include <string>

#include <Eigen/Eigenvalues>

#include <talus/terramech/io/model_fit_fields.hpp>

namespace talus::terramech {
namespace {

/// Returns why a row-major matrix is not a covariance; empty if the matrix is a covariance. A negative
/// variance would count as an exact value.
std::string faultOfCovariance(const std::vector<double>& values, std::size_t size) {
  const auto n = static_cast<Eigen::Index>(size);
  const Eigen::MatrixXd given = Eigen::Map<const Eigen::MatrixXd>(values.data(), n, n);
  constexpr double kRounding =
      1e-6;  // rounding tolerance of a correlation, for an inverse of condition number 1e10 and 17 digits in
             // the file
  Eigen::MatrixXd correlation = given;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (given(i, i) < 0.0)
      return "has the negative variance " + std::to_string(given(i, i)) + " in row " + std::to_string(i + 1);
    for (Eigen::Index k = 0; k < n; ++k) {
      const double scale = std::sqrt(given(i, i)) * std::sqrt(std::max(given(k, k), 0.0));
      if (std::abs(given(i, k) - given(k, i)) > kRounding * scale)
        return "is not symmetric in row " + std::to_string(i + 1);
      if (std::abs(given(i, k)) > (1.0 + kRounding) * scale)
        return "has a correlation beyond 1 in row " + std::to_string(i + 1);
      correlation(i, k) = scale > 0.0 ? given(i, k) / scale : 0.0;
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(correlation, Eigen::EigenvaluesOnly);
  if (n > 0 && !(solver.eigenvalues().minCoeff() >= -kRounding * static_cast<double>(n)))
    return "gives a combination of the parameters a negative variance (it is not positive semidefinite)";
  return "";
}

}  // namespace

void readFit(const YamlFields& root, RefinedModel& model) {
  for (const YamlFields& f : root.list("fitted")) {
    f.only({"effect", "index"});
    model.fitted.push_back({f.integer("effect"), f.integer("index")});
    const auto& p = model.fitted.back();
    const bool known =
        p.effect < 0
            ? p.index >= 0 && p.index < static_cast<int>(soilParameters().size())
            : p.effect < static_cast<int>(model.effects.size()) && p.index >= 0 &&
                  p.index <
                      static_cast<int>(model.effects[static_cast<std::size_t>(p.effect)].parameters.size());
    if (!known)
      f.refuse("index",
               "effect " + std::to_string(p.effect) + ", index " + std::to_string(p.index) +
                   " names no fitted parameter of this model",
               "fit it once more: talus trace --model-out");
    const auto same = [&](const FittedParameter& q) { return q.effect == p.effect && q.index == p.index; };
    if (std::ranges::count_if(model.fitted, same) > 1)
      f.refuse("index", "names a parameter of `fitted` a second time",
               "remove it, and its row of the covariance");
  }
  model.covariance = root.numbers("covariance", true);
  if (model.covariance.size() != model.fitted.size() * model.fitted.size())
    root.refuse("covariance",
                "covariance has " + std::to_string(model.covariance.size()) + " numbers, must have " +
                    std::to_string(model.fitted.size() * model.fitted.size()) +
                    ", the square of the number of fitted parameters",
                "fit it once more: talus trace --model-out");
  if (const std::string fault = faultOfCovariance(model.covariance, model.fitted.size()); !fault.empty())
    root.refuse("covariance", "covariance " + fault, "write the model by talus trace --model-out");
}

}  // namespace talus::terramech
