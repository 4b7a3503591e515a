// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/core/setting.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>

#include "adasplats/core/error.h"

namespace adasplats {
namespace {

struct Triple {
  double x = 1, y = 1, z = 1;
  std::array<double, 3> factors() const { return {x, y, z}; }
};

struct Oven {
  int rounds = 3;
  double heat = 180;
  std::optional<double> hours;
  bool fan = true;
  Triple triple;
};

template <class Visit>
void visit_settings(Oven& oven, Visit&& visit) {
  visit(Setting{.name = "rounds", .help = "h", .min = 1, .max = 64}, oven.rounds);
  visit(Setting{.name = "top_heat", .help = "h", .key = "top_heat_c", .min = 0}, oven.heat);
  visit(Setting{.name = "hours", .help = "h", .min = 0, .max = 1, .exclusive_min = true},
        oven.hours);
  visit(Setting{.name = "fan", .help = "h"}, oven.fan);
  visit(Setting{.name = "triple", .help = "h", .min = 0, .exclusive_min = true}, oven.triple);
}

std::string refusal(const Oven& oven) {
  try {
    check_settings(oven);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    return error.what();
  }
  return "";
}

TEST(Setting, RangesAreCheckedByName) {
  EXPECT_EQ(refusal({}), "");
  EXPECT_EQ(refusal({.rounds = 1, .heat = 0, .hours = 1}), "");
  EXPECT_EQ(refusal({.rounds = 65}), "`rounds` is 65, expected 1 to 64");
  EXPECT_EQ(refusal({.heat = -0.5}), "`top_heat` is -0.5, expected 0 or more");
  EXPECT_EQ(refusal({.heat = std::nan("")}), "`top_heat` is nan, expected 0 or more");
  EXPECT_EQ(refusal({.heat = HUGE_VAL}), "`top_heat` is inf, expected 0 or more");
  EXPECT_EQ(refusal({.hours = 0}), "`hours` is 0, expected more than 0, at most 1");
  EXPECT_EQ(refusal({.triple = {1, 1, 0}}), "`triple` is 0, expected more than 0");
}

TEST(Setting, NumbersAreWrittenPlainly) {
  EXPECT_EQ(range_text({.name = "n", .help = "", .min = 3, .max = 1e5}), "3 to 100000");
  EXPECT_EQ(range_text({.name = "n", .help = "", .min = 0.001, .max = 1e4}), "0.001 to 10000");
  EXPECT_EQ(range_text({.name = "n", .help = "", .max = 0.25}), "at most 0.25");
  EXPECT_EQ(range_text({.name = "n", .help = ""}), "a finite number");
}

TEST(Setting, MessagesNameSettingsAsTheirUsersDo) {
  const char* message = "`max_distance` M keeps them, `strict` does not; `open";
  EXPECT_EQ(with_settings_as_options(message),
            "--max-distance M keeps them, --strict does not; `open");
  EXPECT_EQ(with_settings_as(message, [](std::string name) { return "<" + name + ">"; }),
            "<max_distance> M keeps them, <strict> does not; `open");
  EXPECT_EQ(with_settings_as_options("/a`b c`/`x.ply: `strict`"), "/a`b c`/`x.ply: --strict");
  EXPECT_EQ(with_settings_as_options(""), "");
  EXPECT_EQ(with_settings_as_options("none"), "none");
}

TEST(Setting, HasAnOptionAKeyAndAnEntryInItsTable) {
  const std::vector<Setting> settings = settings_of<Oven>();
  ASSERT_EQ(settings.size(), 5U);
  EXPECT_EQ(option_of(settings[1]), "--top-heat");
  EXPECT_STREQ(settings[1].key, "top_heat_c");
  EXPECT_STREQ(settings[0].key, "rounds");
}

}  // namespace
}  // namespace adasplats
