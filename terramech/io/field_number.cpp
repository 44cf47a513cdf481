#include <charconv>
#include <system_error>

#include <talus/terramech/io/field_number.hpp>

namespace talus::terramech {

bool parseNumber(std::string_view field, double& value) noexcept {
  if (field.starts_with('+')) field.remove_prefix(1);
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  return error == std::errc{} && end == field.data() + field.size();
}

}  // namespace talus::terramech
