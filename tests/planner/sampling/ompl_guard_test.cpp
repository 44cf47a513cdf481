#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <talus/planner/sampling/ompl_guard.hpp>

namespace talus::planner {
namespace ompl_guard_test {

class Counter : public ompl::msg::OutputHandler {
 public:
  void log(const std::string&, ompl::msg::LogLevel, const char*, int) override { ++lines; }
  int lines = 0;
};

// Property: OMPL is silent while any guard exists, with any nesting; afterwards the host's handler is
// restored.
TEST(OmplGuard, HostOutputHandlerIsRestored) {
  Counter counter;
  ompl::msg::OutputHandler* const host = ompl::msg::getOutputHandler();
  ompl::msg::useOutputHandler(&counter);
  OMPL_WARN("before");
  EXPECT_EQ(counter.lines, 1);
  {
    const QuietOmpl outer;
    OMPL_WARN("within");
    { const QuietOmpl inner; }
    OMPL_WARN("still within");
    EXPECT_EQ(counter.lines, 1);
  }
  OMPL_WARN("after");
  EXPECT_EQ(counter.lines, 2);
  ompl::msg::useOutputHandler(host);
}

std::vector<double> drawnWith(std::uint64_t seed) {
  std::vector<double> numbers;
  withOmplSeed(seed, [&] {
    ompl::RNG generator;
    for (int k = 0; k < 8; ++k) numbers.push_back(generator.uniform01());
  });
  return numbers;
}

// Property: the random numbers depend on the seed only, not on earlier draws. Seeds above 32 bits and zero,
// which OMPL ignores, are valid.
TEST(OmplGuard, RandomNumbersDependOnTheSeedOnly) {
  const auto first = drawnWith(1);
  EXPECT_NE(first, drawnWith(2));
  EXPECT_EQ(first, drawnWith(1));
  EXPECT_EQ(drawnWith(0), drawnWith(0));
  EXPECT_NE(drawnWith(0), first);
  EXPECT_NE(drawnWith(std::uint64_t{1} << 40), first);
  EXPECT_THROW(withOmplSeed(1, [] { throw std::runtime_error("made nothing"); }), std::runtime_error);
  EXPECT_EQ(first, drawnWith(1));  // the seed is not locked
}

}  // namespace ompl_guard_test
}  // namespace talus::planner
