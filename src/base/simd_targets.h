// SPDX-License-Identifier: Apache-2.0
// Include before any header of Highway: which SIMD levels the kernels are compiled for.
#pragma once

// The fallback for any processor works on four lanes at a time, as the kernels need. Highway avoids
// it with GCC before 12.3 because of a miscompiled high-half multiplication (GCC bug 106322), which
// no kernel uses.
#define HWY_BROKEN_EMU128 0

// The kernels keep vectors in structs, which the sizeless types of SVE do not allow; ARM64 runs
// NEON. Processors with SSSE3 and no SSE4 are of 2006: the fallback serves them, and a fifth of
// what compiling kernels takes is saved.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_SSSE3)
