// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>
#include <utility>
#include <variant>

#include "adasplats/core/setting.h"
#include "adasplats/splats/consistent/consistent_model.h"
#include "adasplats/splats/paper/paper_options.h"

namespace adasplats {

/// A method of making splats from points, with its options.
using MethodOptions = std::variant<ConsistentOptions, PaperOptions>;

/// Names of the methods: the consistent method and the paper's variants.
enum class SplatMethod : std::uint8_t { consistent, basic, descriptors, semantic };
inline constexpr std::pair<std::string_view, SplatMethod> kSplatMethods[] = {
    {"consistent", SplatMethod::consistent},
    {"basic", SplatMethod::basic},
    {"descriptors", SplatMethod::descriptors},
    {"semantic", SplatMethod::semantic}};
inline Words<SplatMethod> words_of(SplatMethod) { return kSplatMethods; }

SplatMethod method_of(const MethodOptions& recipe);
/// Errors: usage (an option out of range).
void check(const MethodOptions& recipe);

/// A method as users choose it: its name, and the options of every method.
struct MethodChoice {
  SplatMethod method = SplatMethod::consistent;
  PaperOptions paper;  ///< `variant` is ignored: `method` decides it
  ConsistentOptions consistent;

  /// The chosen method with its options; those of the others have no effect (unused_settings()).
  MethodOptions recipe() const;
};

/// Calls visit(options, name of their methods) for the options of every method.
template <class Choice, class Visit>
void visit_methods(Choice& choice, Visit&& visit) {
  visit(choice.paper, "the paper's methods");
  visit(choice.consistent, "the method consistent");
}

template <class Visit>
void visit_settings(MethodChoice& choice, Visit&& visit) {
  visit(Setting{.name = "method",
                .help = "Modelling method: consistent agrees with the measured rays; the others "
                        "are the paper's variants (semantic needs labels)",
                .basic = true},
        choice.method);
  visit_methods(choice, [&](auto& options, const char*) { visit_settings(options, visit); });
}

}  // namespace adasplats
