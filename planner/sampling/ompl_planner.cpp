#include <stdexcept>

#include <ompl/base/SpaceInformation.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/planners/fmt/FMT.h>
#include <ompl/geometric/planners/informedtrees/ABITstar.h>
#include <ompl/geometric/planners/sst/SST.h>

#include <talus/planner/sampling/ompl_guard.hpp>
#include <talus/planner/sampling/ompl_planner.hpp>
#include <talus/planner/sampling/seeded_rrt_star.hpp>

namespace talus::planner {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

ob::PlannerPtr rrtStar(const PlannerParts& parts, bool informed) {
  auto planner = std::make_shared<SeededRRTstar>(
      parts.space,
      SeededRRTstar::Seed{.route = parts.known_route, .spacing_m = parts.range_m / 4, .informed = informed});
  planner->setRange(parts.range_m);
  return planner;
}

template <typename Bit>
ob::PlannerPtr bitStar(const PlannerParts& parts) {
  auto planner = std::make_shared<Bit>(parts.space);
  planner->setUseKNearest(true);
  planner->setSamplesPerBatch(500);
  planner->setPruning(false);  // pruning needs a measure of the informed set, which has no closed form here
  return planner;
}

ob::PlannerPtr sst(const PlannerParts& parts) {
  auto planner = std::make_shared<og::SST>(parts.space);
  planner->setRange(parts.range_m);
  planner->setSelectionRadius(parts.range_m / 4);
  planner->setPruningRadius(parts.range_m / 16);
  return planner;
}

// FMT* [janson_2015], restarted with twice the samples until stopped. OMPL's FMT measures distance by the
// cost of motions, which is no metric here; its own continuation ("extended") reads past the end of empty
// neighbourhoods.
class RestartedFMT : public og::FMT {
 public:
  explicit RestartedFMT(const ob::SpaceInformationPtr& space) : FMT(space) {
    setExtendedFMT(false);
    setNearestK(false);
    setNumSamples(200);
  }

  void setup() override {
    FMT::setup();
    nn_->setDistanceFunction(
        [this](const Motion* a, const Motion* b) { return si_->distance(a->getState(), b->getState()); });
  }

  ob::PlannerStatus solve(const ob::PlannerTerminationCondition& done) override {
    bool solved = false;
    for (;;) {
      solved = bool(FMT::solve(done)) || solved;
      if (done) return {solved, false};
      clear();
      setup();
      setNumSamples(2 * getNumSamples());
    }
  }
};

ob::PlannerPtr named(const std::string& name, const PlannerParts& parts) {
  if (name == "RRTstar") return rrtStar(parts, false);
  if (name == "InformedRRTstar") return rrtStar(parts, true);
  if (name == "BITstar") return bitStar<og::BITstar>(parts);
  if (name == "ABITstar") return bitStar<og::ABITstar>(parts);
  if (name == "SST") return sst(parts);
  if (name == "FMT") return std::make_shared<RestartedFMT>(parts.space);
  return nullptr;
}

void setParameters(ob::Planner& planner, const std::string& name,
                   const std::map<std::string, std::string>& parameters) {
  for (const auto& [key, value] : parameters) {
    if (!planner.params().hasParam(key)) {
      std::vector<std::string> known;
      planner.params().getParamNames(known);
      std::string list;
      for (const std::string& k : known) list += (list.empty() ? "" : ", ") + k;
      throw std::invalid_argument("planner '" + name + "' has no parameter '" + key + "'; it has " + list);
    }
    bool taken = false;
    try {
      taken = planner.params().setParam(key, value);
    } catch (const std::exception&) {  // not a number
    }
    if (!taken)
      throw std::invalid_argument("planner '" + name + "': parameter " + key + " does not take '" + value +
                                  "'");
  }
}

// Planner on a unit plane without a problem.
ob::PlannerPtr unbound(const std::string& name) {
  const auto plane = std::make_shared<ob::RealVectorStateSpace>(2);
  plane->setBounds(0.0, 1.0);
  return named(name,
               {.space = std::make_shared<ob::SpaceInformation>(plane), .definition = {}, .known_route = {}});
}

}  // namespace

bool isOmpls(const std::string& name) {
  return unbound(name) != nullptr;
}

void checkParameters(const std::string& name, const std::map<std::string, std::string>& parameters) {
  const QuietOmpl quiet;
  const ob::PlannerPtr planner = unbound(name);
  if (!planner)
    throw std::invalid_argument("planner '" + name +
                                "' is not an OMPL planner; only those begin cold or take parameters");
  setParameters(*planner, name, parameters);
}

ob::PlannerPtr makeOmplPlanner(const std::string& name, const PlannerParts& parts) {
  ob::PlannerPtr planner;
  withOmplSeed(parts.seed, [&] {
    planner = named(name, parts);
    if (!planner) return;
    setParameters(*planner, name, parts.parameters);
    planner->setProblemDefinition(parts.definition);
    planner->setup();
  });
  return planner;
}

}  // namespace talus::planner
