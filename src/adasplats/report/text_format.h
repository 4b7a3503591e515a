// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

// Readable numbers, independent of the locale.
namespace adasplats::page {

inline constexpr const char* kMissing = "–";

/// With that many decimals and a comma between thousands.
std::string fixed_text(double number, int digits);
/// Three significant digits: "0.123", "1.23", "12.3", "123", "1,234".
std::string measure_text(double number);
/// One or two decimals, as in the paper: "2.3", "1.97".
std::string short_text(double number);
/// "940", "71.5 k", "5.40 M".
std::string count_text(double number);
/// "2.30".
std::string hundredths_text(double number);
/// "1,234".
std::string whole_text(double number);
/// "12.3".
std::string tenths_text(double number);
/// Decimal units: "281 MB", "20.0 GB".
std::string bytes_text(double bytes);
/// Safe as text and as a quoted attribute of HTML; control characters are dropped.
std::string html_escape(std::string_view text);

}  // namespace adasplats::page
