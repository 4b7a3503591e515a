// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/laz/pointwise_item.h"

#include <algorithm>
#include <stdexcept>

#include "adasplats/io/laz/integer_model.h"

namespace adasplats {
namespace {

/// The method of LASzip since 2.0.
class ExtraBytesV2 final : public PointwiseItem {
 public:
  explicit ExtraBytesV2(std::size_t bytes) : last_(bytes), differences_(bytes, SymbolModel(256)) {}

  void start(const std::byte* first) override { std::copy_n(first, last_.size(), last_.begin()); }

  void decode(RangeDecoder& decoder, std::byte* item) override {
    for (std::size_t k = 0; k < last_.size(); ++k) {
      last_[k] = static_cast<std::byte>(std::to_integer<std::uint32_t>(last_[k]) +
                                        differences_[k].decode(decoder));
    }
    std::copy(last_.begin(), last_.end(), item);
  }

 private:
  std::vector<std::byte> last_;
  std::vector<SymbolModel> differences_;
};

/// The method of LASzip before 2.0.
class ExtraBytesV1 final : public PointwiseItem {
 public:
  explicit ExtraBytesV1(std::size_t bytes)
      : last_(bytes), integers_(8, static_cast<unsigned>(bytes)) {}

  void start(const std::byte* first) override { std::copy_n(first, last_.size(), last_.begin()); }

  void decode(RangeDecoder& decoder, std::byte* item) override {
    for (unsigned k = 0; k < last_.size(); ++k) {
      last_[k] = static_cast<std::byte>(
          integers_.decode(decoder, std::to_integer<std::uint32_t>(last_[k]), k));
    }
    std::copy(last_.begin(), last_.end(), item);
  }

 private:
  std::vector<std::byte> last_;
  IntegerModel integers_;
};

}  // namespace

std::unique_ptr<PointwiseItem> make_extra_bytes_v1(std::size_t bytes) {
  return std::make_unique<ExtraBytesV1>(bytes);
}
std::unique_ptr<PointwiseItem> make_extra_bytes_v2(std::size_t bytes) {
  return std::make_unique<ExtraBytesV2>(bytes);
}

std::unique_ptr<PointwiseItem> make_pointwise_item(const LazItem& item) {
  const bool is_first = item.version == 1;
  switch (item.type) {
    case LazItemType::point10: return is_first ? make_point10_v1() : make_point10_v2();
    case LazItemType::gps_time11: return is_first ? make_gps_time11_v1() : make_gps_time11_v2();
    case LazItemType::rgb12: return is_first ? make_rgb12_v1() : make_rgb12_v2();
    case LazItemType::wave_packet13: return make_wave_packet13();
    case LazItemType::extra_bytes:
      return is_first ? make_extra_bytes_v1(item.bytes) : make_extra_bytes_v2(item.bytes);
    default: throw std::logic_error("an item of layered chunks in a chunk of points");
  }
}

}  // namespace adasplats
