// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/e57/xml.h"

#include <gtest/gtest.h>

#include <string>

#include "adasplats/io/base/test_files.h"

namespace adasplats {
namespace {

using io_test::expect_error;

XmlElement parsed_xml(const std::string& text) { return parse_xml("a.e57", text); }

TEST(Xml, ElementsAttributesAndText) {
  const XmlElement root = parsed_xml(
      "\xef\xbb\xbf<?xml version=\"1.0\"?>\n<!-- a > b -->\n"
      "<root a='1' b = \"2 '\"><one/><two type=\"Integer\" > 7\n</two ><one x=\"y\"/></root >\n");
  EXPECT_EQ(root.name, "root");
  EXPECT_EQ(root.text, "");
  ASSERT_EQ(root.children.size(), 3U);
  EXPECT_EQ(*root.attribute("a"), "1");
  EXPECT_EQ(*root.attribute("b"), "2 '");
  EXPECT_EQ(root.attribute("c"), nullptr);
  EXPECT_EQ(root.child("two")->text, "7");
  EXPECT_EQ(root.child("one"), root.children.data());
  EXPECT_EQ(root.child("three"), nullptr);
}

TEST(Xml, EntitiesAndSections) {
  const XmlElement root = parsed_xml(
      "<r a=\"&lt;&#65;&#x42;\">&amp;<!-- & --><![CDATA[<&amp;]]>&quot;&apos;&gt;&#xe9;&#x20ac;"
      "&#x1f600;</r>");
  EXPECT_EQ(*root.attribute("a"), "<AB");
  EXPECT_EQ(root.text, "&<&amp;\"'>\xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80");
}

TEST(Xml, PrefixesStayButForThatOfE57) {
  const XmlElement root = parsed_xml(
      "<e:e57Root xmlns:e=\"http://www.astm.org/COMMIT/E57/2010-e57-v1.0\" xmlns:las=\"l\">"
      "<e:data3D/><las:data3D/></e:e57Root>");
  EXPECT_EQ(root.name, "e57Root");
  EXPECT_EQ(root.children.at(0).name, "data3D");
  EXPECT_EQ(root.children.at(1).name, "las:data3D");
}

TEST(Xml, BrokenTexts) {
  const auto refused = [](const std::string& text, const std::string& part) {
    expect_error(ErrorKind::data, {"a.e57: line ", " of its XML: ", part},
                 [&] { parsed_xml(text); });
  };
  refused("", "no element");
  refused("no", "no element");
  refused("<", "expected a name");
  refused("<a", "expected a name");
  refused("<a>", "'a' does not end");
  refused("<a></b>", "the end of 'b', expected that of 'a'");
  refused("<a b></a>", "no '='");
  refused("<a b=c></a>", "not in quotes");
  refused("<a b=\"c></a>", "does not end");
  refused("<a>&lot;</a>", "'&lot'");
  refused("<a>&lt</a>", "not known");
  refused("<a>&#0;</a>", "not known");
  refused("<a>&#xd800;</a>", "not known");
  refused("<a><!-- </a>", "a comment does not end");
  refused("<a><![CDATA[ </a>", "a CDATA section does not end");
  refused("<a/><b/>", "'<b/>'");
  refused("<!DOCTYPE a [<!ENTITY b \"c\">]><a>&b;</a>", "document type");
  expect_error(ErrorKind::data, {"line 3 "}, [] { parsed_xml("<a>\n\n<b></a>"); });
}

TEST(Xml, DepthAndSizeAreBounded) {
  const auto nested = [](int depth) {
    std::string text;
    for (int k = 0; k < depth; ++k) text += "<a>";
    for (int k = 0; k < depth; ++k) text += "</a>";
    return text;
  };
  EXPECT_EQ(parsed_xml(nested(64)).name, "a");
  expect_error(ErrorKind::data, {"64 deep"}, [&] { parsed_xml(nested(65)); });
  std::string wide = "<a>";
  for (int k = 0; k < 1000000; ++k) wide += "<b/>";
  expect_error(ErrorKind::data, {"more than 1000000"}, [&] { parsed_xml(wide + "</a>"); });
}

}  // namespace
}  // namespace adasplats
