// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/e57/e57_content.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "adasplats/io/base/number_text.h"
#include "adasplats/io/e57/e57_columns.h"
#include "adasplats/io/e57/xml.h"

namespace adasplats {
namespace {

constexpr std::uint64_t kMaxXmlBytes = std::uint64_t{64} << 20;
constexpr std::size_t kMaxE57Fields = 1000;
constexpr double kE57NormTolerance = 1e-3;  // as of trajectories

/// Reads what one scan says. All messages begin with the scan's name.
class ScanReader {
 public:
  ScanReader(const std::filesystem::path& path, const XmlElement& element, std::size_t number)
      : path_(path), element_(element), name_("scan " + std::to_string(number)) {
    if (const XmlElement* const name = element.child("name"); name && !name->text.empty())
      name_ += " " + shown(name->text);
  }

  E57Scan read() const {
    E57Scan scan;
    scan.name = name_;
    const XmlElement* const points = element_.child("points");
    if (points == nullptr) throw error("has no points");
    scan.points = required_number<std::uint64_t>(*points, "recordCount");
    scan.section_offset = required_number<std::uint64_t>(*points, "fileOffset");
    require_plain_codecs(*points);
    const XmlElement* const prototype = points->child("prototype");
    if (prototype == nullptr) throw error("has no prototype of its points");
    add_fields(*prototype, scan.fields);
    name_columns(scan.fields);
    take_pose(scan);
    if (const XmlElement* const start = element_.child("acquisitionStart"))
      if (const XmlElement* const value = start->child("dateTimeValue"))
        scan.start_gps_s = parsed<double>("dateTimeValue of acquisitionStart", value->text);
    scan.intensity_limits = intensity_limits();
    return scan;
  }

 private:
  Error error(const std::string& message) const {
    return data_error({path_, {}, {}}, name_ + ": " + message);
  }

  /// Numbers of zero are written as nothing at all.
  template <class T>
  T parsed(const std::string& what, std::string_view text) const {
    if (text.empty()) return T{};
    const std::optional<T> number = parse_number<T>(text);
    if (number && std::isfinite(static_cast<double>(*number))) return *number;
    throw error(what + " is " + shown(text) + ", expected a number");
  }

  template <class T>
  T number_or(const XmlElement& element, std::string_view attribute, T otherwise) const {
    const std::string* const text = element.attribute(attribute);
    return text == nullptr ? otherwise
                           : parsed<T>(std::string(attribute) + " of " + element.name, *text);
  }

  template <class T>
  T required_number(const XmlElement& element, std::string_view attribute) const {
    const std::string* const text = element.attribute(attribute);
    if (text == nullptr || text->empty())
      throw error(element.name + " has no " + std::string(attribute));
    return number_or<T>(element, attribute, {});
  }

  /// The standard has one codec, which is meant where none is named.
  void require_plain_codecs(const XmlElement& points) const {
    const XmlElement* const codecs = points.child("codecs");
    if (codecs == nullptr) return;
    for (const XmlElement& codec : codecs->children)
      if (codec.child("bitPackCodec") == nullptr)
        throw error("its points have a codec that is not bitPackCodec, the only one known");
  }

  /// The values of the prototype in the order of their byte streams, those within structures, too.
  void add_fields(const XmlElement& parent, std::vector<E57Field>& fields) const {
    for (const XmlElement& element : parent.children) {
      const std::string* const type = element.attribute("type");
      if (type != nullptr && (*type == "Structure" || *type == "Vector")) {
        add_fields(element, fields);
        continue;
      }
      if (fields.size() == kMaxE57Fields)
        throw error("its points have more than " + std::to_string(kMaxE57Fields) + " fields");
      fields.push_back(field_of(element, type == nullptr ? "" : *type));
    }
  }

