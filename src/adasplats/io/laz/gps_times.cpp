// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/io/laz/gps_times.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "adasplats/io/base/records.h"
#include "adasplats/io/laz/pointwise_item.h"
#include "adasplats/io/laz/range_encoder.h"

namespace adasplats {
namespace {

// Symbols 0 to 500 are multiples of the step, the next ten -1 to -10.
constexpr std::uint32_t kMaxMultiple = 500;
constexpr std::uint32_t kMaxNegative = 10;
constexpr std::uint32_t kMultiples = kMaxMultiple + kMaxNegative + 1;
constexpr int kExtremesForNewStep = 3;

std::int32_t times(std::int32_t step, std::int32_t multiple) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(step) *
                                   static_cast<std::uint32_t>(multiple));
}

/// The bits of a time plus a signed difference.
std::uint64_t later(std::uint64_t time, std::int32_t difference) {
  return time + static_cast<std::uint64_t>(std::int64_t{difference});
}

/// The difference of the bits of two times if it fits 32 bits.
std::optional<std::int32_t> near_difference(std::uint64_t from, std::uint64_t to) {
  const std::uint64_t difference = to - from;
  const auto low = static_cast<std::int32_t>(static_cast<std::uint32_t>(difference));
  if (later(from, low) != to) return std::nullopt;
  return low;
}

/// `difference` / `step`, rounded as in LASzip and clamped beyond the range of symbols.
std::int32_t nearest_multiple(std::int32_t difference, std::int32_t step) {
  constexpr float kFar = 1e6F;
  const float share = static_cast<float>(difference) / static_cast<float>(step);
  return static_cast<std::int32_t>(std::clamp(share, -kFar, kFar) + (share >= 0 ? 0.5F : -0.5F));
}

}  // namespace

GpsTimes::GpsTimes(Symbols symbols, std::uint64_t first)
    : unchanged_(symbols == Symbols::with_unchanged ? 1 : 0),
      multiples_(kMultiples + unchanged_ + 4),
      without_step_(5 + unchanged_) {
  sequences_[0].time = first;
}

std::uint64_t GpsTimes::decode(RangeDecoder& decoder) {
  // Encoders switch the sequence at most once; damaged data could switch forever.
  for (int k = 0; k < 4; ++k)
    if (decode_in_sequence(decoder)) break;
  return sequences_[current_].time;
}

bool GpsTimes::decode_in_sequence(RangeDecoder& decoder) {
  return sequences_[current_].step == 0 ? decode_without_step(decoder) : decode_with_step(decoder);
}

bool GpsTimes::decode_without_step(RangeDecoder& decoder) {
  const std::uint32_t symbol = without_step_.decode(decoder);
  if (symbol < unchanged_) return true;
  const std::uint32_t kind = symbol - unchanged_;
  if (kind == 0) {
    Sequence& sequence = sequences_[current_];
    sequence.step = integers_.decode_signed(decoder, 0, 0);
    sequence.time = later(sequence.time, sequence.step);
    sequence.extremes = 0;
  } else if (kind == 1) {
    begin_sequence(decoder);
  } else {
    switch_sequence(kind - 1);
    return false;
  }
  return true;
}

bool GpsTimes::decode_with_step(RangeDecoder& decoder) {
  const std::uint32_t symbol = multiples_.decode(decoder);
  if (symbol < kMultiples) {
    decode_multiple(decoder, symbol);
    return true;
  }
  if (symbol < kMultiples + unchanged_) return true;
  const std::uint32_t kind = symbol - kMultiples - unchanged_;
  if (kind > 0) {
    switch_sequence(kind);
    return false;
  }
  begin_sequence(decoder);
  return true;
}

void GpsTimes::decode_multiple(RangeDecoder& decoder, std::uint32_t symbol) {
  Sequence& sequence = sequences_[current_];
  const auto multiple = static_cast<std::int32_t>(symbol);
  const auto difference = [&](std::int32_t of_step, unsigned context) {
    return integers_.decode_signed(decoder, times(sequence.step, of_step), context);
  };
  const auto take_extreme = [&sequence](std::int32_t found) {
    if (++sequence.extremes > kExtremesForNewStep) {
      sequence.step = found;
      sequence.extremes = 0;
    }
    return found;
  };
  std::int32_t found = 0;
  if (symbol == 1) {
    found = difference(1, 1);
    sequence.extremes = 0;
  } else if (symbol == 0) {
    found = take_extreme(difference(0, 7));
  } else if (symbol < kMaxMultiple) {
    found = difference(multiple, symbol < 10 ? 2 : 3);
  } else if (symbol == kMaxMultiple) {
    found = take_extreme(difference(multiple, 4));
  } else if (symbol < kMultiples - 1) {
    found = difference(static_cast<std::int32_t>(kMaxMultiple) - multiple, 5);
  } else {
    found = take_extreme(difference(-static_cast<std::int32_t>(kMaxNegative), 6));
  }
  sequence.time = later(sequence.time, found);
}

void GpsTimes::begin_sequence(RangeDecoder& decoder) {
  const auto upper = static_cast<std::uint32_t>(sequences_[current_].time >> 32);
  newest_ = (newest_ + 1) % 4;
  const std::uint64_t high = integers_.decode(decoder, upper, 8);
  sequences_[newest_] = {.time = (high << 32) | decoder.bits(32)};
  current_ = newest_;
}

void GpsTimes::encode(RangeEncoder& encoder, std::uint64_t time) {
  const Sequence& sequence = sequences_[current_];
  if (const auto difference = near_difference(sequence.time, time))
    encode_near(encoder, *difference);
  else
    encode_far(encoder, time);
}

