// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#include "adasplats/splats/method_options.h"

#include <stdexcept>

namespace adasplats {
namespace {

struct MethodOf {
  SplatMethod operator()(const ConsistentOptions&) const { return SplatMethod::consistent; }
  SplatMethod operator()(const PaperOptions& paper) const {
    switch (paper.variant) {
      case PaperVariant::basic: return SplatMethod::basic;
      case PaperVariant::descriptors: return SplatMethod::descriptors;
      case PaperVariant::semantic: return SplatMethod::semantic;
    }
    throw std::logic_error("an unknown variant");
  }
};

PaperOptions with_variant(PaperOptions paper, PaperVariant variant) {
  paper.variant = variant;
  return paper;
}

}  // namespace

SplatMethod method_of(const MethodOptions& recipe) { return std::visit(MethodOf{}, recipe); }

void check(const MethodOptions& recipe) {
  std::visit([](const auto& options) { check(options); }, recipe);
}

MethodOptions MethodChoice::recipe() const {
  switch (method) {
    case SplatMethod::consistent: return consistent;
    case SplatMethod::basic: return with_variant(paper, PaperVariant::basic);
    case SplatMethod::descriptors: return with_variant(paper, PaperVariant::descriptors);
    case SplatMethod::semantic: return with_variant(paper, PaperVariant::semantic);
  }
  throw std::logic_error("an unknown method");
}

}  // namespace adasplats
