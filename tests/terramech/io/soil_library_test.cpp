#include <cmath>
#include <cstdio>
#include <fstream>
#include <set>
#include <string>

#include <talus/common/common.hpp>
#include <talus/common/nearest_name.hpp>
#include <talus/terramech/io/soil_library.hpp>
#include <talus/terramech/io/yaml_fields.hpp>
#include <talus/terramech/mobility/slope_equilibrium.hpp>
#include <talus/terramech/terramech_io.hpp>

#include "temporary_file.hpp"

namespace talus::terramech {
namespace soil_library_test {

using testing::Contains;
using testing::HasSubstr;

const std::string kSoil =
    "cohesion_kPa: {mean: 2, std: 0.5}\n"
    "friction_angle_deg: 30\n"
    "sinkage_exponent: 0.9\n"
    "frictional_modulus_kN: 1500\n"
    "shear_modulus_cm: 2\n";

const std::string kRover =
    "name: cart\nmass_kg: 50\nwheelbase_m: 0.6\ntrack_cm: 50\nclearance_m: 0.2\nmax_torque_Nm: 10\n"
    "max_pitch_deg: 20\nsteering: ackermann\nturning_radius_m: 1.5\n"
    "wheels: {count: 4, radius_mm: 125, width_m: 0.1}\n";

std::string errorOf(const std::string& yaml, bool rover = false) {
  const test::TemporaryFile file{yaml, ".yaml"};
  try {
    rover ? void(loadRover(file.path())) : void(loadSoil(file.path()));
  } catch (const InputError& e) {
    std::string text = e.what();
    if (const auto at = text.find(file.path()); at == 0) text.erase(0, file.path().size());
    return text;
  }
  return "no error";
}

TEST(SoilLibrary, ReadsUnitsPriorsAndDefaults) {
  const test::TemporaryFile file{kSoil, ".yaml"};
  const SoilPrior soil = loadSoilPrior(file.path());
  EXPECT_DOUBLE_EQ(soil.mean.cohesion_Pa, 2000.0);
  EXPECT_DOUBLE_EQ(soil.deviation.cohesion_Pa, 500.0);
  EXPECT_DOUBLE_EQ(soil.mean.friction_angle_rad, 30.0 * kDegree);
  EXPECT_EQ(soil.deviation.friction_angle_rad, 0.0);
  EXPECT_DOUBLE_EQ(soil.mean.frictional_modulus, 1.5e6);
  EXPECT_DOUBLE_EQ(soil.mean.shear_modulus_m, 0.02);
  EXPECT_DOUBLE_EQ(soil.mean.c1, 0.43);
}

TEST(SoilLibrary, AcceptsWrapperAndListOfSoils) {
  std::string indented;
  std::stringstream lines(kSoil);
  for (std::string line; std::getline(lines, line);) indented += "    " + line + "\n";
  const test::TemporaryFile wrapped{"soil:\n" + indented, ".yaml"};
  EXPECT_DOUBLE_EQ(loadSoil(wrapped.path()).cohesion_Pa, 2000.0);
  const test::TemporaryFile list{"soils:\n  - name: a\n" + indented + "  - name: b\n" + indented, ".yaml"};
  EXPECT_EQ(loadSoil(list.path() + "#b").name, "b");
  EXPECT_EQ(loadSoils(list.path()).size(), 2U);
  EXPECT_THROW(loadSoil(list.path()), InputError);
  EXPECT_THROW(loadSoil(list.path() + "#c"), InputError);
}

TEST(SoilLibrary, SoilErrorsNameTheirLine) {
  struct Case {
    std::string yaml;
    const char* error;
  };
  for (const Case& c :
       {Case{kSoil + "cohesion_pa: 3\n", ":6: unknown key 'cohesion_pa'; did you mean cohesion_Pa?"},
        Case{"cohesion_m: 3\n", ":1: unknown key 'cohesion_m'; did you mean cohesion_Pa?"},
        Case{"cohesion_kPa: 1\nfriction_angle_deg: .nan\n" + kSoil.substr(kSoil.find("sinkage")),
             ":2: friction_angle_rad = .nan, must be finite"},
        Case{"cohesion_kPa: 1\n" + kSoil.substr(kSoil.find("friction")) + "c1: [0.4]\n", ":6: c1 is a list"},
        Case{"cohesion_kPa: -1\n" + kSoil.substr(kSoil.find("friction")),
             ":1: soil 'unnamed': cohesion_Pa = -1000, must be >= 0"},
        Case{"cohesion_kPa: 2 kPa\n", ":1: cohesion_Pa = '2 kPa', must be a number"},
        Case{kSoil + "cohesion_Pa: 5\n", "cohesion_Pa is given twice"},
        Case{kSoil + "c1: 0.4\nc1: 0.5\n", ":7: c1 appears twice"},
        Case{kSoil + "c1: 1e10\n", ":6: c1 must be 0 to 1"},
        Case{kSoil + "c1: 0.4\nc2: -3\n", ":7: c2 must be"},
        Case{"friction_angle_deg: 30\n", ":1: lacks cohesion_Pa"},
        Case{"cohesion_kPa: {mean: 2}\n", ":1: cohesion_Pa lacks its std"},
        Case{"cohesion_kPa: {mean: 2, sd: 3}\n", ":1: cohesion_Pa: unknown key 'sd'"},
        Case{"cohesion_kPa: {mean: 2, std: -3}\n", ":1: cohesion_Pa.std must be > 0"},
        // A std of 0 must not count as missing, because a missing std is replaced by the default.
        Case{"cohesion_kPa: {mean: 2, std: 0}\n", ":1: cohesion_Pa.std must be > 0; no measurement is exact"},
        Case{"- 1\n- 2\n", "the file is a list"}, Case{"just words\n", "the file is a text, no mapping"},
        Case{"a: [1\n", "not YAML"}, Case{"", "is empty"}}) {
    EXPECT_THAT(errorOf(c.yaml), HasSubstr(c.error)) << c.yaml;
  }
}

TEST(SoilLibrary, RoverErrorsNameTheirLine) {
  EXPECT_EQ(errorOf(kRover, true), "no error");
  const auto with = [](const std::string& from, const std::string& to) {
    std::string yaml = kRover;
    return yaml.replace(yaml.find(from), from.size(), to);
  };
  EXPECT_THAT(errorOf(with("mass_kg: 50", "mass_kg: -50"), true),
              HasSubstr(":2: rover 'cart': mass_kg = -50"));
  EXPECT_THAT(errorOf(with("radius_mm: 125", "radius_mm: 0"), true),
              HasSubstr(":10: rover 'cart': wheels.radius_m = 0"));
  EXPECT_THAT(errorOf(with("count: 4", "cuont: 4"), true),
              HasSubstr(":10: unknown key 'cuont'; did you mean count?"));
  EXPECT_THAT(errorOf(with("ackermann", "crab"), true),
              HasSubstr(":8: steering = 'crab'; write skid, ackermann"));
  EXPECT_THAT(errorOf(with("count: 4", "count: 4.5"), true), HasSubstr("count must be a whole number"));
  EXPECT_THAT(errorOf(with("mass_kg: 50\n", ""), true), HasSubstr("lacks mass_kg"));
  EXPECT_THAT(errorOf(with("count: 4", "grouser_height_m: 0.2, count: 4"), true),
              HasSubstr("wheels.grouser_height_m = 0.2, must be in [0, 0.125]"));
  EXPECT_THAT(errorOf(with("count: 4", "lug_thrust: 7, count: 4"), true), HasSubstr("wheels.lug_thrust = 7"));
}

TEST(SoilLibrary, ReadsARover) {
  const test::TemporaryFile file{kRover, ".yaml"};
  const Rover rover = loadRover(file.path());
  EXPECT_DOUBLE_EQ(rover.wheel.radius_m, 0.125);
  EXPECT_DOUBLE_EQ(rover.track_m, 0.5);
  EXPECT_DOUBLE_EQ(rover.max_pitch_rad, 20.0 * kDegree);
  EXPECT_EQ(rover.steering, Steering::Ackermann);
  EXPECT_DOUBLE_EQ(rover.gravity_m_s2, 9.80665);
  EXPECT_EQ(rover.wheel.lug_thrust, 0.0) << "a smooth wheel";
}

TEST(SoilLibrary, GrousersHaveDefaultThrustUnlessStated) {
  const auto thrustOf = [](const std::string& lugs) {
    std::string yaml = kRover;
    yaml.replace(yaml.find("count: 4"), 8, lugs + "count: 4");
    const test::TemporaryFile file{yaml, ".yaml"};
    return loadRover(file.path()).wheel.lug_thrust;
  };
  EXPECT_EQ(thrustOf("grouser_height_m: 0.01, grouser_count: 20, "), kLugThrust);
  EXPECT_EQ(thrustOf("grouser_height_m: 0.01, grouser_count: 20, lug_thrust: 0, "), 0.0);
  EXPECT_EQ(thrustOf("grouser_height_m: 0.01, grouser_count: 20, lug_thrust: 0.4, "), 0.4);
  EXPECT_EQ(thrustOf("grouser_height_m: 0.01, "), 0.0) << "no lug is stated";
}

TEST(SoilLibrary, UnknownNameSuggestsTheNearestEntry) {
  try {
    loadSoil("lunar_nomnal");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("did you mean lunar_nominal?"));
  }
  EXPECT_THROW(loadRover("curiosity"), InputError);
}

TEST(SoilLibrary, EveryEntryLoadsAndEveryRoverIsMobileOnMostSoils) {
  for (const auto& rover_name : libraryRovers()) {
    const Rover rover = loadRover(rover_name);
    EXPECT_EQ(rover.name, rover_name);
    int drivable = 0;
    for (const auto& soil_name : librarySoils()) {
      const Soil soil = loadSoil(soil_name);
      EXPECT_EQ(soil.name, soil_name);
      drivable += SlopeEquilibrium{soil, rover}.at({}).grip == SlopeFailure::None;
    }
    EXPECT_GE(drivable, 14) << rover_name;  // Property: these rovers have driven on such ground.
  }
}

TEST(SoilLibrary, ValuesMatchTheirSources) {
  const SoilPrior loam = loadSoilPrior("loam");
  // Printed in: thesis Table 2.1, c 2 to 4 kPa, phi 20 to 30 deg, k 1500 to 2000 kN/m^(n+2), n 0.5 to 1.2, K
  // 10 to 30 mm.
  EXPECT_NEAR(loam.mean.cohesion_Pa, 3000.0, 1e-9);
  EXPECT_NEAR(loam.deviation.cohesion_Pa, 2000.0 / std::sqrt(12.0), 1.0);
  EXPECT_NEAR(loam.deviation.friction_angle_rad, 10.0 * kDegree / std::sqrt(12.0), 1e-4);
  EXPECT_NEAR(loam.deviation.frictional_modulus, 5e5 / std::sqrt(12.0), 100.0);
  EXPECT_NEAR(loam.deviation.sinkage_exponent, 0.7 / std::sqrt(12.0), 1e-3);
  EXPECT_NEAR(loam.deviation.shear_modulus_m, 0.02 / std::sqrt(12.0), 1e-5);
  const Soil moon = loadSoil("lunar_nominal");
  EXPECT_EQ(moon.cohesive_modulus, 1400.0);
  EXPECT_EQ(moon.frictional_modulus, 820000.0);
}

TEST(SoilLibrary, EveryEntryCitesASource) {
  for (const char* kind : {"soils", "rovers"})
    for (const auto& name : kind == std::string("soils") ? librarySoils() : libraryRovers()) {
      std::ifstream file(std::string(TALUS_SOURCE_DIR) + "/terramech/library/" + kind + "/" + name + ".yaml");
      std::string line, text;
      while (std::getline(file, line)) text += line + "\n";
      EXPECT_THAT(text,
                  testing::AnyOf(HasSubstr("_19"), HasSubstr("_20"), HasSubstr("ours"), HasSubstr("Ours")))
          << name;
    }
}

TEST(TerrainClasses, AcceptsLibraryNamesInlineSoilsAndOwnList) {
  const std::string own =
      "soils:\n  - {name: mud, " + std::string(
                                       "cohesion_kPa: 1, friction_angle_deg: 10, sinkage_exponent: 1, "
                                       "frictional_modulus_kN: 500, shear_modulus_mm: 30}\n");
  const std::string body =
      "  1: loam\n  2: mud\n  7: {name: inline, cohesion_kPa: 1, friction_angle_deg: 10, "
      "sinkage_exponent: 1, frictional_modulus_kN: 500, shear_modulus_mm: 30}\n";
  for (const char* wrapper : {"terrain_classes:\n", "classes:\n"}) {
    const test::TemporaryFile file{own + wrapper + body, ".yaml"};
    const TerrainClasses classes = loadTerrainClasses(file.path());
    ASSERT_EQ(classes.size(), 3U);
    EXPECT_EQ(classes.at(1).mean.name, "loam");
    EXPECT_EQ(classes.at(2).mean.name, "mud");
    EXPECT_EQ(classes.at(7).mean.name, "inline");
  }
  const test::TemporaryFile bare{"1: sand\n3: clay\n", ".yaml"};
  EXPECT_EQ(loadTerrainClasses(bare.path()).at(3).mean.name, "clay");
}

// Property: numbers and count of classes are checked before any soil is read; the first class names an
// unknown soil.
TEST(TerrainClasses, ClassCountIsCheckedBeforeSoilsAreRead) {
  std::string all = "classes:\n  0: no_such_soil\n";
  for (int i = 1; i <= 254; ++i) all += "  " + std::to_string(i) + ": sand\n";
  const auto load = [](const std::string& text) {
    const test::TemporaryFile file{text, ".yaml"};
    loadTerrainClasses(file.path());
  };
  EXPECT_THAT([&] { load(all); },
              testing::ThrowsMessage<InputError>(HasSubstr("255 terrain classes, more than 254")));
  EXPECT_THAT([&] { load(all + "  255: sand\n"); },
              testing::ThrowsMessage<InputError>(HasSubstr(":257: class 255 is beyond 254")));
}

// Property: the error for a file without soils states that fact and quotes nothing of its content.
TEST(TerrainClasses, ErrorsDoNotDiscloseContentOfForeignFiles) {
  for (const char* foreign : {"root:x:0:0:secret:/root:/bin/sh\nsync:x:4:secret\n", "secret\n", "- secret\n",
                              "secret: word\n", "secret: {word: secret}\n", "a: [secret\n"}) {
    const test::TemporaryFile other{foreign, ".yaml"};
    const test::TemporaryFile file{"1: " + other.path() + "\n", ".yaml"};
    EXPECT_THAT([&] { loadTerrainClasses(file.path()); },
                testing::ThrowsMessage<InputError>(
                    testing::AllOf(HasSubstr(other.path()), testing::Not(HasSubstr("secret")))))
        << foreign;
  }
}

TEST(SoilLibrary, DuplicateSoilNameIsRejected) {
  const std::string soil =
      "  - {name: mud, cohesion_Pa: 1, friction_angle_deg: 10, sinkage_exponent: 1, "
      "frictional_modulus_kN: 500, shear_modulus_mm: 30}\n";
  const test::TemporaryFile file{"soils:\n" + soil + soil + "classes: {1: mud}\n", ".yaml"};
  EXPECT_THAT([&] { loadTerrainClasses(file.path()); },
              testing::ThrowsMessage<InputError>(HasSubstr(":1: holds soil 'mud' twice")));
}

TEST(TerrainClasses, ErrorsNameTheirLine) {
  const auto error = [](const std::string& yaml) -> std::string {
    const test::TemporaryFile file{yaml, ".yaml"};
    try {
      loadTerrainClasses(file.path());
    } catch (const InputError& e) {
      return e.what();
    }
    return "no error";
  };
  EXPECT_THAT(error("1: sand\n2: loan\n"), HasSubstr(":2: class 2: no soil 'loan'; did you mean loam?"));
  EXPECT_THAT(error("1: sand\ntwo: loam\n"), HasSubstr(":2: 'two' is not a class number"));
  EXPECT_THAT(error("classes: {}\n"), HasSubstr("names no terrain class"));
  // Other spellings of a class number are rejected; otherwise 01 would replace the soil of class 1.
  for (const char* key : {"01", "+1", "-1", "1.0", "0x1", "1e0", "\" 1\"", "00"})
    EXPECT_THAT(error("classes:\n  1: mars_drift\n  " + std::string(key) + ": bedrock\n"), HasSubstr(":3: '"))
        << key;
  EXPECT_THAT(error("1: mars_drift\n\"1\": bedrock\n"), HasSubstr(":2: 1 appears twice"));
  EXPECT_THAT(error("classes: {0: sand, 254: loam, 255: clay}\n"), HasSubstr(":1: class 255 is beyond 254"));
  EXPECT_THAT(error("classes: {99999999999999999999: clay}\n"), HasSubstr("is beyond 254"));
  EXPECT_THAT(error("classes: {1: sand}\nclases: {2: sand}\n"), HasSubstr(":2: unknown key 'clases'"));
}

const char* const kTwoSoils = R"(soils:
  - {name: a, cohesion_Pa: {mean: 1000, std: 100}, friction_angle_rad: 0.5, sinkage_exponent: 1.0, cohesive_modulus: {mean: 500, std: 30},
     frictional_modulus: {mean: 2.0e5, std: 400}, shear_modulus_m: 0.01}
  - {name: b, cohesion_Pa: 0, friction_angle_rad: 0.6, sinkage_exponent: 1.0, cohesive_modulus: 0,
     frictional_modulus: 1.0e6, shear_modulus_m: 0.03}
)";

