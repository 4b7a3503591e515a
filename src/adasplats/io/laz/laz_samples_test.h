// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "adasplats/io/base/files_test.h"

namespace adasplats::laz_test {

/// A small file as LASzip has packed it: what follows its variable length records, in base64.
struct LazSample {
  std::string_view name;
  unsigned format;
  unsigned compressor;
  unsigned version;
  std::uint32_t chunk_points;
  std::size_t rows;
  std::string_view packed;
};

inline constexpr std::size_t kExtraBytes = 2;

inline std::size_t point_bytes(unsigned format) {
  constexpr std::array<std::size_t, 11> kBytes = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
  return kBytes[format];
}

/// Numbers of a linear congruence: the records of a sample, which are not stored.
class SampleNumbers {
 public:
  unsigned below(unsigned limit) {
    state_ = state_ * 1664525U + 1013904223U;
    return (state_ >> 16) % limit;
  }

 private:
  std::uint32_t state_ = 1;
};

/// The points of a sample: what changes seldom does so now and then, times are those of several
/// pulses, colours are grey at times, scanner channels change, no point is withheld.
class SampleWalk {
 public:
  explicit SampleWalk(unsigned format) : format_(format) {}

  /// The next record.
  std::string next(std::size_t row) {
    step();
    std::string record = io_test::bytes_of(x_) + io_test::bytes_of(y_) + io_test::bytes_of(z_) +
                         io_test::bytes_of(static_cast<std::uint16_t>(400 + numbers_.below(100)));
    put_attributes(record);
    put_colour(record);
    if (format_ == 4 || format_ == 5 || format_ >= 9) put_packet(record);
    record += static_cast<char>(numbers_.below(3));
    record += static_cast<char>(row / 8);
    return record;
  }

 private:
  void step() {
    x_ += static_cast<std::int32_t>(numbers_.below(300)) - 20;
    y_ += static_cast<std::int32_t>(numbers_.below(50)) - 25;
    z_ += static_cast<std::int32_t>(numbers_.below(2000)) - 1000;
    if (number_ < returns_) {
      ++number_;
    } else {
      returns_ = 1 + numbers_.below(numbers_.below(3) == 0 ? 5 : 1);
      number_ = 1;
      time_ += numbers_.below(9) == 0 ? 5000.25 : 0.00002 * (1 + numbers_.below(3));
      if (numbers_.below(4) == 0) channel_ = numbers_.below(4);
    }
    if (numbers_.below(6) == 0) class_ = numbers_.below(18);
    if (numbers_.below(9) == 0) user_ = numbers_.below(256);
    if (numbers_.below(9) == 0) source_ = numbers_.below(60000);
    if (numbers_.below(9) == 0) flags_ = numbers_.below(4);
    if (numbers_.below(3) == 0)
      angle_ = static_cast<std::int16_t>(angle_ + static_cast<int>(numbers_.below(90)) - 40);
  }

  void put_attributes(std::string& record) const {
    if (format_ >= 6) {
      record += static_cast<char>(number_ | (returns_ << 4));
      record += static_cast<char>((flags_ & 1) | (channel_ << 4) | ((flags_ & 2) << 5));
      record += static_cast<char>(class_);
      record += static_cast<char>(user_);
      record += io_test::bytes_of(angle_);
    } else {
      record += static_cast<char>(number_ | (returns_ << 3) | ((flags_ & 1) << 6));
      record += static_cast<char>(class_);
      record += static_cast<char>(angle_ / 10);
      record += static_cast<char>(user_);
    }
    record += io_test::bytes_of(static_cast<std::uint16_t>(source_));
    if (format_ != 0 && format_ != 2) record += io_test::bytes_of(time_);
  }