  E57Field field_of(const XmlElement& element, const std::string& type) const {
    E57Field field;
    field.name = element.name;
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
      const std::string* const precision = element.attribute("precision");
      const bool is_single = precision != nullptr && *precision == "single";
      if (precision != nullptr && !is_single && *precision != "double")
        throw error(field.name + " has the precision " + shown(*precision) +
                    ", expected single or double");
      field.codec = is_single ? E57Codec::f32 : E57Codec::f64;
      field.bits = is_single ? 32 : 64;
    } else if (type != "String") {
      throw error(field.name + " is of type " + shown(type) +
                  ", expected Integer, ScaledInteger, Float or String");
    }
    return field;
  }

  /// None where they bound nothing: writers put 0 and 0 for what they do not know.
  std::optional<std::pair<double, double>> intensity_limits() const {
    const XmlElement* const limits = element_.child("intensityLimits");
    const auto limit = [&](const char* name) {
      const XmlElement* const one = limits == nullptr ? nullptr : limits->child(name);
      if (one == nullptr) return std::numeric_limits<double>::quiet_NaN();
      const double stored =
          parsed<double>(std::string(name) + " of its intensityLimits", one->text);
      const std::string* const type = one->attribute("type");
      if (type == nullptr || *type != "ScaledInteger") return stored;
      return stored * number_or(*one, "scale", 1.0) + number_or(*one, "offset", 0.0);
    };
    const double least = limit("intensityMinimum"), most = limit("intensityMaximum");
    if (!(least < most)) return std::nullopt;
    return std::pair(least, most);
  }

  void take_pose(E57Scan& scan) const {
    const XmlElement* const pose = element_.child("pose");
    const XmlElement* const rotation = pose == nullptr ? nullptr : pose->child("rotation");
    const XmlElement* const translation = pose == nullptr ? nullptr : pose->child("translation");
    if (rotation != nullptr) scan.world_from_scanner.rotation = rotation_of(*rotation);
    for (int axis = 0; translation != nullptr && axis < 3; ++axis)
      scan.world_from_scanner.translation[axis] =
          part_of(*translation, std::string(1, "xyz"[axis]));
    const bool has_pose = rotation != nullptr || translation != nullptr;
    const bool has_ranges =
        scan.field("sphericalRange") != nullptr && scan.field("cartesianX") == nullptr;
    const XmlElement* const sources = element_.child("originalGuids");
    const bool is_merged = sources != nullptr && sources->children.size() > 1;
    scan.has_scanner = (has_pose || has_ranges) && !is_merged;
  }

  Mat3d rotation_of(const XmlElement& element) const {
    const double w = part_of(element, "w"), x = part_of(element, "x"), y = part_of(element, "y"),
                 z = part_of(element, "z");
    const double norm = std::sqrt(w * w + x * x + y * y + z * z);
    if (!(std::fabs(norm - 1) <= kE57NormTolerance))
      throw error("the norm of its pose's quaternion is " + exact_text(norm) + ", expected 1");
    return rotation_from_quaternion(w / norm, x / norm, y / norm, z / norm);
  }

  double part_of(const XmlElement& element, const std::string& name) const {
    const XmlElement* const part = element.child(name);
    if (part == nullptr) throw error("the " + element.name + " of its pose has no " + name);
    return parsed<double>(name + " of its pose's " + element.name, part->text);
  }

  const std::filesystem::path& path_;
  const XmlElement& element_;
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
                                                " bytes, at most " + std::to_string(kMaxXmlBytes) +
                                                " are read");
  std::string text(file.xml_bytes(), '\0');
  file.read(file.xml_offset(), std::as_writable_bytes(std::span(text)));
  const XmlElement root = parse_xml(file.path(), text);
  if (root.name != "e57Root")
    throw data_error({file.path(), {}, {}},
                     "its XML is of " + shown(root.name) + ", expected 'e57Root'");
  E57Content content;
  if (const XmlElement* const system = root.child("coordinateMetadata"))
    content.coordinate_system = system->text;
  if (const XmlElement* const images = root.child("images2D"))
    content.images = images->children.size();
  if (const XmlElement* const scans = root.child("data3D"))
    for (const XmlElement& scan : scans->children)
      content.scans.push_back(ScanReader(file.path(), scan, content.scans.size()).read());
  return content;
}

}  // namespace adasplats