TEST(SoilPriors, PriorsComeFromANameAFileOrAreEmpty) {
  EXPECT_TRUE(soilPriors("").empty());
  const std::string name = librarySoils().front();
  ASSERT_EQ(soilPriors(name).size(), 1U);
  EXPECT_EQ(soilPriors(name)[0].mean.cohesion_Pa, loadSoil(name).cohesion_Pa);
  const test::TemporaryFile file{kTwoSoils, ".yaml"};
  const auto both = soilPriors(file.path());
  ASSERT_EQ(both.size(), 2U);
  EXPECT_EQ(both[1].mean.name, "b");
  EXPECT_THROW(soilPriors("no_such_soil"), InputError);
}

TEST(SoilPriors, StrengthPriorsAndMeanShearModulusMatchTheSoils) {
  const test::TemporaryFile file{kTwoSoils, ".yaml"};
  const auto soils = soilPriors(file.path());
  const auto strengths = strengthPriors(soils);
  ASSERT_EQ(strengths.size(), 2U);
  EXPECT_DOUBLE_EQ(strengths[1].mean[1], std::tan(0.6));
  EXPECT_DOUBLE_EQ(strengths[0].covariance(0, 0), 1e4);
  EXPECT_DOUBLE_EQ(meanModulus(soils), 0.02);
}

