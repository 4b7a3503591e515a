// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// For sources only: toml++.

// toml++ 3 asserts conditions that malformed files violate ("a = [}") before it reports their
// error.
#define TOML_ASSERT(expression) static_cast<void>(0)
#include <toml++/toml.h>
