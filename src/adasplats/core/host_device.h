// SPDX-FileCopyrightText: 2026 The adasplats authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Functions marked ADASPLATS_HD are compiled for the host and, under nvcc, for the device, so that
// the maths of one element is written once for all backends.
#if defined(__CUDACC__)
#define ADASPLATS_HD __host__ __device__
#define ADASPLATS_HD_INLINED __host__ __device__ inline
#else
#define ADASPLATS_HD
// For bodies that are also compiled for lanes: they take the instructions of their caller.
#define ADASPLATS_HD_INLINED [[gnu::always_inline]] inline
#endif