TEST(FileKeys, KeyNamesAreUniqueAndDocumented) {
  for (const auto keys : {soilKeys(), roverKeys(), wheelKeys(), telemetryKeys()}) {
    std::set<std::string> names;
    for (const FileKey& key : keys) {
      EXPECT_TRUE(names.insert(key.name).second) << key.name;
      EXPECT_NE(std::string(key.meaning), "") << key.name;
    }
    EXPECT_EQ(namesOf(keys).size(), keys.size());
  }
}

// Property: a rover and a soil with every key are accepted.
TEST(FileKeys, EveryRoverAndSoilKeyIsAccepted) {
  const std::string wheels =
      "{count: 6, radius_m: 0.1, width_m: 0.1, grouser_height_m: 0, grouser_count: 0, lug_thrust: 0}";
  std::string rover, soil;
  for (const std::string& name : namesOf(roverKeys()))
    rover += name + ": " +
             (name == "name"                        ? "r"
              : name == "steering"                  ? "ackermann"
              : name == "wheels"                    ? wheels
              : name.starts_with("centre_of_mass_") ? "0.05"
                                                    : "0.2") +
             "\n";
  for (const std::string& name : namesOf(soilKeys()))
    soil += name + ": " + (name == "name" ? "s" : name == "rut_stiffness" ? "4" : "0.3") + "\n";
  EXPECT_EQ(readRover(YamlFields::text(rover, "r.yaml")).steering, Steering::Ackermann);
  EXPECT_EQ(readSoil(YamlFields::text(soil, "s.yaml")).mean.name, "s");
}

