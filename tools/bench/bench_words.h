// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "bench/bench_report.h"

namespace deltasplat {

// What the text and the page both say, in the same words.

/// Returns seconds as milliseconds with two digits behind the point, below 1 with three.
std::string millisecondsText(double seconds);

/// Returns a number with so many digits behind the point, "-" for what is not finite.
std::string fixedText(double number, int digits);

/// Returns a count in groups of three digits, thin spaces between them (UTF-8).
std::string groupedText(std::uint64_t count);

/// Returns a small number with three digits, "none known" for infinity.
std::string errorText(double error);

/// Returns "AMD EPYC 7763, 2 logical cores, AVX2, 7.6 GiB of memory".
std::string hardwareText(const Machine& machine);

/// Returns "deltasplat 0.1.0, OpenVDB 10.0.1, ...; GCC 12.2.0; Debian ...".
std::string softwareText(const Machine& machine);

/// Returns "256 x 256 x 128 voxels, 14.41 % visible, 13.36 % deltas (comparability 0.8664)".
std::string volumeText(const BenchRun& run);

/// Returns "512 x 512 pixels, composite, 1 thread; 128 slices along z in 8 slabs, ...".
std::string pictureText(const BenchEntry& entry);

/// Returns whether all pixels are the same, and if not, how far apart they are.
std::string identityText(const BenchRun& run);

}  // namespace deltasplat
