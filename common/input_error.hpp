#pragma once

#include <stdexcept>
#include <string>

namespace talus {

/// Error for a file or value of the user that cannot be used. what() returns one line: "where: reason;
/// remedy".
class InputError : public std::runtime_error {
 public:
  /// The three components of the message.
  struct Parts {
    std::string where;   ///< file with line, band or cell: "site.tif, band 2" or "drive.csv:17"
    std::string reason;  ///< the fault: "no CRS"
    std::string remedy;  ///< what the user should do: "pass --resolution METRES"; may be empty
  };

  explicit InputError(Parts parts);

  const Parts& parts() const noexcept { return parts_; }

 private:
  Parts parts_;
};

}  // namespace talus