using testing::ElementsAre;
using testing::ThrowsMessage;

YamlFields of(const std::string& yaml) {
  return YamlFields::text(yaml, "f.yaml");
}

TEST(YamlFields, ReadsEachValueKind) {
  const YamlFields f =
      of("a_m: 2\nb: word\nc: yes\nd: [1, 2]\ne: {mean: 3, std: 1}\ng: {h: 4}\ni:\n - {h: 5}\n - {h: 6}\n");
  EXPECT_EQ(f.number("a_m"), 2.0);
  EXPECT_EQ(f.integer("a_m"), 2);
  EXPECT_EQ(f.word("b"), "word");
  EXPECT_TRUE(f.flag("c", false));
  EXPECT_THAT(f.numbers("d"), ElementsAre(1.0, 2.0));
  EXPECT_EQ(f.stated("e").std, 1.0);
  EXPECT_EQ(f.fields("g").number("h"), 4.0);
  EXPECT_EQ(f.list("i")[1].number("h"), 6.0);
  EXPECT_EQ(f.number("absent", 7.0), 7.0);
  EXPECT_EQ(f.word("absent", "x"), "x");
  EXPECT_THAT(f.names(), ElementsAre("a_m", "b", "c", "d", "e", "g", "i"));
}

TEST(YamlFields, ConvertsUnitsOfOneDimension) {
  EXPECT_DOUBLE_EQ(of("a_mm: 250").number("a_m"), 0.25);
  EXPECT_DOUBLE_EQ(of("p_kPa: [1, 2]").numbers("p_Pa")[1], 2000.0);
  EXPECT_DOUBLE_EQ(of("t_Ncm: 5").number("t_Nm"), 0.05);
  EXPECT_DOUBLE_EQ(of("v_kmph: 36").number("v_mps"), 10.0);
  EXPECT_DOUBLE_EQ(of("k_modulus_kN: 3").stated("k_modulus").value, 3000.0);
  EXPECT_FALSE(of("a_kg: 1").has("a_m"));
}

