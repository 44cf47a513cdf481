#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace talus {

/// Error thrown if a file or value that the user supplies cannot be used. what() returns one line: "where:
/// reason; remedy".
class InputError : public std::runtime_error {
 public:
  /// The three parts of the message.
  struct Parts {
    std::string where;   ///< location of the fault: "site.tif, band 2" or "drive.csv:17" (line)
    std::string reason;  ///< the fault, for example "no CRS"
    std::string remedy;  ///< action for the user, for example "pass --resolution METRES"; may be empty
  };

  explicit InputError(Parts parts)
      : std::runtime_error(parts.where + ": " + parts.reason + (parts.remedy.empty() ? "" : "; ") +
                           parts.remedy),
        parts_(std::move(parts)) {}

  const Parts& parts() const noexcept { return parts_; }

 private:
  Parts parts_;
};

}  // namespace talus
