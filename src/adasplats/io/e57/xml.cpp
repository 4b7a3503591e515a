// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/e57/xml.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <utility>

#include "adasplats/core/error.h"
#include "adasplats/io/base/number_text.h"

namespace adasplats {
namespace {

constexpr std::string_view kXmlBlanks = " \t\r\n";
constexpr std::string_view kE57Namespace = "http://www.astm.org/COMMIT/E57/2010-e57-v";
constexpr int kMaxDepth = 64;                  // E57's own elements are not ten deep
constexpr std::size_t kMaxXmlNodes = 1000000;  // a scan has about a hundred

std::string_view without_blanks_around(std::string_view text) {
  const std::size_t begin = std::min(text.find_first_not_of(kXmlBlanks), text.size());
  return text.substr(begin, text.find_last_not_of(kXmlBlanks) + 1 - begin);
}

void append_utf8(std::string& text, std::uint32_t code) {
  const auto put_byte = [&text](std::uint32_t byte) { text += static_cast<char>(byte); };
  const auto put_rest = [&](int shift) { put_byte(0x80 | ((code >> shift) & 0x3f)); };
  if (code < 0x80) {
    put_byte(code);
  } else if (code < 0x800) {
    put_byte(0xc0 | (code >> 6));
    put_rest(0);
  } else if (code < 0x10000) {
    put_byte(0xe0 | (code >> 12));
    put_rest(6);
    put_rest(0);
  } else {
    put_byte(0xf0 | (code >> 18));
    put_rest(12);
    put_rest(6);
    put_rest(0);
  }
}

class XmlParser {
 public:
  XmlParser(const std::filesystem::path& path, std::string_view text) : path_(path), text_(text) {}

  XmlElement parse_document() {
    constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
    take(kByteOrderMark);
    skip_what_is_no_element();
    if (!take("<")) throw error("found no element");
    XmlElement root = parse_element(1);
    skip_what_is_no_element();
    // Some writers fill the section with zeros.
    if (rest().find_first_not_of('\0') != std::string_view::npos)
      throw error("found " + shown(rest().substr(0, 20)) + " behind the end of '" + root.name +
                  "'");
    return root;
  }

 private:
  std::string_view rest() const { return text_.substr(place_); }

  bool take(std::string_view word) {
    if (!rest().starts_with(word)) return false;
    place_ += word.size();
    return true;
  }

  void skip_blanks() {
    place_ = std::min(text_.find_first_not_of(kXmlBlanks, place_), text_.size());
  }

  /// The text up to `end`, which is skipped, too.
  std::string_view take_until(std::string_view end, std::string_view what) {
    const std::size_t found = text_.find(end, place_);
    if (found == std::string_view::npos) throw error(std::string(what) + " does not end");
    const std::string_view taken = text_.substr(place_, found - place_);
    place_ = found + end.size();
    return taken;
  }

  bool skip_comment_or_instruction() {
    if (take("<!--")) {
      take_until("-->", "a comment");
    } else if (take("<?")) {
      take_until("?>", "an instruction");
    } else {
      return false;
    }
    return true;
  }

  void skip_what_is_no_element() {
    do skip_blanks();
    while (skip_comment_or_instruction());
    // Definitions of entities could make a small text huge; E57 needs none.
    if (rest().starts_with("<!")) throw error("found a document type, which E57 has not");
  }

  /// What follows a "<".
  XmlElement parse_element(int depth) {
    if (depth > kMaxDepth)
      throw error("elements are more than " + std::to_string(kMaxDepth) + " deep");
    count_node();
    XmlElement element;
    const std::string name(take_name());
    bool is_empty = false;
    for (skip_blanks(); !take(">"); skip_blanks()) {
      if (take("/>")) {
        is_empty = true;
        break;
      }
      element.attributes.push_back(parse_attribute());
    }
    if (depth == 1) find_core_prefix(element.attributes);
    element.name = without_core_prefix(name);
    if (!is_empty) parse_content(element, name, depth);
    return element;
  }

  XmlAttribute parse_attribute() {
    count_node();
    XmlAttribute attribute{std::string(take_name()), {}};
    skip_blanks();
    if (!take("=")) throw error("found no '=' behind the attribute " + shown(attribute.name));
    skip_blanks();
    const std::string_view quote = rest().substr(0, 1);
    if (quote != "\"" && quote != "'")
      throw error("the value of attribute " + shown(attribute.name) + " is not in quotes");
    ++place_;
    append_text(take_until(quote, "the value of attribute " + shown(attribute.name)),
                attribute.value);
    return attribute;
  }