TEST(YamlFields, UnknownKeyIsRejectedWithTheNearestName) {
  EXPECT_THAT(
      [] {
        of("mass_kg: 1\nraduis_m: 2").only({"mass_kg", "radius_m"});
      },
      ThrowsMessage<InputError>("f.yaml:2: unknown key 'raduis_m'; did you mean radius_m?"));
  EXPECT_THAT([] { of("zzz: 1").only({"mass_kg"}); },
              ThrowsMessage<InputError>("f.yaml:1: unknown key 'zzz'; remove it; known are mass_kg"));
  EXPECT_NO_THROW(of("mass_g: 1\nradius_cm: 2").only({"mass_kg", "radius_m"}));
}

TEST(YamlFields, KeyWithoutUnitOrInAnotherDimensionSuggestsTheKnownKey) {
  const std::vector<std::string> known{"name", "cohesion_Pa", "shear_modulus_m", "mass_kg", "c1"};
  for (const auto& [key, meant] : {std::pair{"cohesion", "cohesion_Pa"},
                                   {"cohesion_N", "cohesion_Pa"},
                                   {"mass", "mass_kg"},
                                   {"shear_modulus_kPa", "shear_modulus_m"},
                                   {"shear_modulus", "shear_modulus_m"},
                                   {"coheson_Pa", "cohesion_Pa"}}) {
    EXPECT_EQ(meantKey(key, known), meant);
    const YamlFields fields = of(std::string(key) + ": 1");
    const std::string expected = "did you mean " + std::string(meant) + "?";
    EXPECT_THAT([&] { fields.only(known); }, ThrowsMessage<InputError>(HasSubstr(expected)));
  }
  EXPECT_EQ(meantKey("permeability", known), "");
}

