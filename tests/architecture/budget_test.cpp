// Each module has a budget of lines, which falls with its code.
#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "source_files.hpp"

namespace talus::architecture {
namespace budget_test {

struct Budget {
  std::string module;
  long lines;
};

const Budget kBudgets[] = {{"common", 700},    {"terramech", 18190}, {"maps", 6710},     {"costmap", 11731},
                           {"planner", 21555}, {"cli", 12253},       {"examples", 1541}, {"tests", 55262}};

// A change of this many lines or more below the budget lowers it.
constexpr long kSlack = 300;

/// Lines of all sources and headers of a module, comments and empty lines included.
long linesOf(const std::string& module) {
  long lines = 0;
  for (const auto& file : files(module, {".cpp", ".hpp", ".h", ".c", ".py", ".js"})) {
    const std::string source = text(file);
    lines += std::count(source.begin(), source.end(), '\n');
  }
  return lines;
}

TEST(Budget, EachModuleKeepsItsBudgetOfLines) {
  for (const auto& [module, budget] : kBudgets) {
    const long lines = linesOf(module);
    EXPECT_LE(lines, budget) << module << " has " << lines << " lines, its budget is " << budget
                             << ": delete code, do not raise the budget";
    EXPECT_GT(lines + kSlack, budget) << module << " has " << lines << " lines, its budget is " << budget
                                      << ": lower the budget to " << lines << " with the code";
  }
}

}  // namespace budget_test
}  // namespace talus::architecture