  void parse_content(XmlElement& element, std::string_view name, int depth) {
    while (true) {
      const std::size_t found = text_.find('<', place_);
      if (found == std::string_view::npos) throw error("element " + shown(name) + " does not end");
      append_text(text_.substr(place_, found - place_), element.text);
      place_ = found;
      if (take("<![CDATA[")) {
        element.text += take_until("]]>", "a CDATA section");
      } else if (take("</")) {
        break;
      } else if (!skip_comment_or_instruction()) {
        ++place_;
        element.children.push_back(parse_element(depth + 1));
        element.text.clear();
      }
    }
    const std::string_view end = take_name();
    skip_blanks();
    if (end != name || !take(">"))
      throw error("found the end of " + shown(end) + ", expected that of " + shown(name));
    element.text = element.children.empty() ? std::string(without_blanks_around(element.text)) : "";
  }

  std::string_view take_name() {
    constexpr std::string_view kNoName = " \t\r\n/>=<&\"'!?";
    const std::size_t end = std::min(text_.find_first_of(kNoName, place_), text_.size());
    const std::string_view name = text_.substr(place_, end - place_);
    if (name.empty()) throw error("found " + shown(rest().substr(0, 20)) + ", expected a name");
    place_ = end;
    return name;
  }

  /// Text with its entities replaced.
  void append_text(std::string_view raw, std::string& text) const {
    while (!raw.empty()) {
      const std::size_t place = std::min(raw.find('&'), raw.size());
      text += raw.substr(0, place);
      raw.remove_prefix(place);
      if (raw.empty()) return;
      const std::size_t end = raw.find(';');
      if (end == std::string_view::npos || !append_entity(raw.substr(1, end - 1), text))
        throw error("found the entity " + shown(raw.substr(0, std::min<std::size_t>(end, 12))) +
                    ", which is not known");
      raw.remove_prefix(end + 1);
    }
  }

  static bool append_entity(std::string_view name, std::string& text) {
    constexpr std::pair<std::string_view, char> kKnown[] = {
        {"lt", '<'}, {"gt", '>'}, {"amp", '&'}, {"quot", '"'}, {"apos", '\''}};
    for (const auto& [known, character] : kKnown) {
      if (known != name) continue;
      text += character;
      return true;
    }
    if (!name.starts_with('#')) return false;
    const bool is_hexadecimal = name.starts_with("#x");
    const std::string_view digits = name.substr(is_hexadecimal ? 2 : 1);
    std::uint32_t code = 0;
    const auto [stop, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), code,
                                                 is_hexadecimal ? 16 : 10);
    if (failure != std::errc() || stop != digits.data() + digits.size()) return false;
    const bool is_surrogate = code >= 0xd800 && code < 0xe000;
    if (code == 0 || code > 0x10ffff || is_surrogate) return false;
    append_utf8(text, code);
    return true;
  }

  /// E57's namespace is the default one, as a rule; a prefix that stands for it goes.
  void find_core_prefix(const std::vector<XmlAttribute>& attributes) {
    constexpr std::string_view kDeclares = "xmlns:";
    for (const XmlAttribute& attribute : attributes)
      if (attribute.name.starts_with(kDeclares) && attribute.value.starts_with(kE57Namespace))
        core_prefix_ = attribute.name.substr(kDeclares.size()) + ":";
  }

  std::string without_core_prefix(const std::string& name) const {
    const bool has_prefix = !core_prefix_.empty() && name.starts_with(core_prefix_);
    return has_prefix ? name.substr(core_prefix_.size()) : name;
  }

  void count_node() {
    if (++nodes_ > kMaxXmlNodes)
      throw error("has more than " + std::to_string(kMaxXmlNodes) + " elements and attributes");
  }

  Error error(const std::string& message) const {
    const auto line =
        1 + std::count(text_.begin(), text_.begin() + static_cast<long>(place_), '\n');
    return data_error({path_, {}, {}}, "line " + std::to_string(line) + " of its XML: " + message);
  }

  const std::filesystem::path& path_;
  std::string_view text_;
  std::size_t place_ = 0;
  std::size_t nodes_ = 0;
  std::string core_prefix_;  ///< with its colon
};

}  // namespace

const XmlElement* XmlElement::child(std::string_view child_name) const {
  const auto found = std::ranges::find(children, child_name, &XmlElement::name);
  return found == children.end() ? nullptr : &*found;
}

const std::string* XmlElement::attribute(std::string_view attribute_name) const {
  const auto found = std::ranges::find(attributes, attribute_name, &XmlAttribute::name);
  return found == attributes.end() ? nullptr : &found->value;
}

XmlElement parse_xml(const std::filesystem::path& path, std::string_view text) {
  return XmlParser(path, text).parse_document();
}

}  // namespace adasplats
