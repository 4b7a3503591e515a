// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/base/crs.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <optional>
#include <sstream>

#include "adasplats/core/error.h"
#include "adasplats/io/base/line_reader.h"
#include "adasplats/io/base/number_text.h"
#include "adasplats/io/base/wkt.h"

namespace adasplats {
namespace {

// Keys of GeoTIFF 1.0 (section 6.2) and their values.
constexpr std::uint16_t kModelTypeKey = 1024, kRasterTypeKey = 1025, kCitationKey = 1026;
constexpr std::uint16_t kGeographicTypeKey = 2048;
constexpr std::uint16_t kGeogUnitsKey = 2052, kGeogAngularUnitsKey = 2054, kAzimuthUnitsKey = 2060;
constexpr std::uint16_t kProjectedTypeKey = 3072, kProjectedCitationKey = 3073;
constexpr std::uint16_t kLinearUnitsKey = 3076, kLastProjectionKey = 3095;
constexpr std::uint16_t kSemiMajorKey = 2057, kInverseFlatteningKey = 2059;
constexpr std::uint16_t kVerticalTypeKey = 4096, kVerticalCitationKey = 4097;
constexpr std::uint16_t kVerticalUnitsKey = 4099;
constexpr std::uint16_t kDoublesRecord = 34736, kAsciiRecord = 34737;
constexpr std::uint16_t kUserDefined = 32767;
constexpr std::size_t kKeyNumbers = 4;

/// One of the two parts of a system, horizontal or vertical.
struct Part {
  bool is_defined = false;
  std::string code;             ///< "EPSG:32632"; empty: none
  std::string name;             ///< empty: none
  std::vector<double> numbers;  ///< parameters of projection and ellipsoid, ascending
  bool is_of_keys = false;
};

struct Parts {
  Part ground, height;
};

/// Names without a meaning.
bool is_placeholder(std::string_view name) {
  const std::string lower = lower_case(name);
  return lower.empty() || lower == "unknown" || lower == "unnamed" || lower == "undefined" ||
         lower == "user-defined" || lower == "custom";
}

/// A name for comparison: lower-case letters and digits, and years without the century, so that
/// ESRI's WGS_1984_UTM_Zone_32N equals EPSG's WGS 84 / UTM zone 32N.
std::string plain_name(std::string_view name) {
  std::string plain;
  for (const char c : lower_case(name))
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) plain += c;
  for (const std::string_view year : {"1983", "1984", "1989"})
    if (const std::size_t at = plain.find(year); at != std::string::npos) plain.erase(at, 2);
  return plain;
}

/// EPSG code of a UTM zone by its name: 326zz and 327zz (WGS 84), 258zz (ETRS89), 269zz (NAD83).
std::string code_of_utm(std::string_view name) {
  struct Family {
    std::string_view prefix;
    char hemisphere;
    std::string_view thousands;
  };
  constexpr std::array<Family, 4> kFamilies = {{{"wgs84utmzone", 'n', "326"},
                                                {"wgs84utmzone", 's', "327"},
                                                {"etrs89utmzone", 'n', "258"},
                                                {"nad83utmzone", 'n', "269"}}};
  const std::string plain = plain_name(name);
  for (const Family& family : kFamilies) {
    if (!plain.starts_with(family.prefix) || !plain.ends_with(family.hemisphere)) continue;
    const std::string digits =
        plain.substr(family.prefix.size(), plain.size() - family.prefix.size() - 1);
    const auto zone = parse_number<int>(digits);
    if (!zone || *zone < 1 || *zone > 60 || digits.size() > 2) continue;
    return "EPSG:" + std::string(family.thousands) + (*zone < 10 ? "0" : "") +
           std::to_string(*zone);
  }
  return {};
}

std::string upper_case(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

std::string code_of(const WktNode& system) {
  const WktNode* const id = system.find({"authority", "id"});
  if (id == nullptr || id->values.size() < 2) return {};
  return upper_case(id->values[0]) + ":" + id->values[1];
}

/// The parameters of projection and ellipsoid. Zeros are skipped: some dialects leave them out.
void add_numbers(const WktNode& node, std::vector<double>& numbers) {
  const auto add = [&](std::size_t k) {
    if (node.values.size() <= k) return;
    const auto number = parse_number<double>(node.values[k]);
    if (number && *number != 0) numbers.push_back(*number);
  };
  if (node.is_one_of({"parameter"})) add(1);
  if (node.is_one_of({"spheroid", "ellipsoid"})) {
    add(1);
    add(2);
  }
  for (const WktNode& inner : node.nodes) add_numbers(inner, numbers);
}

Part part_of(const WktNode& system) {
  Part part;
  part.is_defined = true;
  if (!system.values.empty() && !is_placeholder(system.values[0])) part.name = system.values[0];
  part.code = code_of(system);
  if (part.code.empty()) part.code = code_of_utm(part.name);
  add_numbers(system, part.numbers);
  std::ranges::sort(part.numbers);
  return part;
}

Parts parts_of_wkt(const WktNode& system) {
  Parts parts;
  if (system.is_one_of({"boundcrs", "sourcecrs", "coordinatemetadata"}))
    return system.nodes.empty() ? parts : parts_of_wkt(system.nodes.front());
  if (system.is_one_of({"compd_cs", "compoundcrs"})) {
    for (const WktNode& inner : system.nodes) {
      const Parts of_inner = parts_of_wkt(inner);
      if (of_inner.ground.is_defined && !parts.ground.is_defined) parts.ground = of_inner.ground;
      if (of_inner.height.is_defined) parts.height = of_inner.height;
    }
    return parts;
  }
  // All keywords of systems end in these; CS itself is a part of a system.
  const bool is_system = system.keyword.ends_with("cs") || system.keyword.ends_with("crs");
  if (system.is_one_of({"vert_cs", "vertcs", "vertcrs", "verticalcrs"}))
    parts.height = part_of(system);
  else if (is_system && system.keyword != "cs")
    parts.ground = part_of(system);
  return parts;
}

/// The four numbers of a key; nothing if the directory lacks it.
std::optional<std::array<std::uint16_t, kKeyNumbers>> find_key(const GeoKeys& keys,
                                                               std::uint16_t number) {
  for (std::size_t k = kKeyNumbers; k + kKeyNumbers <= keys.directory.size(); k += kKeyNumbers)
    if (keys.directory[k] == number)
      return std::array{keys.directory[k], keys.directory[k + 1], keys.directory[k + 2],
                        keys.directory[k + 3]};
  return std::nullopt;
}

/// The value of a key in the directory itself; 0: none, or user-defined.
std::uint16_t code_of(const GeoKeys& keys, std::uint16_t number) {
  const auto key = find_key(keys, number);
  return key && (*key)[1] == 0 && (*key)[3] != kUserDefined ? (*key)[3] : std::uint16_t{0};
}

std::string text_of(const GeoKeys& keys, std::uint16_t number) {
  const auto key = find_key(keys, number);
  if (!key || (*key)[1] != kAsciiRecord || (*key)[3] >= keys.ascii.size()) return {};
  std::string text = keys.ascii.substr((*key)[3], (*key)[2]);
  text = text.substr(0, text.find_first_of(std::string_view("|\0", 2)));
  return is_placeholder(text) ? std::string() : text;
}

/// GeoTIFF 1.0 (6.3.4.1) gives some vertical systems the EPSG code of their datum: 5103, NAVD88, is
/// EPSG:5703.
std::uint16_t epsg_of_height(std::uint16_t code) {
  constexpr std::uint16_t kFirstDatum = 5101, kLastDatum = 5106, kFromDatum = 600;
  const bool is_datum = code >= kFirstDatum && code <= kLastDatum;
  return is_datum ? static_cast<std::uint16_t>(code + kFromDatum) : code;
}

bool defines_no_system(std::uint16_t key) {
  constexpr std::array<std::uint16_t, 8> kGeneralKeys = {0,
                                                         kModelTypeKey,
                                                         kRasterTypeKey,
                                                         kGeogUnitsKey,
                                                         kGeogAngularUnitsKey,
                                                         kAzimuthUnitsKey,
                                                         kLinearUnitsKey,
                                                         kVerticalUnitsKey};
  return std::ranges::find(kGeneralKeys, key) != kGeneralKeys.end();
}

bool is_projected(const GeoKeys& keys) {
  for (std::size_t k = kKeyNumbers; k < keys.directory.size(); k += kKeyNumbers) {
    const std::uint16_t key = keys.directory[k];
    if (key >= kProjectedTypeKey && key <= kLastProjectionKey && key != kLinearUnitsKey)
      return true;
  }
  return false;
}

/// The same parameters as add_numbers() finds in a text.
std::vector<double> numbers_of(const GeoKeys& keys) {
  std::vector<double> numbers;
  for (std::size_t k = kKeyNumbers; k + kKeyNumbers <= keys.directory.size(); k += kKeyNumbers) {
    const std::uint16_t key = keys.directory[k];
    const bool counts = (key > kLinearUnitsKey && key <= kLastProjectionKey) ||
                        key == kSemiMajorKey || key == kInverseFlatteningKey;
    const std::size_t place = keys.directory[k + 3];
    if (!counts || keys.directory[k + 1] != kDoublesRecord || place >= keys.doubles.size())
      continue;
    if (keys.doubles[place] != 0) numbers.push_back(keys.doubles[place]);
  }
  std::ranges::sort(numbers);
  return numbers;
}

/// Whether a key concerns the vertical system (GeoTIFF 1.0, section 6.2.4).
bool is_vertical(std::uint16_t key) {
  constexpr std::uint16_t kLastVerticalKey = 4099;
  return key >= kVerticalTypeKey && key <= kLastVerticalKey;
}

/// Whether keys define a horizontal system, or only one of heights.
bool define_ground(const GeoKeys& keys) {
  for (std::size_t k = kKeyNumbers; k + kKeyNumbers <= keys.directory.size(); k += kKeyNumbers)
    if (!defines_no_system(keys.directory[k]) && !is_vertical(keys.directory[k])) return true;
  return false;
}

Parts parts_of_keys(const GeoKeys& keys) {
  Parts parts;
  const auto epsg = [](std::uint16_t code) {
    return code == 0 ? std::string() : "EPSG:" + std::to_string(code);
  };
  parts.ground.is_defined = define_ground(keys);
  parts.ground.is_of_keys = parts.height.is_of_keys = true;
  parts.ground.numbers = numbers_of(keys);
  parts.ground.code =
      epsg(code_of(keys, is_projected(keys) ? kProjectedTypeKey : kGeographicTypeKey));
  parts.ground.name = text_of(keys, kProjectedCitationKey);
  if (parts.ground.name.empty()) parts.ground.name = text_of(keys, kCitationKey);
  if (parts.ground.code.empty()) parts.ground.code = code_of_utm(parts.ground.name);
  parts.height.code = epsg(epsg_of_height(code_of(keys, kVerticalTypeKey)));
  parts.height.name = text_of(keys, kVerticalCitationKey);
  parts.height.is_defined = !parts.height.code.empty() || !parts.height.name.empty();
  return parts;
}

Parts parts_of(const Crs& crs) {
  if (crs.wkt.empty()) return parts_of_keys(crs.keys);
  Parts parts = parts_of_wkt(parse_wkt(crs.wkt));
  if (parts.ground.is_defined || parts.height.is_defined) return parts;
  // Not a WKT: "EPSG:25832", or a text that equals only itself.
  parts.ground.is_defined = true;
  const std::size_t colon = crs.wkt.find(':');
  if (colon != std::string::npos && parse_number<unsigned>(crs.wkt.substr(colon + 1)))
    parts.ground.code = upper_case(crs.wkt);
  return parts;
}

bool are_equal(const std::vector<double>& a, const std::vector<double>& b) {
  constexpr double kTolerance = 1e-9;  // texts have at least 10 digits
  return std::ranges::equal(a, b, [](double x, double y) {
    return std::fabs(x - y) <= kTolerance * std::max(std::fabs(x), std::fabs(y));
  });
}

std::string authority_of(const std::string& code) { return code.substr(0, code.find(':')); }

/// Whether two defined parts are the same; nothing if neither codes nor names decide.
std::optional<bool> are_same(const Part& a, const Part& b) {
  if (!a.code.empty() && !b.code.empty() && authority_of(a.code) == authority_of(b.code))
    return a.code == b.code;
  if (a.name.empty() || b.name.empty()) return std::nullopt;
  if (plain_name(a.name) != plain_name(b.name)) return std::nullopt;
  return a.is_of_keys != b.is_of_keys || are_equal(a.numbers, b.numbers);
}

/// Whether the definitions are the same, regardless of their layout.
bool have_one_definition(const Crs& a, const Crs& b) {
  if (a == b) return true;
  if (a.wkt.empty() || b.wkt.empty()) return false;
  const WktNode of_a = parse_wkt(a.wkt);
  return !of_a.keyword.empty() && of_a == parse_wkt(b.wkt);
}

/// The text on one line, as comments require.
std::string one_line(std::string_view text) {
  std::string line(text);
  for (char& c : line)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  return std::string(BlankTokens(line).rest());
}

constexpr std::string_view kWktComment = "adasplats.crs_wkt ";
constexpr std::string_view kKeysComment = "adasplats.crs_keys ";
constexpr std::string_view kDoublesComment = "adasplats.crs_key_doubles ";
constexpr std::string_view kAsciiComment = "adasplats.crs_key_text ";

/// Adds `text` in lines that every reader accepts: rply, in CloudCompare and Open3D, rejects lines
/// of 1024 bytes and more.
void add_parts(std::string_view key, std::string_view text, std::vector<std::string>& comments) {
  constexpr std::size_t kMaxPartBytes = 900;
  while (!text.empty()) {
    std::size_t size = std::min(kMaxPartBytes, text.size());
    // Readers strip blanks at the ends of a comment.
    while (size > 1 && size < text.size() && (text[size - 1] == ' ' || text[size] == ' ')) --size;
    comments.push_back(std::string(key) + std::string(text.substr(0, size)));
    text.remove_prefix(size);
  }
}

template <class T>
std::vector<T> numbers_of(const std::filesystem::path& path, const std::string& text) {
  std::vector<T> numbers;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const std::optional<T> number = parse_number<T>(word);
    if (!number)
      throw data_error({path, {}, {}}, "the coordinate system has the key value " + shown(word) +
                                           ", expected a number");
    numbers.push_back(*number);
  }
  return numbers;
}

std::string files_text(std::span<const std::filesystem::path> files, std::size_t of) {
  return std::to_string(files.size()) + " of " + std::to_string(of) + " inputs (" +
         files.front().string() + (files.size() == 1 ? ")" : ", ...)");
}

}  // namespace

