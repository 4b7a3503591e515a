// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace adasplats {

struct XmlAttribute {
  std::string name;
  std::string value;
};

/// An element with all that is in it. Names of E57's own namespace have no prefix, others that of
/// the file ("las:classification").
struct XmlElement {
  std::string name;
  std::vector<XmlAttribute> attributes;
  std::string text;  ///< where there are no children; without blanks around it
  std::vector<XmlElement> children;

  const XmlElement* child(std::string_view child_name) const;  ///< nullptr where there is none
  const std::string* attribute(std::string_view attribute_name) const;
};

/// The root of an XML document as E57 files have them (XML 1.0 in UTF-8, no document type). `path`
/// is for messages, which count lines of the XML. Memory: at most 60 times the text. Errors: data
/// (no well-formed XML; elements deeper than 64; more than a million elements and attributes).
XmlElement parse_xml(const std::filesystem::path& path, std::string_view text);

}  // namespace adasplats