TEST(YamlFields, ErrorsNameFileAndLine) {
  EXPECT_THAT([] { of("a: 1\nb: {c: x}").fields("b").number("c"); },
              ThrowsMessage<InputError>(HasSubstr("f.yaml:2: c = 'x', must be a number")));
  EXPECT_THAT([] { of("a: 1\nb: 2").fields("b"); },
              ThrowsMessage<InputError>(HasSubstr("f.yaml:2: b is '2'")));
  EXPECT_THAT([] { of("a: 1\nb: 2").list("b"); }, ThrowsMessage<InputError>(HasSubstr("f.yaml:2: b is '2'")));
  EXPECT_THAT([] { of("a: [1, .inf]").numbers("a"); },
              ThrowsMessage<InputError>(HasSubstr("must be finite")));
  EXPECT_THAT([] { of("a: maybe").flag("a", true); },
              ThrowsMessage<InputError>(HasSubstr("write true or false")));
  EXPECT_THAT([] { YamlFields::file("/nowhere.yaml"); },
              ThrowsMessage<InputError>(HasSubstr("/nowhere.yaml: cannot")));
  EXPECT_THAT([] { YamlFields::file("/tmp"); }, ThrowsMessage<InputError>(HasSubstr("is a directory")));
}

// Property: 017, which is 15 in YAML 1.1 and 17 in YAML 1.2, is rejected.
TEST(YamlFields, OctalAndHexadecimalNumbersAreRejected) {
  for (const char* octal : {"017", "-017", "+00", "0x10", "0o17"})
    EXPECT_THAT([&] { of(std::string("mass_kg: ") + octal).number("mass_kg"); },
                ThrowsMessage<InputError>(HasSubstr("f.yaml:1: mass_kg = ")))
        << octal;
  EXPECT_THAT([] { of("mass_kg: 017").number("mass_kg"); },
              ThrowsMessage<InputError>(HasSubstr("mass_kg = 017, must be decimal, without leading zeros")));
  for (const auto& [text, value] : {std::pair{"0", 0.0}, {"-0.5", -0.5}, {"0e0", 0.0}, {"10", 10.0}})
    EXPECT_EQ(of(std::string("a: ") + text).number("a"), value) << text;
}

