#include <talus.h>

#include <talus/terramech/contact/rover.hpp>
#include <talus/terramech/contact/soil.hpp>

void talus_default_rover(talus_rover* rover) {
  if (rover == nullptr) return;
  const talus::terramech::Rover usual;
  *rover = talus_rover{};
  rover->size = sizeof *rover;
  rover->wheel_count = usual.wheel_count;
  rover->gravity_m_s2 = usual.gravity_m_s2;
  rover->max_pitch_rad = usual.max_pitch_rad;
  rover->max_roll_rad = usual.max_roll_rad;
  rover->max_speed_mps = usual.max_speed_mps;
}

void talus_default_soil(talus_soil* soil) {
  if (soil == nullptr) return;
  const talus::terramech::Soil usual;
  *soil = talus_soil{};
  soil->size = sizeof *soil;
  soil->sinkage_exponent = usual.sinkage_exponent;
  soil->shear_modulus_m = usual.shear_modulus_m;
}

void talus_default_options(talus_options* options) {
  if (options == nullptr) return;
  *options = talus_options{};
  options->size = sizeof *options;
  options->threads = 1;
  options->seed = 1;
}
