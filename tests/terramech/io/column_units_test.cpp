#include <algorithm>
#include <filesystem>

#include <refused.hpp>

#include <talus/common/common.hpp>
#include <talus/terramech/estimate/telemetry.hpp>
#include <talus/terramech/io/column_units.hpp>
#include <talus/terramech/io/csv_reader.hpp>
#include <talus/terramech/io/terramech_io.hpp>

#include "requirement.hpp"
#include "temporary_file.hpp"

namespace talus::terramech {
namespace column_units_test {

using testing::HasSubstr;

std::string errorOf(const std::vector<std::string>& header) {
  try {
    checkColumnUnits(header, knownTelemetryColumns(), "t.csv");
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

// Property: a misspelled known column is rejected with a suggestion; any other name is accepted.
TEST(ColumnUnits, MisspelledKnownColumnIsRejectedWithASuggestion) {
  EXPECT_THAT(errorOf({"drawbar_pul_N"}), HasSubstr("write column drawbar_pull_N"));
  EXPECT_THAT(errorOf({"torqe_Nm"}), HasSubstr("write column torque_Nm"));
  EXPECT_EQ(errorOf({"drawbar_pul_N", "drawbar_pull_N"}), "");
  EXPECT_EQ(errorOf({"draw_bar_tension_N", "Fx", "dust_index"}), "");
}

// Property: a known quantity in another unit is rejected, never ignored.
TEST(ColumnUnits, KnownColumnInAnotherUnitIsRejected) {
  for (const auto& [name, write] : std::initializer_list<std::pair<const char*, const char*>>{
           {"sinkage_mm", "sinkage_m, in m (sinkage_mm times 0.001)"},
           {"sinkage_cm", "sinkage_m, in m (sinkage_cm times 0.01)"},
           {"sinkage_um", "sinkage_m, in m"},
           {"sinkage_inch", "sinkage_m, in m"},
           {"sinkage_percent", "sinkage_m, in m"},
           {"torque_mNm", "torque_Nm, in Nm (torque_mNm times 0.001)"},
           {"torque_kNm", "torque_Nm, in Nm (torque_kNm times 1000)"},
           {"torque_Ncm", "torque_Nm, in Nm (torque_Ncm times 0.01)"},
           {"drawbar_pull_kN", "drawbar_pull_N, in N (drawbar_pull_kN times 1000)"},
           {"side_force_mN", "side_force_N, in N"},
           {"load_kN", "load_N, in N"},
           {"load_kg", "load_N, in N"},
           {"load_lbf", "load_N, in N"},
           {"slip_angle_deg", "slip_angle_rad, in rad (slip_angle_deg times 0.01745329252)"},
           {"slip_pct", "slip, a number"},
           {"slip_deg", "slip, a number"},
           {"slope_percent", "slope_rad, in rad"},
           {"slope_mrad", "slope_rad, in rad"},
           {"roll_deg", "roll_rad, in rad"},
           {"pitch_degrees", "pitch_rad, in rad"},
           {"heading_deg", "heading_rad, in rad"},
           {"time_ms", "time_s, in s (time_ms times 0.001)"},
           {"time_min", "time_s, in s (time_min times 60)"},
           {"speed_kmh", "speed_mps, in mps"},
           {"speed_m_s", "speed_mps, in mps"},
           {"rim_speed_cmps", "rim_speed_mps, in mps (rim_speed_cmps times 0.01)"},
           {"rim_speed_rpm", "rim_speed_mps, in mps"},
           {"x_km", "x_m, in m"},
           {"z_mm", "z_m, in m"},
           {"wheel_radius_mm", "wheel_radius_m, in m"},
           {"wheel_width_cm", "wheel_width_m, in m"},
           {"grouser_height_mm", "grouser_height_m, in m"},
           {"shear_modulus_mm", "shear_modulus_m, in m"},
           {"shear_modulus_kPa", "shear_modulus_m, in m"}}) {
    const std::string error = errorOf({"run", name});
    EXPECT_THAT(error, HasSubstr(std::string("t.csv:1: column ") + name)) << name;
    EXPECT_THAT(error, HasSubstr(std::string("write column ") + write)) << name;
    EXPECT_EQ(error.find('\n'), std::string::npos) << name;
  }
}

TEST(ColumnUnits, AlternativeSpellingIsAcceptedBesideTheKnownColumn) {
  for (const char* name : {"sinkage_mm", "sinkage", "Sinkage_m"})
    EXPECT_EQ(errorOf({"sinkage_m", name}), "") << name;
}

TEST(ColumnUnits, KnownColumnWithoutUnitIsRejected) {
  for (const std::string& column : knownTelemetryColumns()) {
    const std::size_t end = column.rfind('_');
    if (column == "slip" || column == "pass_index" || column == "grouser_count") continue;
    if (column == "time_s" || end == 1) continue;  // may be a date or an axis
    EXPECT_THAT(errorOf({column.substr(0, end)}),
                HasSubstr("names no unit; write column " + column + ", in "));
  }
}

TEST(ColumnUnits, KnownColumnWithOtherCaseOrPunctuationIsRejected) {
  for (const char* name : {"Load_N", "load_n", "LOAD_N", "load [N]", "Load (N)", "load-N"})
    EXPECT_THAT(errorOf({name}), HasSubstr("resembles a known column; write column load_N, in N")) << name;
  EXPECT_THAT(errorOf({"Slip"}), HasSubstr("write column slip, a number"));
  EXPECT_THAT(errorOf({"slip (%)"}), HasSubstr("pass --column 'slip=slip"));
  EXPECT_THAT(errorOf({"Slip angle [\xC2\xB0]"}), HasSubstr("write column slip_angle_rad"));
  EXPECT_THAT(errorOf({"Sinkage (mm)"}), HasSubstr("write column sinkage_m"));
  EXPECT_THAT(errorOf({"speed [m/s]"}), HasSubstr("write column speed_mps"));
}

// Property: every known name is accepted, and so are other names that resemble a known name.
TEST(ColumnUnits, UserColumnsAreAccepted) {
  EXPECT_EQ(errorOf(knownTelemetryColumns()), "");
  for (const char* name : {"",
                           "run",
                           "wheel",
                           "sinkage_note",
                           "load_cell_id",
                           "temperature_C",
                           "slip_class",
                           "torque_limit",
                           "torque_limit_Nm",
                           "load_case",
                           "load_std_N",
                           "slip_long",
                           "slip_yaw",
                           "slip_fl",
                           "slip_t",
                           "slip_min",
                           "speed_min",
                           "speed_max",
                           "speed_limit_mps",
                           "sinkage_raw_mm",
                           "sink_fl_m",
                           "time_of_day",
                           "time_of_day_h",
                           "x_mps",
                           "y_N",
                           "z_rad",
                           "z_raw_m",
                           "heading_source",
                           "slope_class",
                           "roll_number",
                           "pitch_note",
                           "wheel_id",
                           "wheel_m",
                           "run_s",
                           "wheel_diameter_m",
                           "wheel_radius_class",
                           "grain_mm",
                           "moisture_percent",
                           "payload_kg",
                           "soil",
                           "soil_temperature_C",
                           "current_A",
                           "predicted_sinkage_mm",
                           "drawbar_raw",
                           "time",
                           "x",
                           "F_N",
                           "p_Pa",
                           "mm",
                           "kN",
                           "sinkage_true",
                           "dp_true",
                           "density_kg_m3",
                           "pass",
                           "grouser",
                           "side",
                           "rim"})
    EXPECT_EQ(errorOf({name}), "");
  EXPECT_EQ(errorOf({"slip", "slip_mps"}), "") << "beside the slip, a slip speed is another quantity";
}

TEST(ColumnUnits, TelemetryReaderRejectsWrongUnits) {
  const test::TemporaryFile file{"load_N,slip,sinkage_mm\n80,0.1,12\n"};
  EXPECT_REFUSED(readTelemetry(file.path(), {.required = {"load_N", "slip"}}), InputError,
                 "column sinkage_mm has another unit than the known column; write column sinkage_m, in m");
}

TEST(ColumnUnits, MeasuredDataFilesAreAccepted) {
  const char* folder = std::getenv("TALUS_MEASURED_DATA");
  TALUS_REQUIRE(folder != nullptr, "TALUS_MEASURED_DATA is not set");
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".csv") continue;
    ++files;
    std::vector<std::string> header = CsvReader(entry.path()).header();
    // These tables contain digitised points over the slope in degrees and are not telemetry, in which the
    // column would be rejected.
    if (entry.path().parent_path().filename() == "slope_slip") std::erase(header, "slope_deg");
    EXPECT_EQ(errorOf(header), "") << entry.path();
  }
  EXPECT_GE(files, 8);
}

}  // namespace column_units_test
}  // namespace talus::terramech