void GpsTimes::encode_near(RangeEncoder& encoder, std::int32_t difference) {
  Sequence& sequence = sequences_[current_];
  if (sequence.step != 0) {
    encode_multiple(encoder, difference);
  } else {
    without_step_.encode(encoder, unchanged_);
    integers_.encode_signed(encoder, 0, difference, 0);
    sequence.step = difference;
    sequence.extremes = 0;
  }
  sequence.time = later(sequence.time, difference);
}

void GpsTimes::encode_multiple(RangeEncoder& encoder, std::int32_t difference) {
  constexpr auto kMax = static_cast<std::int32_t>(kMaxMultiple);
  constexpr auto kMin = -static_cast<std::int32_t>(kMaxNegative);
  Sequence& sequence = sequences_[current_];
  const std::int32_t multiple = std::clamp(nearest_multiple(difference, sequence.step), kMin, kMax);
  multiples_.encode(encoder, static_cast<std::uint32_t>(multiple < 0 ? kMax - multiple : multiple));
  const bool is_extreme = multiple == 0 || multiple == kMax || multiple == kMin;
  const unsigned context = multiple == 0      ? 7
                           : multiple == 1    ? 1
                           : multiple == kMax ? 4
                           : multiple == kMin ? 6
                           : multiple < 0     ? 5
                           : multiple < 10    ? 2
                                              : 3;
  integers_.encode_signed(encoder, times(sequence.step, multiple), difference, context);
  if (multiple == 1) sequence.extremes = 0;
  if (!is_extreme || ++sequence.extremes <= kExtremesForNewStep) return;
  sequence.step = difference;
  sequence.extremes = 0;
}

void GpsTimes::encode_far(RangeEncoder& encoder, std::uint64_t time) {
  const bool has_step = sequences_[current_].step != 0;
  SymbolModel& symbols = has_step ? multiples_ : without_step_;
  // Symbols: a new sequence, then the next existing ones.
  const std::uint32_t first = unchanged_ + (has_step ? kMultiples : 1);
  for (std::uint32_t ahead = 1; ahead < 4; ++ahead) {
    const auto difference = near_difference(sequences_[(current_ + ahead) % 4].time, time);
    if (!difference) continue;
    symbols.encode(encoder, first + ahead);
    switch_sequence(ahead);
    return encode_near(encoder, *difference);
  }
  symbols.encode(encoder, first);
  const auto upper = static_cast<std::uint32_t>(sequences_[current_].time >> 32);
  integers_.encode(encoder, upper, static_cast<std::uint32_t>(time >> 32), 8);
  encoder.put_bits(static_cast<std::uint32_t>(time), 32);
  newest_ = (newest_ + 1) % 4;
  current_ = newest_;
  sequences_[newest_] = {.time = time};
}

namespace {

/// The method of LASzip since 2.0.
class GpsTime11V2 final : public PointwiseItem {
 public:
  void start(const std::byte* first) override {
    times_ = GpsTimes(GpsTimes::Symbols::with_unchanged, load_value<std::uint64_t>(first));
  }
  void decode(RangeDecoder& decoder, std::byte* item) override {
    store_value(item, times_.decode(decoder));
  }

 private:
  GpsTimes times_{GpsTimes::Symbols::with_unchanged, 0};
};

/// The method of LASzip before 2.0: one sequence.
class GpsTime11V1 final : public PointwiseItem {
 public:
  void start(const std::byte* first) override { time_ = load_value<std::uint64_t>(first); }

  void decode(RangeDecoder& decoder, std::byte* item) override {
    if (step_ == 0)
      decode_without_step(decoder);
    else
      decode_with_step(decoder);
    store_value(item, time_);
  }

 private:
  static constexpr std::uint32_t kSymbols = 512;  // the last two: a complete time, an equal time

  void decode_without_step(RangeDecoder& decoder) {
    const std::uint32_t symbol = without_step_.decode(decoder);
    if (symbol == 1) {
      step_ = integers_.decode_signed(decoder, 0, 0);
      time_ = later(time_, step_);
    } else if (symbol == 2) {
      time_ = decoder.bits64();
    }
  }

  void decode_with_step(RangeDecoder& decoder) {
    const std::uint32_t symbol = multiples_.decode(decoder);
    if (symbol < kSymbols - 2)
      time_ = later(time_, decode_multiple(decoder, symbol));
    else if (symbol == kSymbols - 2)
      time_ = decoder.bits64();
  }

  std::int32_t decode_multiple(RangeDecoder& decoder, std::uint32_t symbol) {
    if (symbol == 1) {
      step_ = integers_.decode_signed(decoder, step_, 1);
      extremes_ = 0;
      return step_;
    }
    const bool is_extreme = symbol == 0 || symbol == kSymbols - 3;
    const unsigned context = symbol == 0 ? 2 : symbol < 10 ? 3 : symbol < 50 ? 4 : 5;
    const std::int32_t prediction =
        symbol == 0 ? step_ / 4 : times(step_, static_cast<std::int32_t>(symbol));
    const std::int32_t found = integers_.decode_signed(decoder, prediction, context);
    if (is_extreme && ++extremes_ > kExtremesForNewStep) {
      step_ = found;
      extremes_ = 0;
    }
    return found;
  }

  std::uint64_t time_ = 0;
  std::int32_t step_ = 0;
  int extremes_ = 0;
  SymbolModel multiples_{kSymbols};
  SymbolModel without_step_{3};
  IntegerModel integers_{32, 6};
};

}  // namespace

std::unique_ptr<PointwiseItem> make_gps_time11_v1() { return std::make_unique<GpsTime11V1>(); }
std::unique_ptr<PointwiseItem> make_gps_time11_v2() { return std::make_unique<GpsTime11V2>(); }

}  // namespace adasplats
