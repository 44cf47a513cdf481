#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <string>

#include <talus/terramech/calibration.hpp>

#include "made_rows.hpp"

namespace talus::terramech {
namespace effect_candidates_test {

// Telemetry of a wheel at several slips and loads, with further columns that each row sets.
Trial trialWith(const std::vector<std::string>& more, const std::function<std::vector<double>(int)>& values,
                double least_slip = 0.1, const std::string& groups = "") {
  std::vector<std::string> columns = wheelColumns();
  columns.insert(columns.end(), more.begin(), more.end());
  MadeRows rows(columns);
  std::mt19937_64 random(2);
  for (int k = 0; k < 40; ++k) {
    std::vector<double> row = wheelRow(madeSand(), 50.0 + k, least_slip + 0.015 * k, 0.02, random);
    for (const double v : values(k)) row.push_back(v);
    rows.add(row, k % 2 ? "left" : "right");
  }
  RefinedModel model;
  model.soil = madeSand();
  return makeTrial(rows.telemetry(groups), model);
}

std::vector<double> nothing(int) {
  return {};
}

std::vector<Candidate> offered(const Trial& trial) {
  return libraryCandidates(trial, Eigen::VectorXd::LinSpaced(trial.rows(), 0.005, 0.02));
}

std::set<std::string> names(const std::vector<Candidate>& candidates) {
  std::set<std::string> all;
  for (const Candidate& c : candidates)
    if (c.parts.size() == 1) all.insert(c.parts[0].name);
  return all;
}

TEST(EffectCandidates, CandidatesRequireTheirMeasuredColumns) {
  const auto plain = names(offered(trialWith({}, nothing)));
  EXPECT_TRUE(plain.contains("slip_sinkage_ding"));
  EXPECT_TRUE(plain.contains("torque_offset"));
  for (const char* name : {"multipass_stiffness", "rate_shear", "grouser_thrust", "wheel_diameter",
                           "skid_sinkage", "side_bulldozing", "slope_load_transfer", "drift_cohesion"})
    EXPECT_FALSE(plain.contains(name)) << name;
  const auto passes =
      names(offered(trialWith({"pass_index"}, [](int k) { return std::vector{1.0 + k % 4}; })));
  EXPECT_TRUE(passes.contains("multipass_stiffness"));
  const auto lugs =
      names(offered(trialWith({"grouser_height_m"}, [](int k) { return std::vector{0.01 * (k % 2)}; })));
  EXPECT_TRUE(lugs.contains("grouser_thrust"));
  const auto slopes = names(offered(trialWith({"slope_rad"}, [](int k) { return std::vector{0.01 * k}; })));
  EXPECT_TRUE(slopes.contains("slope_load_transfer"));
}

// Property: linear drifts are candidates for every additional column, independent of its name.
TEST(EffectCandidates, DriftIsOfferedForEveryUserColumnRegardlessOfItsName) {
  const auto drifts = [](const std::string& column) {
    std::set<std::string> all;
    for (const Candidate& c : offered(trialWith({column}, [](int k) { return std::vector{k % 7 + 0.5}; })))
      if (c.family == "drift" && c.covariate() == column) all.insert(c.parts[0].name);
    return all;
  };
  EXPECT_EQ(drifts("gravel_fraction").size(), 6U);
  EXPECT_EQ(drifts("gravel_fraction"), drifts("moisture_pct"));
  EXPECT_TRUE(drifts("speed_mps").empty());
}

// Property: every candidate is a form of the library with all parameters, within their bounds.
TEST(EffectCandidates, CandidatesAreCompleteFormsWithinParameterBounds) {
  const auto all = offered(trialWith(
      {"time_s"}, [](int k) { return std::vector{10.0 * k}; }, -0.3));
  EXPECT_TRUE(names(all).contains("skid_sinkage"));
  EXPECT_TRUE(names(all).contains("drift_cohesion_diurnal"));
  for (const Candidate& c : all) {
    int fitted = 0;
    for (const Effect& e : c.parts) {
      const EffectForm* form = findEffect(e.name);
      ASSERT_NE(form, nullptr) << e.name;
      ASSERT_EQ(e.parameters.size(), form->parameters.size()) << e.name;
      for (std::size_t k = 0; k < e.parameters.size(); ++k) {
        fitted += form->parameters[k].fitted;
        EXPECT_GE(e.parameters[k], form->parameters[k].low) << e.name;
        EXPECT_LE(e.parameters[k], form->parameters[k].high) << e.name;
      }
    }
    EXPECT_EQ(c.parameters, fitted) << c.parts[0].name;
  }
}

TEST(EffectCandidates, SensorFaultsAreOfferedPerGroupValue) {
  const auto all = offered(trialWith({}, nothing, 0.1, "side"));
  const auto of = [&](const std::string& name) {
    std::multiset<std::string> values;
    for (const Candidate& c : all)
      if (c.parts.size() == 1 && c.parts[0].name == name) values.insert(c.parts[0].only_value);
    return values;
  };
  EXPECT_EQ(of("torque_offset"), (std::multiset<std::string>{"", "left", "right"}));
  EXPECT_EQ(of("slip_sinkage_ding"), std::multiset<std::string>{""});
}

TEST(EffectCandidates, EmpiricalCurvesStartFlatOnMeasuredChannels) {
  const Trial trial = trialWith({}, nothing);
  const auto all = empiricalCandidates(trial, {});
  ASSERT_FALSE(all.empty());
  for (const Candidate& c : all) {
    EXPECT_EQ(c.family, "empirical");
    EXPECT_TRUE(c.empirical());
    for (const Effect& e : c.parts) {
      EXPECT_TRUE(trial.has(e.channel)) << e.covariate;
      EXPECT_EQ(e.knots.size(), e.parameters.size());
      EXPECT_TRUE(std::is_sorted(e.knots.begin(), e.knots.end()));
      for (const double p : e.parameters) EXPECT_EQ(p, 0.0);
      // Responses have no curves, because any residual would be explained by its own error.
      EXPECT_NE(e.covariate, "sinkage_m");
    }
  }
}

TEST(EffectCandidates, ProductsContainAUserColumnOfTheModel) {
  const Trial trial = trialWith({"dust", "humid"}, [](int k) {
    return std::vector{0.1 * (k % 7), 1.0 + k % 5};
  });
  const auto products = [&](const std::vector<Effect>& in) {
    std::set<std::string> all;
    for (const Candidate& c : empiricalCandidates(trial, in))
      if (isProduct(c.covariate())) all.insert(c.covariate());
    return all;
  };
  const Effect dust{.name = "empirical", .covariate = "dust"},
      humid{.name = "empirical", .covariate = "humid"};
  EXPECT_TRUE(products({}).empty());
  EXPECT_TRUE(products({{.name = "empirical", .covariate = "slip"}}).empty());
  EXPECT_EQ(products({dust}), (std::set<std::string>{"dust*humid", "dust*load_N", "dust*slip"}));
  EXPECT_EQ(products({humid}), (std::set<std::string>{"dust*humid", "humid*load_N", "humid*slip"}));
  EXPECT_EQ(products({humid, dust}),
            (std::set<std::string>{"dust*humid", "dust*load_N", "dust*slip", "humid*load_N", "humid*slip"}));
}

TEST(EffectCandidates, KnotCountIsLimitedByIndependentRuns) {
  // Property: with ten runs, a column that is constant within runs has at most three knots; the slip of forty
  // rows has seven.
  Trial trial = trialWith({"dust"}, [](int k) { return std::vector{0.1 * (k / 4)}; });
  for (int row = 0; row < trial.rows(); ++row) trial.run[static_cast<std::size_t>(row)] = row / 4;
  std::map<std::string, std::size_t> most;
  for (const Candidate& c : empiricalCandidates(trial, {}))
    most[c.covariate()] = std::max(most[c.covariate()], c.parts[0].knots.size());
  EXPECT_EQ(most.at("dust"), 2U);
  EXPECT_EQ(most.at("slip"), 7U);
}

TEST(EffectCandidates, StepsAreInColumnsOfOnesOwn) {
  // Property: the load has no step candidates; its curves begin at the least value of the column.
  const Trial trial = trialWith({"dust"}, [](int k) { return std::vector{0.1 * (k / 2)}; });
  const auto steps = [&](const std::string& column, double least) {
    int count = 0;
    for (const Candidate& c : empiricalCandidates(trial, {}))
      count += c.covariate() == column && c.parts[0].knots.front() > least + 1e-9;
    return count;
  };
  EXPECT_GT(steps("dust", 0.0), 0);
  EXPECT_EQ(steps("load_N", 50.0), 0);
}

}  // namespace effect_candidates_test
}  // namespace talus::terramech
