#pragma once

#include <cstdint>
#include <functional>

namespace talus::planner {

/// Keeps OMPL's log silent while at least one of these lives, in whatever thread; then the host's own handler
/// is back.
class QuietOmpl {
 public:
  QuietOmpl();
  ~QuietOmpl();
  QuietOmpl(const QuietOmpl&) = delete;
  QuietOmpl& operator=(const QuietOmpl&) = delete;
};

/// Runs `make` while OMPL's process-wide seed generator starts from `seed` and no other thread draws from it
/// through here: what is made gets the same random numbers whatever ran before.
void withOmplSeed(std::uint64_t seed, const std::function<void()>& make);

}  // namespace talus::planner
