// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
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

/// Returns the bytes of memory that the cgroups of this process leave it: the least of all limits,
/// less the memory in use there. Page cache does not count, because it makes room by itself. Reads
/// both versions of cgroups, wherever they are mounted. Without a limit: the largest number.
/// @param root  "/", or a test's folder with the same files
std::uint64_t cgroupAvailable(const std::filesystem::path& root);

/// Returns the number of processors whose time these cgroups leave the process, rounded up. Without
/// a limit: the largest number.
int cgroupProcessors(const std::filesystem::path& root);

}  // namespace deltasplat