  void put_colour(std::string& record) {
    const unsigned change = numbers_.below(4) * 257;
    for (std::uint16_t& value : colour_)
      value = static_cast<std::uint16_t>(value + change + numbers_.below(3));
    if (numbers_.below(5) == 0) colour_[1] = colour_[2] = colour_[0];
    const bool has_infrared = format_ == 8 || format_ == 10;
    if (format_ == 2 || format_ == 3 || format_ == 5 || format_ == 7 || has_infrared)
      for (const std::size_t k : {0U, 1U, 2U}) record += io_test::bytes_of(colour_[k]);
    if (has_infrared) record += io_test::bytes_of(colour_[3]);
  }

  void put_packet(std::string& record) {
    const unsigned size = numbers_.below(5) == 0 ? 300 : 256;
    record += static_cast<char>(numbers_.below(3));
    record += io_test::bytes_of(packet_) + io_test::bytes_of(size);
    packet_ += numbers_.below(7) == 0 ? 1000 : size;
    for (const float part : {10.0F, 0.5F, 0.25F, -1.0F})
      record += io_test::bytes_of(part + static_cast<float>(numbers_.below(8)));
  }

  unsigned format_;
  SampleNumbers numbers_;
  std::int32_t x_ = 1000, y_ = -2000, z_ = 300;
  double time_ = 1000.5;
  unsigned class_ = 2, user_ = 0, source_ = 7, returns_ = 1, number_ = 1, channel_ = 0, flags_ = 0;
  std::int16_t angle_ = -300;
  std::array<std::uint16_t, 4> colour_ = {1000, 2000, 3000, 4000};
  std::uint64_t packet_ = 60;
};

inline std::string sample_records(const LazSample& sample) {
  SampleWalk walk(sample.format);
  std::string records;
  for (std::size_t row = 0; row < sample.rows; ++row) records += walk.next(row);
  return records;
}

/// A record of table 4 of the specification, before its content.
inline std::string record_start(std::string_view user, std::uint16_t number, std::size_t bytes) {
  std::string start(54, '\0');
  start.replace(2, user.size(), user);
  io_test::put(start, 18, number);
  io_test::put(start, 20, static_cast<std::uint16_t>(bytes));
  return start;
}

struct SampleItem {
  unsigned type;
  std::size_t bytes;
  unsigned version;
};

inline std::vector<SampleItem> sample_items(unsigned format, unsigned version) {
  std::vector<SampleItem> items = {{format < 6 ? 6U : 10U, format < 6 ? 20U : 30U, version}};
  if (format == 1 || (format >= 3 && format < 6)) items.push_back({7, 8, version});
  if (format == 2 || format == 3 || format == 5) items.push_back({8, 6, version});
  if (format == 4 || format == 5) items.push_back({9, 29, 1});
  if (format == 7) items.push_back({11, 6, version});
  if (format == 8 || format == 10) items.push_back({12, 8, version});
  if (format >= 9) items.push_back({13, 29, version});
  items.push_back({format < 6 ? 0U : 14U, kExtraBytes, version});
  return items;
}

/// LASzip's record (laszip.hpp).
inline std::string laszip_record(const LazSample& sample) {
  const std::vector<SampleItem> items = sample_items(sample.format, sample.version);
  std::string record(34, '\0');
  io_test::put(record, 0, static_cast<std::uint16_t>(sample.compressor));
  io_test::put(record, 12, sample.chunk_points);
  io_test::put(record, 32, static_cast<std::uint16_t>(items.size()));
  for (const SampleItem& item : items)
    record += io_test::bytes_of(static_cast<std::uint16_t>(item.type)) +
              io_test::bytes_of(static_cast<std::uint16_t>(item.bytes)) +
              io_test::bytes_of(static_cast<std::uint16_t>(item.version));
  return record_start("laszip encoded", 22204, record.size()) + record;
}

/// All bytes before the points, compressed or not.
inline std::string sample_start(const LazSample& sample, bool is_packed) {
  const bool is_extended = sample.format >= 6;
  const std::size_t bytes = is_extended ? 375 : sample.format > 3 ? 235 : 227;
  std::string header(bytes, '\0');
  header.replace(0, 4, "LASF");
  io_test::put(header, 24, std::uint8_t{1});
  io_test::put(header, 25, static_cast<std::uint8_t>(is_extended ? 4 : sample.format > 3 ? 3 : 2));
  // An attribute "both" of 16 bits in the extra bytes (table 24).
  std::string extra(192, '\0');
  io_test::put(extra, 2, std::uint8_t{3});
  extra.replace(4, 4, "both");
  std::string records = record_start("LASF_Spec", 4, extra.size()) + extra;
  if (is_packed) records += laszip_record(sample);
  io_test::put(header, 94, static_cast<std::uint16_t>(bytes));
  io_test::put(header, 96, static_cast<std::uint32_t>(bytes + records.size()));
  io_test::put(header, 100, std::uint32_t{is_packed ? 2U : 1U});
  io_test::put(header, 104, static_cast<std::uint8_t>(sample.format | (is_packed ? 0x80 : 0)));
  io_test::put(header, 105, static_cast<std::uint16_t>(point_bytes(sample.format) + kExtraBytes));
  const auto rows = static_cast<std::uint32_t>(sample.rows);
  io_test::put(header, 107, is_extended ? 0 : rows);
  if (is_extended) io_test::put(header, 247, std::uint64_t{rows});
  for (const std::size_t axis : {0U, 1U, 2U}) io_test::put(header, 131 + 8 * axis, 0.01);
  return header + records;
}

inline std::string las_file(const LazSample& sample) {
  return sample_start(sample, false) + sample_records(sample);
}

inline std::string laz_file(const LazSample& sample) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string file = sample_start(sample, true);
  unsigned bits = 0, count = 0;
  for (const char digit : sample.packed) {
    bits = (bits << 6) | static_cast<unsigned>(kDigits.find(digit));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    file += static_cast<char>(bits >> count);
    bits &= (1U << count) - 1;
  }
  return file;
}

