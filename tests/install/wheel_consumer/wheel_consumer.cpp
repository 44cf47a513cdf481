#include <talus/terramech/terramech.hpp>

// Uses the physics of a wheel alone, without maps and planners.
int main() {
  const talus::terramech::Soil soil{.cohesive_modulus = 1000.0, .frictional_modulus = 10000.0};
  return talus::terramech::sinkageModulus(soil, 0.1) == 20000.0 ? 0 : 1;  // Closed form: k_c / b + k_phi
}
