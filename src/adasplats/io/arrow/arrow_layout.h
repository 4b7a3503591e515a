// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace adasplats {

inline constexpr std::string_view kArrowMagic = "ARROW1";
inline constexpr std::size_t kBlockBytes = 24, kNodeBytes = 16, kBufferBytes = 16;
inline constexpr std::uint32_t kContinues = 0xffffffff;  ///< before the size of a message

// Fields of the tables, in the order of the schemas.
enum FooterField : std::uint8_t {
  footer_version = 0,
  footer_schema = 1,
  footer_dictionaries = 2,
  footer_batches = 3
};
enum SchemaField : std::uint8_t { schema_endianness = 0, schema_fields = 1 };
enum FieldField : std::uint8_t {
  field_name = 0,
  field_type_kind = 2,
  field_type = 3,
  field_dictionary = 4,
  field_children = 5
};
enum MessageField : std::uint8_t {
  message_version = 0,
  message_kind = 1,
  message_header = 2,
  message_body_bytes = 3
};
enum BatchField : std::uint8_t {
  batch_rows = 0,
  batch_nodes = 1,
  batch_buffers = 2,
  batch_compression = 3
};

/// Numbers of the union Type.
enum TypeKind : std::uint8_t {
  int_type = 2,
  float_type = 3,
  utf8_type = 5,
  bool_type = 6,
  large_utf8_type = 20
};
/// Numbers of the union MessageHeader.
inline constexpr std::uint8_t kSchemaMessage = 1, kRecordBatch = 3;
inline constexpr std::int16_t kArrowVersion = 4;  ///< MetadataVersion.V5

}  // namespace adasplats
