// SPDX-License-Identifier: Apache-2.0
#pragma once

// ITK's packaged headers refuse every compiler but the one that ITK was built with. Included before
// them, this makes Clang pass for it, in that one header.
#ifdef __clang__
#pragma push_macro("__clang__")
#pragma push_macro("__GNUC__")
#undef __clang__
#undef __GNUC__
#define __GNUC__ 12  // NOLINT(bugprone-reserved-identifier)
#include <itk_compiler_detection.h>
#pragma pop_macro("__GNUC__")
#pragma pop_macro("__clang__")
#endif
