// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "adasplats/io/base/files_test.h"
#include "adasplats/io/base/point_files.h"
#include "adasplats/io/e57/e57_file_test.h"

// Damaged and inconsistent files, all but the first case with valid checksums.
namespace adasplats {
namespace {

using io_test::data_packet;
using io_test::E57Composer;
using io_test::float_field;
using io_test::integer_field;
using io_test::other_packet;
using io_test::put;
using io_test::sealed_e57;
using io_test::stream_of;
using io_test::xyz_fields;

void expect_rejected(const std::string& content, const std::vector<std::string>& parts) {
  const TemporaryFolder folder;
  const auto path = folder.write("a.e57", content);
  std::vector<std::string> all = {"a.e57: "};
  all.insert(all.end(), parts.begin(), parts.end());
  expect_error(ErrorKind::data, all, [&] { read_points(path); });
}

/// 200 points of 24 bytes, five pages with the XML.
E57Composer many_points() {
  E57Composer composer;
  const std::string stream = stream_of(std::vector<double>(200, 1.5));
  composer.add_scan(200, xyz_fields(), {stream, stream, stream});
  return composer;
}

/// One point, with what a scan has beside it.
E57Composer one_point(const std::string& fields, const std::string& more = "") {
  E57Composer composer;
  const std::string stream = stream_of<double>({1});
  composer.add_scan(1, fields, {stream, stream, stream}, more);
  return composer;
}

TEST(E57Errors, EveryPageIsChecked) {
  const std::string file = many_points().file();
  ASSERT_EQ(file.size(), 6 * io_test::kE57PageBytes);
  for (std::size_t page = 0; page < 6; ++page)
    for (const std::size_t within : {60U, 1019U, 1020U, 1023U}) {
      std::string damaged = file;
      damaged[page * io_test::kE57PageBytes + within] ^= 1;
      expect_rejected(damaged,
                      {"byte " + std::to_string(page * io_test::kE57PageBytes) + ": page " +
                       std::to_string(page) + " (from 0) is damaged: its checksum is 0x"});
    }
}

TEST(E57Errors, TheHeader) {
  const std::string file = many_points().file();
  const auto with = [&](std::size_t offset, auto value) {
    std::string changed = file;
    put(changed, offset, value);
    // Not sealed_e57(): it sets the length.
    const std::uint32_t crc = io_test::plain_crc32c(changed.substr(0, 1020));
    return changed.replace(1020, 4, io_test::big_endian(crc));
  };
  expect_rejected(file.substr(0, 47), {"byte 47", "within its header"});
  expect_rejected(file.substr(0, 1000), {"byte 1000", "within its first page"});
  expect_rejected(file.substr(0, 2048), {"byte 2048", "ends here, its header states 6144 bytes"});
  expect_rejected("X" + file.substr(1), {"'ASTM-E57'"});
  expect_rejected(with(8, 2U), {"version 2.0"});
  expect_rejected(with(40, std::uint64_t{0}), {"pages of 0 bytes, expected 1024"});
  expect_rejected(with(40, ~std::uint64_t{0}), {"pages of 18446744073709551615"});
  expect_rejected(with(16, std::uint64_t{0}), {"multiple of the page size"});
  expect_rejected(with(16, std::uint64_t{1025}), {"multiple of the page size"});
  expect_rejected(with(16, std::uint64_t{7168}), {"its header states 7168"});
  expect_rejected(with(24, std::uint64_t{6144}), {"the XML section", "byte 6144 of 6144"});
  expect_rejected(with(24, ~std::uint64_t{0}), {"the XML section"});
  expect_rejected(with(24, std::uint64_t{1021}), {"byte 1021", "within the checksum of a page"});
  expect_rejected(with(32, ~std::uint64_t{0}), {"bytes of XML, the file has room for"});
  expect_rejected(with(32, std::uint64_t{0}), {"line 1 of its XML: No document element"});
}

// Bytes beyond the size in the header are ignored.
TEST(E57Errors, MoreBytesThanTheHeaderStates) {
  const TemporaryFolder folder;
  EXPECT_EQ(read_points(folder.write("a.e57", many_points().file() + "more")).rows, 200U);
}

TEST(E57Errors, ContentOfTheXml) {
  E57Composer empty;
  expect_rejected(empty.file(), {"the file has no scans"});
  expect_rejected(empty.file_of_xml("<a/>"), {"the root of its XML is 'a', expected 'e57Root'"});
  expect_rejected(empty.file_of_xml("<e57Root><data3D><vectorChild/></data3D></e57Root>"),
                  {"scan 0: has no points"});
  expect_rejected(
      empty.file_of_xml("<e57Root><data3D><vectorChild><name>hall</name>"
                        "<points recordCount=\"1\" fileOffset=\"48\"/></vectorChild></data3D>"
                        "</e57Root>"),
      {"scan 0 'hall': has no prototype"});
  const std::string xy = float_field("cartesianX") + float_field("cartesianY");
  expect_rejected(one_point(xy + float_field("z")).file(), {"scan 0", "cartesianX, Y and Z"});
  expect_rejected(one_point(xy + "<cartesianZ type=\"String\"/>").file(), {"cartesianX, Y and Z"});
  expect_rejected(one_point(xy + "<cartesianZ type=\"Blob\"/>").file(),
                  {"cartesianZ is of type 'Blob'"});
  expect_rejected(one_point(xy + "<cartesianZ/>").file(), {"cartesianZ is of type ''"});
  expect_rejected(one_point(xy + "<cartesianZ type=\"Float\" precision=\"half\"/>").file(),
                  {"'half'"});
  expect_rejected(one_point(xy + integer_field("cartesianZ", 5, 4)).file(),
                  {"minimum above its maximum"});
  expect_rejected(one_point(xy + integer_field("cartesianZ", 0, 4, "scale=\"0\"")).file(),
                  {"scale 0"});
  expect_rejected(one_point(xy + integer_field("cartesianZ", 0, 4, "scale=\"nan\"")).file(),
                  {"scale of cartesianZ is 'nan'"});
  expect_rejected(
      one_point(xy + "<cartesianZ type=\"Integer\" maximum=\"9223372036854775808\"/>").file(),
      {"maximum of cartesianZ"});
  std::string fields;
  for (int k = 0; k < 1001; ++k) fields += float_field("a" + std::to_string(k));
  expect_rejected(one_point(fields).file(), {"more than 1000 fields"});
  std::string nested = xyz_fields();
  for (int k = 0; k < 65; ++k) nested = "<a type=\"Structure\">" + nested + "</a>";
  expect_rejected(one_point(nested).file(), {"nested more than 64 deep"});
}

TEST(E57Errors, XmlThatIsNotWellFormed) {
  const E57Composer empty;
  for (const char* const xml : {"", "no", "<", "<a", "<a>", "<a></b>", "<a b></a>", "<a b=c></a>",
                                "<a b=\"c></a>", "<a><!-- </a>", "<a><![CDATA[ </a>"})
    expect_rejected(empty.file_of_xml(xml), {"line 1 of its XML: "});
  expect_rejected(empty.file_of_xml("<a>\n\n<b></a>"), {"line 3 of its XML: "});
}

TEST(E57Errors, Poses) {
  const auto rejected = [](const std::vector<std::string>& numbers, const std::string& part) {
    expect_rejected(one_point(xyz_fields(), io_test::pose_element(numbers)).file(), {part});
  };
  rejected({"0", "0", "0", "0", "0", "0", "0"}, "quaternion is 0, expected 1");
  rejected({"1", "0.1", "0", "0", "0", "0", "0"}, "expected 1");
  rejected({"nan", "0", "0", "0", "0", "0", "0"},
           "w of its pose's rotation is 'nan', expected a number");
  rejected({"1", "0", "0", "0", "inf", "0", "0"},
           "x of its pose's translation is 'inf', expected a number");
  rejected({"1", "0", "0", "0", "0", "a", "0"},
           "y of its pose's translation is 'a', expected a number");
  expect_rejected(one_point(xyz_fields(), "<pose><rotation><w>1</w></rotation></pose>").file(),
                  {"has no x"});
}

TEST(E57Errors, CountsAndOffsets) {
  const auto at = [](std::uint64_t section, std::size_t points) {
    E57Composer composer = many_points();
    composer.add_scan_at(section, points, xyz_fields());
    return composer.file();
  };
  expect_rejected(at(1 << 20, 1), {"scan 1: the section of points", "byte 1048576"});
  expect_rejected(at(~std::uint64_t{0}, 1), {"the section of points"});
  expect_rejected(at(1022, 1), {"checksum"});
  expect_rejected(at(0, 1), {"byte 0", "section of kind 65"});
  expect_rejected(at(48, 1), {"scan 1: its points overlap those of scan 0"});
  expect_rejected(at(48, 300), {"room for at most 202 points, recordCount is 300"});
  expect_rejected(at(48, ~std::size_t{0}), {"recordCount is 18446744073709551615"});
  E57Composer constant;
  constant.add_scan(std::size_t{1} << 40,
                    integer_field("cartesianX", 1, 1) + integer_field("cartesianY", 1, 1) +
                        integer_field("cartesianZ", 1, 1),
                    {"", "", ""});
  expect_rejected(constant.file(), {"room for at most 0 points"});
}

TEST(E57Errors, Packets) {
  const std::string stream = stream_of<double>({1, 2});
  const std::string packet = data_packet({stream, stream, stream});
  const auto rejected = [](const std::string& packets, const std::vector<std::string>& parts) {
    E57Composer composer;
    composer.add_scan_at(composer.add_section(packets), 2, xyz_fields());
    expect_rejected(composer.file(), parts);
  };
  rejected(data_packet({stream, stream}) + other_packet('\2', 64), {"2 fields, the points have 3"});
  rejected(other_packet('\3', 64), {"byte 80", "packet of kind 3"});
  rejected(data_packet({stream, stream, ""}) + other_packet('\2', 64),
           {"0 values of cartesianZ, recordCount is 2"});
  rejected(other_packet('\2', 61) + "abc", {"no room for another packet"});
  std::string longer = packet;
  put(longer, 2, std::uint16_t{1000});
  rejected(longer, {"packet of 1001 bytes"});
  std::string shorter = packet;
  put(shorter, 2, std::uint16_t{2});
  rejected(shorter, {"packet of 3 bytes"});
  std::string within = packet;
  put(within, 6, std::uint16_t{60});
  rejected(within, {"the fields of a packet are longer than the packet"});
  std::string cut = packet;
  put(cut, 2, std::uint16_t{7});
  rejected(cut, {"the fields of a packet are longer than the packet"});
}

TEST(E57Errors, Sections) {
  const std::string file = many_points().file();
  const auto with = [&](std::size_t offset, std::uint64_t value) {
    std::string changed = file;
    put(changed, offset, value);
    return sealed_e57(changed);
  };
  expect_rejected(with(48, 2), {"byte 48", "section of kind 2"});
  expect_rejected(with(56, 31), {"section of 31 bytes"});
  expect_rejected(with(56, ~std::uint64_t{0}), {"section of 18446744073709551615 bytes"});
  expect_rejected(with(56, 3000), {"room for"});
  expect_rejected(with(64, 48), {"its first packet is outside"});
  expect_rejected(with(64, 1 << 30), {"its first packet"});
}

}  // namespace
}  // namespace adasplats
