// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace adasplats {

/// GeoTIFF keys (GeoTIFF 1.0, section 2.4) as records 34735 to 34737 of LAS have them.
struct GeoKeys {
  std::vector<std::uint16_t> directory;  ///< a header of four numbers, then four for each key
  std::vector<double> doubles;
  std::string ascii;

  bool operator==(const GeoKeys&) const = default;
};

/// The coordinate reference system that a file states, in the form of the file: nothing is looked
/// up or translated. At most one of the two members is set.
struct Crs {
  std::string wkt;  ///< well-known text (OGC 01-009, ISO 19162)
  GeoKeys keys;

  /// Whether no system is stated. Keys with only units and model types state none.
  bool empty() const;
  /// The codes and names, "EPSG:32632+5773 (WGS 84 / UTM zone 32N + EGM96 height)"; "without a
  /// name" if there are none, "heights only, no horizontal system: EPSG:5773" without a horizontal
  /// system, "" if no system is stated.
  std::string name() const;

  bool operator==(const Crs&) const = default;
};

/// The system of a text, which may end with zeros; empty for a blank text.
Crs crs_of_wkt(std::string_view wkt);

/// Whether coordinates of two systems can be combined.
enum class CrsMatch : std::uint8_t {
  same,
  unclear,    ///< one system, or the system of its heights, is not stated
  different,  ///< or not recognized as the same
};

/// Compares codes if both systems have codes of the same authority (e.g. EPSG; names of UTM zones
/// of WGS 84, ETRS89 and NAD83 count as codes); else names and the parameters of projection and
/// ellipsoid; else the definitions.
CrsMatch match(const Crs& a, const Crs& b);

/// A system as comments of a PLY: "adasplats.crs_wkt TEXT", or "adasplats.crs_keys NUMBERS",
/// "adasplats.crs_key_doubles NUMBERS" and "adasplats.crs_key_text "TEXT"". Long values continue in
/// further comments with the same key. Empty if no system is stated.
std::vector<std::string> crs_comments(const Crs& crs);

/// The system of such comments; `path` is for messages. Errors: data (not a number).
Crs crs_of_comments(const std::filesystem::path& path, std::span<const std::string> comments);

/// Determines the common system of several files.
class SharedCrs {
 public:
  /// Errors: data, naming both files and both systems, where they differ.
  void add(const std::filesystem::path& file, const Crs& crs);

  /// The most complete of the stated systems.
  const Crs& crs() const { return crs_; }
  /// A warning that some files state no system, or none for heights, and are assumed to use that of
  /// another file; empty if all files state one.
  std::string warning() const;

 private:
  Crs crs_;
  std::filesystem::path source_;  ///< the file that states it
  std::size_t files_ = 0;
  std::vector<std::filesystem::path> without_crs_;
  std::vector<std::filesystem::path> without_heights_;  ///< stating a system without heights
};

}  // namespace adasplats
