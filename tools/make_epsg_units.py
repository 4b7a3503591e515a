#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""Writes src/adasplats/io/base/epsg_unit_table.h: the projected and vertical coordinate systems of the
EPSG Geodetic Parameter Dataset (IOGP) that do not use metres, from PROJ's database (proj.db, package
proj-data).

usage: tools/make_epsg_units.py [PROJ.DB]
"""
import pathlib
import sqlite3
import sys

TARGET = pathlib.Path(__file__).parent.parent / "src/adasplats/io/base/epsg_unit_table.h"
METRE = 9001
UNITS = """
SELECT CAST(crs.code AS INT), axis.uom_code FROM {table} crs
JOIN axis ON axis.coordinate_system_auth_name = crs.coordinate_system_auth_name
 AND axis.coordinate_system_code = crs.coordinate_system_code
WHERE crs.auth_name = 'EPSG' AND axis.uom_auth_name = 'EPSG'
 AND axis.coordinate_system_order = 1 AND CAST(crs.code AS INT) <= 32766 ORDER BY 1"""
HEAD = """// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

// Written by tools/make_epsg_units.py from the EPSG Geodetic Parameter Dataset {version} of {date}
// (International Association of Oil & Gas Producers), as PROJ {proj} has it.

namespace adasplats {{

/// Codes `first` to `last` that are systems have coordinates in the unit of EPSG's code `unit`.
struct EpsgUnitRange {{
  std::uint16_t first, last, unit;
}};

/// Of systems below 20000 the last one that the table knows: others are newer.
inline constexpr std::uint16_t kNewestEpsgSystem = {newest};

// clang-format off
"""


def ranges(database, table):
    """Runs of systems with the same unit, metres left out."""
    runs = []
    for code, unit in database.execute(UNITS.format(table=table)):
        if runs and runs[-1][2] == int(unit):
            runs[-1][1] = code
        else:
            runs.append([code, code, int(unit)])
    return [run for run in runs if run[2] != METRE]


def array(name, runs):
    cells = ["{%d, %d, %d}" % tuple(run) for run in runs]
    lines = [", ".join(cells[k:k + 5]) for k in range(0, len(cells), 5)]
    return "inline constexpr EpsgUnitRange %s[] = {\n  %s};\n" % (name, ",\n  ".join(lines))


def main():
    path = sys.argv[1] if len(sys.argv) > 1 else "/usr/share/proj/proj.db"
    database = sqlite3.connect(f"file:{path}?mode=ro", uri=True)
    about = dict(database.execute("SELECT key, value FROM metadata"))
    newest = max(database.execute(
        f"SELECT MAX(CAST(code AS INT)) FROM {table} WHERE auth_name = 'EPSG' AND"
        " CAST(code AS INT) < 20000").fetchone()[0] for table in ("projected_crs", "vertical_crs"))
    text = HEAD.format(version=about["EPSG.VERSION"], date=about["EPSG.DATE"],
                       proj=about["PROJ.VERSION"], newest=newest)
    text += array("kProjectedUnits", ranges(database, "projected_crs")) + "\n"
    text += array("kVerticalUnits", ranges(database, "vertical_crs"))
    TARGET.write_text(text + "// clang-format on\n\n}  // namespace adasplats\n", encoding="ascii")


if __name__ == "__main__":
    main()
