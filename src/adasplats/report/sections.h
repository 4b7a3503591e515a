// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "adasplats/report/results.h"

// The sections of the report, made from the results.
namespace adasplats::page {

/// Everything in the order of the page; empty sections are left out.
Document document_of(const Json& results);

Section paper_section(const Json& results, const std::vector<Competitor>& competitors);
Section cost_section(const std::vector<Competitor>& competitors);
Section clouds_section(const std::vector<Competitor>& competitors);
Section beams_section(const std::vector<Competitor>& competitors);
Section truth_section(const std::vector<Competitor>& competitors);

}  // namespace adasplats::page
