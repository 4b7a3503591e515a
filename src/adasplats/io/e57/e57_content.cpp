// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/e57/e57_content.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>
#include <pugixml.hpp>
#include <set>
#include <span>
#include <utility>

#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

constexpr std::uint64_t kMaxXmlBytes = std::uint64_t{64} << 20;
constexpr std::size_t kMaxE57Fields = 1000;
constexpr int kMaxPrototypeDepth = 64;
constexpr double kE57NormTolerance = 1e-3;  // as for trajectories
constexpr std::string_view kE57Namespace = "http://www.astm.org/COMMIT/E57/2010-e57-v";

struct StandardField {
  std::string_view field;
  std::string_view column;  ///< empty: none
};

// ASTM E2807-11, table of the fields of a point record; columns as in the other readers.
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

/// Names that the table uses itself.
constexpr std::string_view kOwnColumns[] = {"x", "y", "z", "sensor_x", "sensor_y", "sensor_z"};

/// Sets E57Field::column of all fields of a scan: "intensity", "red", ... for the standard ones
/// (returnIndex counts from 0, "return_number" from 1: its offset is raised); else the name after
/// the prefix of its extension, or with the prefix if that name is in use.
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

/// Parses the XML section. Elements of E57's own namespace lose a prefix, others keep theirs
/// ("las:classification"). Entities that a document type defines stay as they are.
pugi::xml_node parse_xml(const std::filesystem::path& path, const std::string& text,
                         pugi::xml_document& document) {
  constexpr unsigned kOptions = pugi::parse_cdata | pugi::parse_escapes | pugi::parse_trim_pcdata;
  const pugi::xml_parse_result result =
      document.load_buffer(text.data(), text.size(), kOptions, pugi::encoding_utf8);
  if (!result) {
    const auto line = 1 + std::count(text.begin(), text.begin() + result.offset, '\n');
    throw data_error({path, {}, {}},
                     "line " + std::to_string(line) + " of its XML: " + result.description());
  }
  struct PrefixRemover final : pugi::xml_tree_walker {
    std::string prefix;
    bool for_each(pugi::xml_node& node) override {
      const std::string name = node.name();
      if (name.starts_with(prefix)) node.set_name(name.substr(prefix.size()).c_str());
      return true;
    }
  } remover;
  constexpr std::string_view kDeclaration = "xmlns:";
  for (const pugi::xml_attribute attribute : document.document_element().attributes()) {
    const std::string_view name = attribute.name();
    if (!name.starts_with(kDeclaration)) continue;
    if (!std::string_view(attribute.value()).starts_with(kE57Namespace)) continue;
    remover.prefix = std::string(name.substr(kDeclaration.size())) + ":";
    document.traverse(remover);
  }
  return document.document_element();
}

/// The text of an element, possibly of several sections.
std::string text_of(const pugi::xml_node& element) {
  std::string text;
  for (const pugi::xml_node part : element.children()) text += part.value();
  return text;
}

std::vector<pugi::xml_node> elements_of(const pugi::xml_node& parent) {
  std::vector<pugi::xml_node> elements;
  for (const pugi::xml_node child : parent.children())
    if (child.type() == pugi::node_element) elements.push_back(child);
  return elements;
}

/// Reads the description of one scan. All messages begin with the scan's name.
class ScanReader {
 public:
  ScanReader(const std::filesystem::path& path, pugi::xml_node element, std::size_t number)
      : path_(path), element_(element), name_("scan " + std::to_string(number)) {
    const std::string name = text_of(element.child("name"));
    if (!name.empty()) name_ += " " + shown(name);
  }

