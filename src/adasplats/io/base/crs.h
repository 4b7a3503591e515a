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
  std::vector<std::uint16_t> directory;  ///< four numbers of the whole, then four a key
  std::vector<double> doubles;
  std::string ascii;

  bool operator==(const GeoKeys&) const = default;
};

/// The coordinate reference system that a file says its coordinates are in, in the file's words:
/// nothing is looked up or translated. At most one of the two is there.
struct Crs {
  std::string wkt;  ///< well-known text (OGC 01-009, ISO 19162)
  GeoKeys keys;

  /// Whether no system is said. Keys that tell no more than units and kinds say none.
  bool empty() const;
  /// "EPSG:32632+5773 (WGS 84 / UTM zone 32N + EGM96 height)": the codes and names that are there;
  /// "without a name" where there are none, "" where no system is said.
  std::string name() const;

  bool operator==(const Crs&) const = default;
};

/// The system of a text, which may end with zeros; nothing where it is blank.
Crs crs_of_wkt(std::string_view wkt);

/// Whether coordinates of two systems can be taken together.
enum class CrsMatch : std::uint8_t {
  same,
  unclear,    ///< one is not said, or its heights are not
  different,  ///< or not known to be the same
};

/// Compares by codes (EPSG, say) where both systems have some of one authority, and UTM zones of
/// WGS 84, ETRS89 and NAD83 have by their names; else by names and the numbers of projection and
/// ellipsoid, else by the whole definition.
CrsMatch match(const Crs& a, const Crs& b);

/// A system as comments of a PLY: "adasplats.crs_wkt TEXT", or "adasplats.crs_keys NUMBERS",
/// "adasplats.crs_key_doubles NUMBERS" and "adasplats.crs_key_text "TEXT""; what is long goes on in
/// further comments of the same beginning. None where none is said.
std::vector<std::string> crs_comments(const Crs& crs);

/// The system that those comments say; `path` is for messages. Errors: data (no numbers).
Crs crs_of_comments(const std::filesystem::path& path, std::span<const std::string> comments);

/// Gathers the one system of files that are taken together.
class SharedCrs {
 public:
  /// Errors: data, naming both files and both systems, where they differ.
  void add(const std::filesystem::path& file, const Crs& crs);

  /// Of those that were said, the one that says most.
  const Crs& crs() const { return crs_; }
  /// What is to be said aloud: that some files say no system, or nothing of their heights, and are
  /// taken to be in that of another. Empty: nothing is.
  std::string warning() const;

 private:
  Crs crs_;
  std::filesystem::path said_by_;
  std::size_t files_ = 0;
  std::vector<std::filesystem::path> silent_;      ///< files that say no system
  std::vector<std::filesystem::path> heightless_;  ///< that say one without heights
};

}  // namespace adasplats
