// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/base/column_names.h"

#include <gtest/gtest.h>

#include <vector>

namespace adasplats {
namespace {

std::string found(const std::vector<std::string>& names, PointColumn meaning) {
  Table table;
  for (const std::string& name : names) table.columns.push_back({name, std::vector<double>{}});
  const Column* const column = find_column(table, meaning);
  return column == nullptr ? "none" : column->name;
}

// Oracle: the names that these programs write.
TEST(ColumnNames, SpellingsOfPrograms) {
  const std::pair<PointColumn, std::vector<std::string>> spellings[] = {
      {PointColumn::time,
       {"GpsTime", "GPS Time", "gps_time", "scalar_GpsTime", "scalar_GPS_Time", "Gps_Time", "t",
        "T", "timestamp", "time_stamp", "TimeStamp", "offset_time", "OffsetTime", "time.s",
        "timestamp_ns", "time [us]", "Internal Time", "scalar_Time", "gps-time"}},
      {PointColumn::intensity,
       {"Intensity", "scalar_Intensity", "I", "Reflectance", "reflectivity", "remission",
        "Laser Intensity", "return_intensity", "Amplitude", "signal"}},
      {PointColumn::ring,
       {"ring", "Ring", "ring_id", "laser_id", "scalar_ring", "channel", "line", "Laser ID"}},
      {PointColumn::classification,
       {"Classification", "scalar_Classification", "label", "class", "Class_ID", "semantic_label"}},
      {PointColumn::return_number,
       {"ReturnNumber", "Return Number", "return_number", "scalar_Return_Number", "return_num"}},
      {PointColumn::number_of_returns,
       {"NumberOfReturns", "Number Of Returns", "number_of_returns", "num_returns"}},
      {PointColumn::normal_x, {"nx", "Nx", "NormalX", "normal_x", "scalar_Nx"}}};
  for (const auto& [meaning, names] : spellings)
    for (const std::string& name : names)
      EXPECT_EQ(found({"x", "y", "z", name, "other"}, meaning), name);
}

TEST(ColumnNames, TheMostCommonNameOfSeveral) {
  EXPECT_EQ(found({"amplitude", "Intensity"}, PointColumn::intensity), "Intensity");
  EXPECT_EQ(found({"t", "timestamp"}, PointColumn::time), "timestamp");
  EXPECT_EQ(found({"s", "t"}, PointColumn::time), "none");  // texture coordinates
  EXPECT_EQ(found({}, PointColumn::time), "none");
  EXPECT_EQ(found({"", "___", "scalar_"}, PointColumn::time), "none");
}

TEST(ColumnNames, UnitsOfTimes) {
  EXPECT_EQ(time_unit_of_name("timestamp_ns"), 1e-9);
  EXPECT_EQ(time_unit_of_name("time [us]"), 1e-6);
  EXPECT_EQ(time_unit_of_name("TimeMs"), 1e-3);
  EXPECT_EQ(time_unit_of_name("time (s)"), 1);
  EXPECT_EQ(time_unit_of_name("gps_time"), 1);
  EXPECT_EQ(time_unit_of_name("timestamps"), 1);
}

TEST(ColumnNames, MisspeltNames) {
  EXPECT_EQ(likely_column_name("intensty"), "intensity");
  EXPECT_EQ(likely_column_name("time_stmp"), "timestamp");
  EXPECT_EQ(likely_column_name("Clasification"), "classification");
  for (const char* const name :
       {"intensity",         "GpsTime",  "sensor_x",    "red",     "user_data",   "point",
        "scan_angle",        "column_4", "origin_kind", "laser",   "curvature",   "Deviation",
        "ClusterID",         "OriginId", "LiDAR Index", "PointId", "Reliability", "distance_m",
        "timestamp_nanosec", "UserData", "Reflection"})
    EXPECT_EQ(likely_column_name(name), std::nullopt) << name;
}

// RIEGL writes reflectances and amplitudes in decibels; LAS without intensities has zeros.
TEST(ColumnNames, IntensitiesAreLinearAndNotZero) {
  const auto chosen = [](double intensity, double reflectance, double amplitude) {
    Table table;
    table.rows = 2;
    table.columns = {{"Intensity", std::vector<double>{0, intensity}},
                     {"Reflectance", std::vector<double>{1, reflectance}},
                     {"Amplitude", std::vector<double>{1, amplitude}}};
    const Column* const column = find_column(table, PointColumn::intensity);
    return column == nullptr ? "none" : column->name;
  };
  EXPECT_EQ(chosen(5, 2, 3), "Intensity");
  EXPECT_EQ(chosen(-5, 2, 3), "Intensity");  // PTS has -2048 to 2047
  EXPECT_EQ(chosen(0, 2, 3), "Reflectance");
  EXPECT_EQ(chosen(0, -20, 3), "Amplitude");
  EXPECT_EQ(chosen(0, -20, -3), "Intensity");
}

// Oracle: the dimensions of PDAL, CloudCompare's prefix, and the fields of the specification.
TEST(ColumnNames, FieldsOfLas) {
  const std::pair<const char*, const char*> names[] = {{"scalar_ReturnNumber", "return_number"},
                                                       {"NumberOfReturns", "number_of_returns"},
                                                       {"scalar_GpsTime", "gps_time"},
                                                       {"ScanAngleRank", "scan_angle"},
                                                       {"PointSourceId", "point_source_id"},
                                                       {"EdgeOfFlightLine", "edge_of_flight_line"},
                                                       {"Infrared", "nir"},
                                                       {"Echo Width", "echo width"}};
  for (const auto& [name, field] : names) EXPECT_EQ(las_field_name(name), field);
}

TEST(ColumnNames, NanosecondsBesideSeconds) {
  const auto beside = [](const char* seconds, const char* other, double value) {
    Table table;
    table.rows = 1;
    table.columns = {{seconds, std::vector<double>{17}}, {other, std::vector<double>{value}}};
    return nanoseconds_beside(table, table.columns.front()) != nullptr;
  };
  EXPECT_TRUE(beside("timestamp_sec", "timestamp_nanosec", 5e8));
  EXPECT_TRUE(beside("stamp.secs", "stamp.nsecs", 5e8));
  EXPECT_FALSE(beside("timestamp_sec", "timestamp_ns", 1.7e18));  // the whole time
  EXPECT_FALSE(beside("timestamp_sec", "gps_time_nanosec", 5e8));
  EXPECT_FALSE(beside("timestamp", "timestamp_nanosec", 5e8));
}

}  // namespace
}  // namespace adasplats
