#include <algorithm>
#include <cstdio>
#include <sstream>

#include "blind_worlds.hpp"

namespace talus::blind {

std::string World::csv(bool held_rows) const {
  std::ostringstream out;
  for (std::size_t k = 0; k < columns.size(); ++k) out << (k ? "," : "") << columns[k];
  out << '\n';
  for (const auto& row : held_rows ? held : rows) {
    for (std::size_t k = 0; k < row.size(); ++k) {
      char text[40];
      std::snprintf(text, sizeof text, "%.8g", row[k]);
      out << (k ? "," : "") << text;
    }
    out << '\n';
  }
  return out.str();
}

std::string World::yaml() const {
  std::ostringstream out;
  out.precision(10);
  out << "soil: {name: hidden, cohesion_Pa: " << ground.cohesion << ", friction_angle_rad: " << ground.phi
      << ", sinkage_exponent: " << ground.n << ", cohesive_modulus: 0, frictional_modulus: " << ground.k
      << ", shear_modulus_m: " << ground.shear_k << ", c1: " << ground.c1 << ", c2: " << ground.c2
      << ", density_kg_m3: " << ground.density << "}\nmodel: wong-reece\n";
  return out.str();
}

namespace {

bool isIn(const std::vector<std::string>& list, const std::string& word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

bool locates(const Claim& claim, const Hidden& h) {
  return isIn(h.covariates, claim.covariate) && isIn(h.channels, claim.channel);
}

bool names(const Claim& claim, const Hidden& h) {
  if (h.family == "empirical") return claim.name.find("empirical") != std::string::npos;
  std::string stem = h.kind.substr(0, h.kind.find('_'));
  for (const char* word :
       {"slip_sinkage", "rear_pile", "rate", "multipass", "rebound", "hardpan", "grouser", "load_transfer",
        "flexibility", "torque_offset", "load_cell", "sinkage_datum", "drift", "slip_bias", "bulldozing"})
    if (h.kind.find(word) == 0 || h.family == word) stem = word;
  return claim.name.find(stem) != std::string::npos;
}

}  // namespace

Marks judge(const World& world, const std::vector<Claim>& claims) {
  Marks marks;
  marks.hidden = static_cast<int>(world.hidden.size());
  marks.claimed = static_cast<int>(claims.size());
  std::vector<char> used(claims.size(), 0), met(world.hidden.size(), 0);
  // Claims are first matched to hidden effects of the same name, because two effects may have one column.
  for (const bool by_name : {true, false})
    for (std::size_t h = 0; h < world.hidden.size(); ++h)
      for (std::size_t k = 0; k < claims.size(); ++k) {
        if (met[h] || used[k] || !locates(claims[k], world.hidden[h])) continue;
        if (by_name && !names(claims[k], world.hidden[h])) continue;
        met[h] = used[k] = 1;
        ++marks.located;
        marks.family += by_name;
      }
  return marks;
}

}  // namespace talus::blind
