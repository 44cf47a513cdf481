#include <utility>

#include <talus/common/input_error.hpp>

namespace talus {
namespace {

std::string line(const InputError::Parts& p) {
  return p.where + ": " + p.reason + (p.remedy.empty() ? "" : "; " + p.remedy);
}

}  // namespace

InputError::InputError(Parts parts) : std::runtime_error(line(parts)), parts_(std::move(parts)) {}

}  // namespace talus