// Property: text has at least one letter; NUL and bytes that are not UTF-8 are rejected, because they would
// invalidate output.
TEST(YamlFields, TextMustBeNonEmptyValidUtf8) {
  for (const char* empty : {"a: ''", "a: ' '", "a: \"\\t\""})
    EXPECT_THAT([&] { of(empty).word("a"); },
                ThrowsMessage<InputError>("f.yaml:1: a is empty; leave it out or give a value"))
        << empty;
  EXPECT_THAT([] { of("a: ''").texts("a"); }, ThrowsMessage<InputError>(HasSubstr("a is empty")));
  EXPECT_THAT([] { of("a: ~").word("a"); }, ThrowsMessage<InputError>(HasSubstr("a is empty")));
  EXPECT_THAT([] { of("a: \"m\\0r\"").word("a"); }, ThrowsMessage<InputError>(HasSubstr("not UTF-8")));
  EXPECT_THROW(of("\"m\\0r\": 1"), InputError);
  EXPECT_THAT([] { of(std::string("b: 1\na: m\0r", 11)); },
              ThrowsMessage<InputError>(HasSubstr("f.yaml:2: holds a NUL")));
  // Closed form: RFC 3629, section 4: the first and last letters of each length, and the bytes just outside.
  for (const char* letter :
       {"\xC2\x80", "\xE0\xA0\x80", "\xED\x9F\xBF", "\xF0\x90\x80\x80", "\xF4\x8F\xBF\xBF"})
    EXPECT_EQ(of(std::string("a: x") + letter).word("a"), std::string("x") + letter);
  for (const char* none : {"\xFF", "\x80", "\xC3", "\xC0\xAF", "\xE0\x9F\xBF", "\xED\xA0\x80",
                           "\xF0\x8F\xBF\xBF", "\xF4\x90\x80\x80"})
    EXPECT_THAT([&] { of(std::string("a: x") + none + "x").word("a"); },
                ThrowsMessage<InputError>(HasSubstr("a contains bytes that are not UTF-8")));
}

