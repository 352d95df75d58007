// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace deltasplat {

/// Returns the bytes of memory that this process may still take without swapping (cgroup limits
/// included).
std::uint64_t availableMemory();

/// Returns "512 bytes", "1.5 MiB", "23.4 GiB", ...
std::string humanBytes(double bytes);

/// Throws unless `bytes` more fit into memory. Asks the system once for every 64 MiB or more, so
/// that small requests cost little.
/// @throw Error(kFailed) "<what>: needs 12.0 GiB of memory; expected at most 3.4 GiB, which is
/// available"
void requireMemory(const std::string& what, double bytes);

/// The same for memory that a number in an input's header asks for. Where the memory does not fit,
/// the number is wrong, and so is the input.
/// @throw Error(kInput) as requireMemory
void requireClaimedMemory(const std::string& what, double bytes);

/// Announces that the calling thread will allocate so many bytes in small pieces, and keep them.
/// Its heap then grows in large steps. Without that, glibc asks the system for every 4 KiB in all
/// threads but the first, and all threads wait for memory meanwhile.
void expectPieces(std::size_t bytes);

}  // namespace deltasplat