bool Crs::empty() const {
  if (!wkt.empty()) return false;
  for (std::size_t k = kKeyNumbers; k + kKeyNumbers <= keys.directory.size(); k += kKeyNumbers)
    if (!defines_no_system(keys.directory[k])) return false;
  return true;
}

std::string Crs::name() const {
  if (empty()) return {};
  const auto [ground, height] = parts_of(*this);
  std::string codes = ground.code;
  if (!height.code.empty())
    codes += codes.empty() ? height.code
             : authority_of(height.code) == authority_of(codes)
                 ? "+" + height.code.substr(height.code.find(':') + 1)
                 : "+" + height.code;
  std::string names = ground.name;
  if (!height.name.empty()) names += (names.empty() ? "" : " + ") + height.name;
  const std::string only = ground.is_defined ? "" : "heights only, no horizontal system: ";
  if (codes.empty()) return only + (names.empty() ? "without a name" : names);
  return only + (names.empty() ? codes : codes + " (" + names + ")");
}

Crs crs_of_wkt(std::string_view wkt) {
  wkt = wkt.substr(0, wkt.find('\0'));
  return {one_line(utf8_text(wkt)), {}};
}

CrsMatch match(const Crs& a, const Crs& b) {
  if (a.empty() && b.empty()) return CrsMatch::same;
  if (a.empty() || b.empty()) return CrsMatch::unclear;
  const Parts of_a = parts_of(a), of_b = parts_of(b);
  if (of_a.ground.is_defined && of_b.ground.is_defined) {
    const std::optional<bool> same = are_same(of_a.ground, of_b.ground);
    if (!same) return have_one_definition(a, b) ? CrsMatch::same : CrsMatch::different;
    if (!*same) return CrsMatch::different;
  } else if (of_a.ground.is_defined != of_b.ground.is_defined) {
    return CrsMatch::unclear;
  }
  if (of_a.height.is_defined != of_b.height.is_defined) return CrsMatch::unclear;
  if (!of_a.height.is_defined) return CrsMatch::same;
  const bool same = are_same(of_a.height, of_b.height).value_or(have_one_definition(a, b));
  return same ? CrsMatch::same : CrsMatch::different;
}