  E57Scan read() const {
    E57Scan scan;
    scan.name = name_;
    const pugi::xml_node points = element_.child("points");
    if (!points) throw error("has no points");
    scan.points = required_number<std::uint64_t>(points, "recordCount");
    scan.section_offset = required_number<std::uint64_t>(points, "fileOffset");
    require_plain_codecs(points);
    const pugi::xml_node prototype = points.child("prototype");
    if (!prototype) throw error("has no prototype of its points");
    add_fields(prototype, scan.fields, 1);
    name_columns(scan.fields);
    set_pose(scan);
    if (const pugi::xml_node start = element_.child("acquisitionStart").child("dateTimeValue"))
      scan.start_gps_s = parsed<double>("dateTimeValue of acquisitionStart", text_of(start));
    scan.intensity_limits = intensity_limits();
    return scan;
  }

 private:
  Error error(const std::string& message) const {
    return data_error({path_, {}, {}}, name_ + ": " + message);
  }

  /// Writers leave out the number zero.
  template <class T>
  T parsed(const std::string& what, std::string_view text) const {
    if (text.empty()) return T{};
    const std::optional<T> number = parse_number<T>(text);
    if (number && std::isfinite(static_cast<double>(*number))) return *number;
    throw error(what + " is " + shown(text) + ", expected a number");
  }

  template <class T>
  T number_or(pugi::xml_node element, const char* attribute, T otherwise) const {
    const pugi::xml_attribute value = element.attribute(attribute);
    if (!value) return otherwise;
    return parsed<T>(std::string(attribute) + " of " + element.name(), value.value());
  }

  template <class T>
  T required_number(pugi::xml_node element, const char* attribute) const {
    if (*element.attribute(attribute).value() == '\0')
      throw error(std::string(element.name()) + " has no " + attribute);
    return number_or<T>(element, attribute, {});
  }

  /// The standard defines one codec, which is also the default.
  void require_plain_codecs(pugi::xml_node points) const {
    for (const pugi::xml_node codec : elements_of(points.child("codecs")))
      if (!codec.child("bitPackCodec"))
        throw error("its points have an unknown codec, only bitPackCodec is supported");
  }

  /// The values of the prototype in the order of their byte streams, structures flattened.
  void add_fields(pugi::xml_node parent, std::vector<E57Field>& fields, int depth) const {
    if (depth > kMaxPrototypeDepth)
      throw error("its prototype is nested more than " + std::to_string(kMaxPrototypeDepth) +
                  " deep");
    for (const pugi::xml_node element : elements_of(parent)) {
      const std::string type = element.attribute("type").value();
      if (type == "Structure" || type == "Vector") {
        add_fields(element, fields, depth + 1);
        continue;
      }
      if (fields.size() == kMaxE57Fields)
        throw error("its points have more than " + std::to_string(kMaxE57Fields) + " fields");
      fields.push_back(field_of(element, type));
    }
  }

  E57Field field_of(pugi::xml_node element, const std::string& type) const {
    E57Field field;
    field.name = element.name();
    if (type == "Integer" || type == "ScaledInteger") {
      field.codec = E57Codec::integer;
      using Limits = std::numeric_limits<std::int64_t>;
      field.minimum = number_or<std::int64_t>(element, "minimum", Limits::min());
      const auto maximum = number_or<std::int64_t>(element, "maximum", Limits::max());
      if (maximum < field.minimum) throw error(field.name + " has a minimum above its maximum");
      field.bits = static_cast<unsigned>(std::bit_width(static_cast<std::uint64_t>(maximum) -
                                                        static_cast<std::uint64_t>(field.minimum)));
      if (type == "ScaledInteger") {
        field.scale = number_or(element, "scale", 1.0);
        field.offset = number_or(element, "offset", 0.0);
        if (field.scale == 0) throw error(field.name + " has the scale 0");
      }
    } else if (type == "Float") {
      const std::string_view precision = element.attribute("precision").as_string("double");
      const bool is_single = precision == "single";
      if (!is_single && precision != "double")
        throw error(field.name + " has the precision " + shown(precision) +
                    ", expected single or double");
      field.codec = is_single ? E57Codec::f32 : E57Codec::f64;
      field.bits = is_single ? 32 : 64;
    } else if (type != "String") {
      throw error(field.name + " is of type " + shown(type) +
                  ", expected Integer, ScaledInteger, Float or String");
    }
    return field;
  }

