// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/e57/e57_columns.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <string>
#include <string_view>

namespace adasplats {
namespace {

struct StandardField {
  std::string_view field;
  std::string_view column;  ///< empty: no column of its own
};

// ASTM E2807-11, table of the fields of a point record; columns as the other readers call them.
constexpr StandardField kStandardFields[] = {{"cartesianX", ""},
                                             {"cartesianY", ""},
                                             {"cartesianZ", ""},
                                             {"sphericalRange", ""},
                                             {"sphericalAzimuth", ""},
                                             {"sphericalElevation", ""},
                                             {"cartesianInvalidState", ""},
                                             {"sphericalInvalidState", ""},
                                             {"isIntensityInvalid", ""},
                                             {"isColorInvalid", ""},
                                             {"isTimeStampInvalid", ""},
                                             {"intensity", "intensity"},
                                             {"colorRed", "red"},
                                             {"colorGreen", "green"},
                                             {"colorBlue", "blue"},
                                             {"rowIndex", "row"},
                                             {"columnIndex", "column"},
                                             {"returnIndex", "return_number"},
                                             {"returnCount", "number_of_returns"},
                                             {"timeStamp", "timestamp"}};

/// What the table has of its own.
constexpr std::string_view kOwnColumns[] = {"x", "y", "z", "sensor_x", "sensor_y", "sensor_z"};

}  // namespace

void name_columns(std::vector<E57Field>& fields) {
  std::set<std::string> taken(std::begin(kOwnColumns), std::end(kOwnColumns));
  for (const StandardField& standard : kStandardFields) taken.emplace(standard.column);
  std::set<std::string> standard_taken;
  for (E57Field& field : fields) {
    if (field.codec == E57Codec::other) continue;
    const auto standard = std::ranges::find(kStandardFields, field.name, &StandardField::field);
    if (standard != std::end(kStandardFields)) {
      if (standard_taken.insert(field.name).second) field.column = standard->column;
      if (field.name == "returnIndex") field.offset += 1;
      continue;
    }
    const std::string own = field.name.substr(field.name.find(':') + 1);
    if (taken.insert(own).second)
      field.column = own;
    else if (taken.insert(field.name).second)
      field.column = field.name;
  }
}

}  // namespace adasplats