std::vector<std::string> crs_comments(const Crs& crs) {
  std::vector<std::string> comments;
  if (crs.empty()) return comments;
  if (!crs.wkt.empty()) {
    add_parts(kWktComment, one_line(crs.wkt), comments);
    return comments;
  }
  std::string directory, doubles, text = crs.keys.ascii;
  for (const std::uint16_t number : crs.keys.directory) directory += std::to_string(number) + " ";
  for (const double number : crs.keys.doubles) doubles += exact_text(number) + " ";
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ') c = '|';
  directory.pop_back();
  add_parts(kKeysComment, directory, comments);
  if (!doubles.empty()) {
    doubles.pop_back();
    add_parts(kDoublesComment, doubles, comments);
  }
  // Keys refer to offsets in the text, so its blanks must stay: hence the quotes.
  if (!text.empty()) add_parts(kAsciiComment, '"' + text + '"', comments);
  return comments;
}

Crs crs_of_comments(const std::filesystem::path& path, std::span<const std::string> comments) {
  const auto value = [&comments](std::string_view key) {
    std::string text;
    for (const std::string& comment : comments)
      if (comment.starts_with(key)) text += comment.substr(key.size());
    return text;
  };
  Crs crs;
  crs.wkt = value(kWktComment);
  crs.keys.directory = numbers_of<std::uint16_t>(path, value(kKeysComment));
  crs.keys.doubles = numbers_of<double>(path, value(kDoublesComment));
  const std::string text = value(kAsciiComment);
  if (text.size() > 2) crs.keys.ascii = text.substr(1, text.size() - 2);
  return crs;
}

