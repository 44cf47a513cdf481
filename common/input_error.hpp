#pragma once

#include <stdexcept>
#include <string>

namespace talus {

/// A file or a value handed in by the user cannot be used; what() is one line: what, where, remedy.
class InputError : public std::runtime_error {
 public:
  /// The parts of the line. `where` is a path with a line, band or cell; `remedy` is what to do about it.
  struct Parts {
    std::string where;   ///< "site.tif, band 2" or "drive.csv:17"
    std::string reason;  ///< "no CRS"
    std::string remedy;  ///< "pass --resolution METRES"; may be empty
  };

  explicit InputError(Parts parts);

  const Parts& parts() const noexcept { return parts_; }

 private:
  Parts parts_;
};

}  // namespace talus
