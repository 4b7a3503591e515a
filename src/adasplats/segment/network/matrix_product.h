// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace adasplats {

/// c = a * b, row by row: (rows, inner) by (inner, columns). May be called from several threads;
/// each product is made by the thread that asks. Errors: unavailable (built without OpenBLAS).
void multiply(const float* a, const float* b, float* c, std::size_t rows, std::size_t inner,
              std::size_t columns);

/// Errors: unavailable, saying what is missing and how to get it, where products cannot be made.
void require_products();

}  // namespace adasplats