void SharedCrs::add(const std::filesystem::path& file, const Crs& crs) {
  ++files_;
  if (crs.empty()) {
    without_crs_.push_back(file);
    return;
  }
  const CrsMatch found = match(crs_, crs);
  if (found == CrsMatch::different)
    throw Error(ErrorKind::data,
                file.string() + ": coordinate system " + crs.name() + ", but " + source_.string() +
                    " has " + crs_.name() +
                    "; the systems differ or cannot be recognized as the same: reproject the "
                    "inputs to one (e.g. 'pdal translate IN OUT reprojection "
                    "--filters.reprojection.out_srs=...')");
  const Parts parts = parts_of(crs);
  const bool has_height = parts.height.is_defined, has_ground = parts.ground.is_defined;
  if (!has_height) without_heights_.push_back(file);
  if (!has_ground) without_crs_.push_back(file);
  const bool lacks_ground = !crs_.empty() && !parts_of(crs_).ground.is_defined;
  if (crs_.empty() || (lacks_ground && has_ground) ||
      (found == CrsMatch::unclear && has_height && has_ground)) {
    crs_ = crs;
    source_ = file;
  }
}

std::string SharedCrs::warning() const {
  if (crs_.empty() || !parts_of(crs_).ground.is_defined) return {};
  std::string text;
  const std::string assumed = "; assumed " + crs_.name() + " of " + source_.string();
  if (!without_crs_.empty())
    text = "no coordinate system in " + files_text(without_crs_, files_) + assumed;
  if (parts_of(crs_).height.is_defined && !without_heights_.empty())
    text += (text.empty() ? "" : "; ") + std::string("no vertical coordinate system in ") +
            files_text(without_heights_, files_) + assumed;
  return text;
}

}  // namespace adasplats