  /// Nothing for an empty range: writers put 0 and 0 for unknown limits.
  std::optional<std::pair<double, double>> intensity_limits() const {
    const pugi::xml_node limits = element_.child("intensityLimits");
    const auto limit = [&](const char* name) {
      const pugi::xml_node element = limits.child(name);
      if (!element) return std::numeric_limits<double>::quiet_NaN();
      const double stored =
          parsed<double>(std::string(name) + " of its intensityLimits", text_of(element));
      if (std::string_view(element.attribute("type").value()) != "ScaledInteger") return stored;
      return stored * number_or(element, "scale", 1.0) + number_or(element, "offset", 0.0);
    };
    const double minimum = limit("intensityMinimum"), maximum = limit("intensityMaximum");
    if (!(minimum < maximum)) return std::nullopt;
    return std::pair(minimum, maximum);
  }

  void set_pose(E57Scan& scan) const {
    const pugi::xml_node pose = element_.child("pose");
    const pugi::xml_node rotation = pose.child("rotation"), translation = pose.child("translation");
    if (rotation) scan.world_from_scanner.rotation = rotation_of(rotation);
    for (int axis = 0; translation && axis < 3; ++axis)
      scan.world_from_scanner.translation[axis] =
          component(translation, std::string(1, "xyz"[axis]));
    const bool has_ranges =
        scan.field("sphericalRange") != nullptr && scan.field("cartesianX") == nullptr;
    const bool is_merged = elements_of(element_.child("originalGuids")).size() > 1;
    scan.has_scanner = (rotation || translation || has_ranges) && !is_merged;
  }

  Mat3d rotation_of(pugi::xml_node element) const {
    const double w = component(element, "w"), x = component(element, "x"),
                 y = component(element, "y"), z = component(element, "z");
    const double norm = std::sqrt(w * w + x * x + y * y + z * z);
    if (!(std::fabs(norm - 1) <= kE57NormTolerance))
      throw error("the norm of its pose's quaternion is " + exact_text(norm) + ", expected 1");
    return rotation_from_quaternion(w / norm, x / norm, y / norm, z / norm);
  }

  double component(pugi::xml_node element, const std::string& name) const {
    const std::string parent = element.name();
    const pugi::xml_node value = element.child(name.c_str());
    if (!value) throw error("the " + parent + " of its pose has no " + name);
    return parsed<double>(name + " of its pose's " + parent, text_of(value));
  }

  const std::filesystem::path& path_;
  pugi::xml_node element_;
  std::string name_;
};

}  // namespace

const E57Field* E57Scan::field(std::string_view field_name) const {
  const auto found = std::ranges::find(fields, field_name, &E57Field::name);
  return found == fields.end() ? nullptr : &*found;
}

E57Content read_e57_content(PagedFile& file) {
  if (file.xml_bytes() > kMaxXmlBytes)
    throw data_error({file.path(), {}, {}}, "its XML has " + std::to_string(file.xml_bytes()) +
                                                " bytes, expected at most " +
                                                std::to_string(kMaxXmlBytes));
  std::string text(file.xml_bytes(), '\0');
  file.read(file.xml_offset(), std::as_writable_bytes(std::span(text)));
  pugi::xml_document document;
  const pugi::xml_node root = parse_xml(file.path(), text, document);
  if (std::string_view(root.name()) != "e57Root")
    throw data_error({file.path(), {}, {}},
                     "the root of its XML is " + shown(root.name()) + ", expected 'e57Root'");
  E57Content content;
  content.coordinate_system = text_of(root.child("coordinateMetadata"));
  content.images = elements_of(root.child("images2D")).size();
  for (const pugi::xml_node scan : elements_of(root.child("data3D")))
    content.scans.push_back(ScanReader(file.path(), scan, content.scans.size()).read());
  return content;
}

}  // namespace adasplats
