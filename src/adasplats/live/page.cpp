// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/live/page.h"

namespace adasplats {
namespace {

constexpr unsigned char kLivePage[] = {
#include "live_page.inc"
};
constexpr unsigned char kLiveScript[] = {
#include "live_script.inc"
};

}  // namespace

std::string_view live_page() {
  return {reinterpret_cast<const char*>(kLivePage), sizeof kLivePage};
}
std::string_view live_script() {
  return {reinterpret_cast<const char*>(kLiveScript), sizeof kLiveScript};
}

}  // namespace adasplats
