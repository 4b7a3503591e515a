// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/arrays/npz.h"

#include <zlib.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

#include "adasplats/core/error.h"
#include "adasplats/io/base/atomic_file.h"

namespace adasplats {
namespace {

// Layout: PKWARE, "APPNOTE.TXT - .ZIP File Format Specification", 4.3.7, 4.3.12 and 4.3.16.
constexpr std::uint32_t kLocalHeader = 0x04034b50;
constexpr std::uint32_t kCentralHeader = 0x02014b50;
constexpr std::uint32_t kEndOfCentral = 0x06054b50;
constexpr std::size_t kLocalHeaderBytes = 30;
constexpr std::uint16_t kVersion = 20;              // stored files need only 2.0
constexpr std::uint16_t kFirstDay = 1 << 5 | 1;     // 1 January 1980
constexpr std::uint64_t kZipLimit = 0xffffffffULL;  // larger sizes and offsets need Zip64

/// Numbers in little-endian order.
class Bytes {
 public:
  Bytes& u16(std::uint64_t value) { return put(value, 2); }
  Bytes& u32(std::uint64_t value) { return put(value, 4); }
  Bytes& text(const std::string& value) {
    bytes_ += value;
    return *this;
  }
  const std::string& get() const { return bytes_; }

 private:
  Bytes& put(std::uint64_t value, int count) {
    for (int k = 0; k < count; ++k) bytes_ += static_cast<char>(value >> (8 * k) & 0xff);
    return *this;
  }
  std::string bytes_;
};

/// One file of the archive.
struct Member {
  std::string name;
  std::string header;  ///< of the .npy
  const NpyArray* array;
  std::uint64_t bytes;  ///< header and values
  std::uint32_t crc;
  std::uint64_t offset;
};

std::uint32_t crc_of(const std::string& header, const NpyArray& array) {
  uLong crc = crc32_z(0, nullptr, 0);
  crc = crc32_z(crc, reinterpret_cast<const Bytef*>(header.data()), header.size());
  if (array.size_bytes() > 0)
    crc = crc32_z(crc, static_cast<const Bytef*>(array.data), array.size_bytes());
  return static_cast<std::uint32_t>(crc);
}

/// The common part of the local header and the directory.
void put_common(Bytes& bytes, const Member& member) {
  bytes.u16(kVersion).u16(0).u16(0);  // no flags, stored
  bytes.u16(0).u16(kFirstDay).u32(member.crc).u32(member.bytes).u32(member.bytes);
  bytes.u16(member.name.size()).u16(0);  // no extra field
}

std::string local_header(const Member& member) {
  Bytes bytes;
  bytes.u32(kLocalHeader);
  put_common(bytes, member);
  return bytes.text(member.name).get();
}

std::string directory_entry(const Member& member) {
  Bytes bytes;
  bytes.u32(kCentralHeader).u16(kVersion);
  put_common(bytes, member);
  // No comment, first disk, no attributes.
  return bytes.u16(0).u16(0).u16(0).u32(0).u32(member.offset).text(member.name).get();
}

void check_names(std::span<const NamedArray> arrays) {
  std::vector<std::string> names;
  for (const NamedArray& array : arrays) {
    const bool good = !array.name.empty() && std::ranges::all_of(array.name, [](unsigned char c) {
      return std::isalnum(c) != 0 || c == '_';
    });
    if (!good) throw std::logic_error("write_npz: the name '" + array.name + "'");
    names.push_back(array.name);
  }
  std::ranges::sort(names);
  if (std::ranges::adjacent_find(names) != names.end())
    throw std::logic_error("write_npz: duplicate name");
}

std::vector<Member> members_of(const std::filesystem::path& path,
                               std::span<const NamedArray> arrays) {
  std::vector<Member> members;
  std::uint64_t offset = 0;
  for (const NamedArray& named : arrays) {
    Member member{named.name + ".npy", npy_header(named.array), &named.array, 0, 0, offset};
    member.bytes = member.header.size() + named.array.size_bytes();
    offset += kLocalHeaderBytes + member.name.size() + member.bytes;
    if (offset > kZipLimit)
      throw Error(ErrorKind::data, path.string() +
                                       ": arrays of 4 GiB or more exceed the limit of .npz; "
                                       "write them as single .npy files");
    member.crc = crc_of(member.header, named.array);
    members.push_back(std::move(member));
  }
  return members;
}

}  // namespace

void put_npz(ByteSink& file, const std::filesystem::path& path,
             std::span<const NamedArray> arrays) {
  check_names(arrays);
  const std::vector<Member> members = members_of(path, arrays);
  std::string directory;
  std::uint64_t directory_offset = 0;
  for (const Member& member : members) {
    const std::string header = local_header(member);
    file.write(header);
    file.write(member.header);
    file.write(member.array->data, member.array->size_bytes());
    directory += directory_entry(member);
    directory_offset = member.offset + header.size() + member.bytes;
  }
  file.write(directory);
  Bytes end;
  end.u32(kEndOfCentral).u16(0).u16(0).u16(members.size()).u16(members.size());
  file.write(end.u32(directory.size()).u32(directory_offset).u16(0).get());
}

void write_npz(const std::filesystem::path& path, std::span<const NamedArray> arrays) {
  AtomicFile file(path);
  put_npz(file, path, arrays);
  file.commit();
}

}  // namespace adasplats