// Property: one document with its markers is read; a file with several documents is rejected.
TEST(YamlFields, AcceptsExactlyOneDocument) {
  for (const char* one : {"---\na: 1\n", "# soil\n%YAML 1.2\n--- # begins\na: 1\n...\n# end\n",
                          "--- {a: 1}\n...\n", "a: 1 # ---\nb: '\n  ---'\n", "a: 1\nc---: 2\n"})
    EXPECT_NO_THROW(of(one)) << one;
  for (const char* more :
       {"a: 1\n---\nb: 1\n", "a: 1\n---\n", "--- {a: 1}\n---\r\n", "a: 1\n...\nb: 1\n", "a: 1\n--- {b: 1}\n"})
    EXPECT_THROW(of(more), InputError) << more;
}

TEST(YamlFields, NearestNameUsesEditDistance) {
  EXPECT_EQ(nearestName("cohesion", {"cohesive", "friction"}), "cohesive");
  EXPECT_EQ(nearestName("completely_else", {"a", "b"}), "");
}

// Property: large files are rejected, because the parsed tree needs up to 360 bytes for each byte of text.
TEST(YamlFields, FileLargerThan256KilobytesIsRejected) {
  const std::string path = testing::TempDir() + "talus_large.yaml";
  std::ofstream(path) << "a: 1\n#" << std::string(262'144, ' ') << "\n";
  EXPECT_THAT([&] { YamlFields::file(path); }, ThrowsMessage<InputError>(HasSubstr("larger than 256 kB")));
  std::remove(path.c_str());
}

// Property: a field given twice, in any spelling, is rejected.
TEST(YamlFields, DuplicateFieldIsRejected) {
  const auto read = [](const std::string& yaml) {
    return [yaml] {
      const YamlFields f = of(yaml);
      f.only({"a_m", "b"});
      f.stated("a_m");
    };
  };
  EXPECT_THAT(read("a_m: 1\na_m: 2\n"), ThrowsMessage<InputError>(HasSubstr("f.yaml:2: a_m appears twice")));
  EXPECT_THAT(read("a_m: 1\n'a_m': 2\n"),
              ThrowsMessage<InputError>(HasSubstr("f.yaml:2: a_m appears twice")));
  EXPECT_THAT(read("a_m: 1\nb: 1\na_cm: 2\n"),
              ThrowsMessage<InputError>(HasSubstr("f.yaml:3: a_m is given twice")));
  EXPECT_THAT(read("a_m: {mean: 1, std: 1, mean: 2}\n"),
              ThrowsMessage<InputError>(HasSubstr("f.yaml:1: a_m: mean appears twice")));
}

}  // namespace soil_library_test
}  // namespace talus::terramech
