#include <mutex>

#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <talus/planner/sampling/ompl_guard.hpp>

namespace talus::planner {
namespace {

// OMPL's log handler and seed generator are process-wide, so this state is, too.
struct Shared {
  std::mutex mutex;
  int quiet = 0;
};

Shared& shared() {
  static Shared instance;
  return instance;
}

}  // namespace

QuietOmpl::QuietOmpl() {
  const std::lock_guard lock(shared().mutex);
  if (shared().quiet++ == 0) ompl::msg::noOutputHandler();
}

QuietOmpl::~QuietOmpl() {
  const std::lock_guard lock(shared().mutex);
  if (--shared().quiet == 0) ompl::msg::restorePreviousOutputHandler();
}

void withOmplSeed(std::uint64_t seed, const std::function<void()>& make) {
  const QuietOmpl quiet;  // suppresses OMPL's warning about a second seed, which OMPL accepts
  const std::lock_guard lock(shared().mutex);
  ompl::RNG::setSeed(static_cast<std::uint_fast32_t>(seed % 0xffffffffu) + 1);
  make();
}

}  // namespace talus::planner