/// Packed by LASzip 3.5.0; the places in them are those of laz_file().
inline constexpr std::array<LazSample, 4> kLazSamples = {
    {{"one stream, version 1", 3, 1, 1, 0, 40,
      "mAQAABf4//9aAQAA4AEJB+AABwBNEHUfAESPQO0G7QbtBgAAQ2vwSbRiFlp5kR2aT4Y+s5tcHsFtNrJu+n4jqADp1DmH"
      "PjWGNLs+J9WeCiPPeRIphPgqRZvTx98NRHNN/yuEAO2JfWuGx+Rf1gQR3HxrfmaGhYVgji34J2IQlzhxRGoVifnDmqAp"
      "JI6eCdi27VJNDra9aTZq8q61XJIHojPsDJU2P0zPF0fliIqJDWhqq3YHZpOE4b4PtRFf0V/8F/1Odl0CyxYjGXx/loYX"
      "vCrSu3X1tRH9FCOQqFN7FytsJnDuCxTiNFp7g6H0gAkqw6PtRBlrKDx2UJubImeBwkPLTXRaJfQ6h6GFfbPltB3ea+E1"
      "QTaEaigTy61lNhv0uUTw0zSPYCu1Ump5iFPznzNNX0Fz4lwyON1c7dE3Tr39KOVUKL3JRGREK+VUnBagxAR2ALjW/Ss6"
      "WlRwQ7LN3H2QxRHs+DF/fv9UlF4XGlOjbOmLWqKTRz8LUEdC+2Si5Ky2YgB46DcCLHJ8Ym2GCHFYX+0y2YRMQgXKXHsY"
      "YORRa6Y2jP04IcFkKwgjzf7S6vqYrHi6tHVhO/U4+ZEadTMvEis8shCbX+uXz/dAMzW3W2H0z8Lrjt5MdB8jQu5l/XMP"
      "NCu+9gM6BndNRmNG3oRzdsLsFSZezAxpw5c/kC4W5cFQbdL68yViy0uJwznwY4OPGHdEd9hFtFZb1Ql8J6D+y+dyfqtU"
      "l+HkeCwIDU98AAAA"},
     {"chunks of points", 5, 2, 2, 16, 40,
      "LQgAAAAAAACYBAAAF/j//1oBAADgAQkH4AAHAE0QdR8ARI9A7QbtBu0GADwAAAAAAAAAAAEAAAAAgEEAAAA/AAAQQAAA"
      "gL8CANBF5F8ZlE5iat4T3Ao1BnODg3GwABYmYm6a1yd7XJBvX4dfuOGpjb5OdQFpqLh9lusAam2MwMzAABmYBA/lN+sp"
      "SY6kXiasRKu91c7qCbroRz8J/Gm62bOFoQt4AAACpHH+mgD53QGAPOcNk8LvT/zeYfGS8geuczzD5HwsI9gABTSPwuON"
      "hC792gcX4ywi2esDEeQ86iWcoDiD7O/CvF7LyMmpG6YjkDBXcuBPKpAUJ7LZr3agKbIDERGNy8mN3ACQ1+kVAARpmlL6"
      "H5y0h/3k8wfhlxxJbQTx546okfhjb0abz8fMrtw18Iik2Mv5eZ2ZQsXgWBOSrEZX4vuaq+FElW0ABWTUNYR5/VPGYSw+"
      "QP1jj814W53l/NvVJKrhTG3GH/AdWC7KHPwAIvy7Nbh1+Hj2/9zkSf8B/a9hNwnPBsn4OLdCmxHA0L2XtaMr+ZwADmhi"
      "sSvTvPa2cXC4aW57dLlAbVJl+NGKIK2767hHJ5PEOAAEPKvCtZ/Lx/5s3p1+g5a5dkoihO89pVa6Dtu6JmVd/Hc/Ven4"
      "IeC/fwPhzGcRWifsUUWVK2Z5uy7PEiyOBp96vgKIbYed33nULpLlQgohON4bmxjXjG0V/rYFZ+H9F8sgThXxJqv+PFmP"
      "msNNxGb+EazEpCLsaGgSQmE03eMAAJ8zXp4w2wzXNZTXyjjN/7h8AQAAAJALAAAZ+P//lgUAAOsBKgvfPxMRe8ISD4B8"
      "xUAXHhceFx4ACBwAAAAAAAAAAQAAAAAwQQAAwD8AAFBAAACAPwACwK3bwe7GIixc8V7hlUwAAKUb8wX83aczbwBk64Kp"
      "r3Ar9AIcjcpaDja1NbamN+U+RvJCm12B/t/mJkE9+Fzx///hv2dJ2pCCXj7YrRaUfV+AAAqlDw3Svufih3l3MMP+B796"
      "S3xWZLsMqCtYcrTZ0xMTQEdbZ/P7rTsfWlv4mkKjDuIQCBQ8sOrDhJTqH1fF/uPeYYFYG5AAEeyVT44MyUD/ZOE5x+g1"
      "HfnqaHsR7dF1X6gGDJNhbflEI9DmAAAAAXVrak//RJWh7n0Xd96Mnf//3oafs4Ar6vE9pXt0ZGUQdPv/jYwLB5GFY3wv"
      "r5/OIaB1+g2FU9kNWKXj7cDc4vxEVghSHW1gTyAAYFC2qMesEnh89OKj8UXl/Y82ASk0ErpnatwMJDSldKwdjOhaPXc8"
      "aEMOQZ7No3zR5gP/94cvu2FnWlLs+Kt6ToYFSAAAAjZeKbSaW0bW+dq43pf9lFTbbnANOKc9400Gdk4M7EdpPTqcAAAF"
      "yRsjPK7PDU/rF4/JSL8RfVBZlB+QF02pXg1mMBTFSOlqUJxh7Cgo1xgFp+FygUshk+cDTsaxn30YAAUXrbQiN7U6egDQ"
      "2X1Hmj+IogK4kVpjlwsNFklrpDAnXktGNa3a+n7SPkB/GY/6MZcP6ChsZoniFjuyBYN937goo/gYEAgIAAAQn7b+YBNV"
      "LvxcablCz9aAAACwEwAA+ff//8oZAACwASoD4/dUIu53KApggtRAQjlDOUM5AHA1AAAAAAAAAAEAAAAAgEEAAGBAAACA"
      "PgAAoEAABNit0FC2MQ+TTeJEMxXqao8LAC/TTSKB9g5GN5dAF/7w9QVglBmdoyvWvixCHGTIwSiEe4AABVq+0wMEIJgf"
      "6yS+96OKt/+FNaLMRl0kdxvuumgeYl+xLoAGK17EMN3Pi7N0JHPpxpIf4tYIPpUCk44GBcdN4FuEqwZAb0CvghoPyj+U"
      "cyd23+Hf4/rWMgoZGFc/Qy/XWed1gIPPMZCFIZlJyhCR/og3FgONKUpOGcolZlbPWXb9AmmLXFm2ABOuTwKfyhwAf023"
      "R/+Ue0f//yg4O1p2wPJ5LPULjX5tWPK2+QAtBjgUX5fLu3kiFPlUMAnIAAAAAAAAAAMAAABSAi2l2wAAAA"},
     {"layers, variable chunks, four scanner channels", 10, 3, 3, ~0U, 40,
      "TgoAAAAAAACYBAAAF/j//1oBAADgAREABwC7/gcATRB1HwBEj0DtBu0G7QajEgA8AAAAAAAAAAABAAAAAIBBAAAAPwAA"
      "EEAAAIC/AgADAAAACwAAAAcAAAAGAAAAAAAAAAYAAAAFAAAAAAAAAAAAAAAIAAAAEQAAAAgAAAAfAAAABgAAAAAAAAA4"
      "RymBLEdCBQAAAFRduRYAAAAHCP0AAAA/TUgAAABhaQAAAC4A/HkSAAAA/gOFBAIAAfwICAAIAAEAAADAwFAgIQAAAAFA"
      "laMdYEhjheEOe/jHzbYoP9CAScMHDoW9/mgAAAD+AIEAAAD4BQAA+vf//30DAADkAREACZuP/gcAu7iNBsBwt0D0C/UL"
      "9wurFwAkBgAAAAAAAAABAAAAACBBAAAAPwAAiEAAAIA/AAAWAAAATgAAACoAAAAZAAAAAAAAABsAAAALAAAAGQAAAA4A"
      "AABGAAAAdQAAAC4AAABZAQAAGQAAABkAAAAgaoF/v8Pd4qWLqyizMDY13uGmFv0aUTD9xUt8qvx+2cq48EvE3zeUqkjP"
      "W9p/x055yxYEYeYQwrVYThevz9Cxxs3v/cRGIULkSH4AAABL5CZc4o6bkcJi+i9+by0h+VoTd7Yj07LdwrjFgr7CvLc8"
      "KpgfvRsAAAAJCQSEhISEhHx8ioqFhYWFhYWFhYV7AAAAN2dli/yC1/m14SdcmIZk3mcyIRKDBxdqywAAVVlbrOXn2GgA"
      "AACbm03Nzc3Nzc1xcZ+fn5+fn5+fn59hAAAA7HINS6rw1zE7Sg0AAAAp27mUe1a+P3yAqDqVgTlF8YSH+naPwNF+SJlN"
      "HIRw9zeTcfWirOM/ioaC011xSCDYUPCdj+ltsf9FHHuQw8yvy9ANAAAA/gWDAf4AALwIB/gYEAf4AAPwMC/gQF/gIAAf"
      "wQC/gEAAP4IBf/+AAH8EAgD/AAB+CAf8JBQQAAAAKA/wMB/v8AAH4CA/wIBAQAAAKoEAf/8EA/8AAACqAgID/AwMAAgA"
      "A/gQCAAAAAPwMC/ggGAAIAABAAAAwEAQMBwICwQCwEBVqroA3XICphQ9KNWwJloQnQCKrVfNtq2BMjjyO3gmXQAAAAFA"
      "nSaRY0dsn3WGZ/i+AP6Xm8kM3bzfCbZvJnIGJ0m3nWDyjM3n6+HJP5L8N/nZxN6tWjeTZVvqqMxL+cHzf3ylShJDX412"
      "92kwbXl4jD7VzzWdYqvq3fdsuN/XzL9+3T153RFj8L8vbbe74GlySBYXA2xpx87MZE3/JzwJfzHvsk9iytJMGvzwtA+e"
      "pgepdwYf3QbWTvmdb34csEf+HDr80wfLpTdshfkLnnsO6hWlvFDi0qRPYU/zfy641/7qfvvjqojL80/E/ZH/I/1NR+/6"
      "rB37H2G9CZ197JsvcKz3sbwasi9yTv4Z0fWOEIv86kx/+fASxWuLBo0zZ3dZ2MX9aprnpYHfSMQ/+cTKs7YUV3sR0WLV"
      "iV2JS0PrNarv7cP9+1YYGWiK7fR1EnrsUAN98JdD/fR8MMHYp3S7ZXssZlPA40bggIJkjmdqkMfY0hpqdJAe2QAAAAAB"
      "AACAAH4Cf/+AgH8Cfn6BAv/9ggEAAAAAAAAAAP//gAAAAAAA//+AAAAAAAEAAAAAow8AAPb3//8EFwAA5gEhAAs/9f5U"
      "IjEqqROgQM9AMS4xLjEu5DkBXCsAAAAAAAAAAQAAAABQQQAAsEAAAKA/AACAQAADDwAAADgAAAAcAAAAEgAAAA4AAAAT"
      "AAAACgAAABIAAAAAAAAAHwAAAE0AAAAeAAAA2gAAABIAAAASAAAAAofrP1r5yFvuXx14veg7BS9k+jjss4b/5SPomDlQ"
      "iMA5iiYe1mOQIHEfGBb2qu4Uyi2jZZ0AAAA6IDnYIjHBt1oH0J3eyFTO9VJDlixuX2iKAAAACwsFfX2BgYGBgYGBgYF/"
      "AAAAAP/gAAAAAAAAAAEAAAA5SrUiiXAEFN4U103eC4DGAAAARf9Xzto7sQAAAD/31/v7+/seHo0NDQ0M8wAAACY/V2+t"
      "sMOFEpkOE4Ep5ErRgvGMDTMxzkuUnN8AAAD+B4b8AAAB/AgIBAAAAqgX+AfwMC/wIAAH4GB/wMCAQEAAIH8EAwICAAD+"
      "BgYCAAAB/AgIBAQAAggVAB/gQD/gIAAfwMCAAEAAAQAAAMCAUCAkBwQCwMDwICDPKj9acpx+XmtqT+sTEwAAAABM9Of8"
      "D8bV7p8qaN/x4X27RKDv9MHlPzsB/f1EkfF3+zoSmeLT0Qyk2MpW7io2/GeNK35eb1u4lovx2sTwS8L/xiDNf9PR8fD3"
      "z2AsTxZ1/4758QE8F4Tr4acxV2mlkO58fpDOk3T6ayXsHm0e2dC/+4TQeuut0seusOEv3P9/8Y99Tsvb9AUl//A7XklI"
      "T+Kz/n9hNQ/9HFDuiOLXEqX+AFY95GiaQ/eQ9VqOC1quaoI55kDmhhrZ3S+H9XXJH90fVn/q+BN/1CXQCrQl6vzenp7G"
      "jU66AAAAAQD+f4N9/38AgP+B/wABAAAAAAAAAAAAAQD/f4AAAAABAAAAAAAAAAMAAAAT6KO8H3LrUH0AAAA"},
     {"layers, version 4", 7, 3, 4, 16, 40,
      "UwcAAAAAAACYBAAAF/j//1oBAADgAREABwC7/gcATRB1HwBEj0DtBu0G7QYAABAAAAA7AAAAHwAAABMAAAAAAAAAFQAA"
      "AAoAAAATAAAAAAAAAB8AAABbAAAAEwAAABMAAAAwhp8Dq98EiIWy/8VOcKfE3SwvsHOerZ5q/ViDENZgs9C9VMDwbqFr"
      "e8qXOjgG+c2zFjgloybaNQAAAFBlp/SxdZqxUzbAW9/1Ku2q9b61lJwN01oGHhoAAAAHBweHhYWFhYWFhYWFhYV7AAAA"
      "PGqPEthirSfpzlQJuXtqx36gAAAAHrveh3LIwQAAAAChoVDQ0NDQ0NDQ0GNjmeYAAAAugkA64I1NIyfpX3nz/f7Ozmul"
      "xUEViKm4yNA9AAAA/gmHAfwAAfwICAAAAAP4IBgP+AAH8DAgEAAACqBf4BdAgF/AY4EAgP8EAv4BAAD+CAX+BAAD/BQM"
      "A/wAA/gQEBf4AAfwQC/gEAAP4EAgH+AAD8DAX4IBgQAAAAEB/n8BgP1/ggH+gP6BAAAAAAAAAAAAAAAAAP//gAAAAAAB"
      "AAAA5g4AAKb3//9o+///0wERMAs06P4HAKMnLPEARI9AHyIeIh8iAgIQAAAAOAAAAB4AAAATAAAADwAAABMAAAAMAAAA"
      "EwAAAAsAAABIAAAAWAAAABIAAAATAAAAMIT767onBOeio1FQ+/u9clDMvj7nx/cATzP4Qmn7b0M8yZO8RS1s6M2vEAfZ"
      "vf9WwC3hJJ8AAABSKX9azutFpa2s9EOAiTnBlE1DUz7GVz3GmsAAAAALCwWFhYWFhYV9fY+PiIB4AAAAAAAAAAAAAAQQ"
      "wee+AAAARfqxOnkGIthXHf3Df+2oegAAAFkCNynuQA8lFXoAADQ/JR+fn5+fn/39zpOTsM8AAADskFTkYMtc7QAAAC4A"
      "/HkeE4mrjKEP/Qr+B0+q6/OwkoZ5JIScMTq7/xEhInkwpKt/Cjx4CpvZZjgm1jAEFtz3k9+pWMj0ev+DJEhsNSMF9GAA"
      "AKgBsNKu/wf2GhIR8gIH7iQX+A/8Bd8IX6EQf5AQAD9xIMBA38B+5ED/gAAAfgSQ9ZUK9AX/AfeqFegUDBv4AA/caAgX"
      "2AgfuRB/kE/wP3Ig/yAgAAEAAAD/AX+A/wAAAf8AAv//AAKAAAAAAAAAAAAAAQD/f4AAAAABAAAAchUAAGf3//+n9v//"
      "0QERMQliTP/jD6ebxCCAfMVATkBQQE5AAgQIAAAAGwAAABEAAAALAAAACQAAAAsAAAAJAAAACwAAAAAAAAATAAAAMAAA"
      "AAsAAAAAAAAAMHSDWT1+bqgiJpaq/I3+4jOcKHo5g7JXggAAVK8Lv3kc1jlegjz6l4kAAAAJCQSEhIyMeAAAAEEDz777"
      "4AAAAD9JLU3A3CfJAAAAQjNpG0ejAAAAYmLGxnv7+wUAAAAoTpORGGF0jQWXF+oaTZj/AAAA/gWHAAAAAfwMCAAEAAP4"
      "EBAIAAAH8DAgD/AAD+BAP+BAAB/BAIA/gAAfgYGBAAAAAP8AgX5/gYAAAAAAAAAAAwAAAEv+3uWRAAAA"}}};

}  // namespace adasplats::laz_test
