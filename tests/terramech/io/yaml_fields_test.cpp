#include <cstdio>
#include <fstream>
#include <set>
#include <string>

#include <talus/common/common.hpp>
#include <talus/common/nearest_name.hpp>
#include <talus/terramech/io/yaml_fields.hpp>
#include <talus/terramech/terramech_io.hpp>

namespace talus::terramech {

namespace yaml_fields_test {

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
using testing::HasSubstr;
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

}  // namespace yaml_fields_test

}  // namespace talus::terramech
