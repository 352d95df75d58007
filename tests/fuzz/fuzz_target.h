// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "deltasplat/ingest/read_volume.h"

/// What every target defines, as libFuzzer wants it: takes any bytes, and aborts where the reader
/// breaks a promise.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace deltasplat::fuzz {

/// Sound inputs of this target, to be mutated; each target defines its own.
std::vector<std::string> seeds();

/// Returns the bytes under gzip.
std::string gzipped(const std::string& bytes);

/// Writes the bytes to a file of this process, always the same, and returns its path.
std::string fileWith(const std::string& extension, const std::uint8_t* data, std::size_t size);

/// Aborts, saying which promise was broken, unless it holds.
void require(bool holds, const char* what);

/// Runs the work; that it refuses is fine. Aborts if anything but an Error of one line comes out.
void expectErrorsOfOneLine(const std::function<void()>& work);

/// Reads every volume of the file and renders the small ones; a refusal is fine. Aborts if a volume
/// contradicts itself, if a pixel is no finite number or if anything but an Error comes out.
void readAndCheck(const std::string& file, const ReadOptions& options);

/// Returns a digest of every volume that readAndCheck has read, and of its picture, since the last
/// call; 0 if all was refused.
std::uint64_t takeDigest();

}  // namespace deltasplat::fuzz
