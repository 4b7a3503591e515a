// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include "adasplats/io/base/crs.h"

namespace adasplats {

template <class Archive>
void fields(Archive& archive, Crs& crs) {
  archive("wkt", crs.wkt);
  archive("directory", crs.keys.directory);
  archive("doubles", crs.keys.doubles);
  archive("ascii", crs.keys.ascii);
}

}  // namespace adasplats

namespace adasplats::python {

/// The properties `crs` and `crs_wkt` of a class; `of(object)` is its coordinate system.
template <class Type, class Of>
void add_crs(Type& type, Of of) {
  using Object = typename Type::type;
  type.def_property_readonly(
          "crs", [of](const Object& object) { return of(object).name(); },
          "Code and name of the coordinate system, as in the input files\n"
          "(\"EPSG:32632 (WGS 84 / UTM zone 32N)\"); empty: none in the files.")
      .def_property_readonly(
          "crs_wkt", [of](const Object& object) { return of(object).wkt; },
          "The coordinate system as well-known text; empty: none in the files, or given as\n"
          "GeoTIFF keys.");
}

}  // namespace adasplats::python
