// SPDX-License-Identifier: Apache-2.0
#include "vdb/pack_values.h"

#include <blosc.h>

#include <array>
#include <cstring>

namespace deltasplat {
namespace {

std::int64_t appendChunk(const void* values, std::size_t bytes, int shuffle, std::size_t typeSize,
                         std::string& to) {
    constexpr int kLevel = 9;  // as OpenVDB has it
    const std::size_t place = to.size();
    const std::size_t most = bytes + BLOSC_MAX_OVERHEAD;
    to.resize(place + most);
    const int size =
        blosc_compress_ctx(kLevel, shuffle, typeSize, bytes, values, to.data() + place, most,
                           BLOSC_LZ4_COMPNAME, /*blocksize=*/bytes, /*numinternalthreads=*/1);
    to.resize(place + std::size_t(std::max(0, size)));
    return std::max(0, size);
}

// Of a chunk's header, and of what it says of its blocks.
constexpr std::size_t kFlags = 2;
constexpr std::size_t kBytes = 4;
constexpr std::size_t kPackedBytes = 12;
constexpr std::size_t kBlocks = 16;

void put(std::size_t number, std::size_t place, std::string& chunk) {
    const auto word = std::uint32_t(number);
    std::memcpy(&chunk[place], &word, sizeof word);
}

// Makes a chunk of one block one of two, of which the second is stored as it is.
void addBlock(const char* data, std::size_t bytes, std::size_t allBytes, std::string& chunk) {
    constexpr std::size_t kWord = sizeof(std::uint32_t);
    const std::size_t second = chunk.size() + kWord;
    chunk.insert(kBlocks + kWord, kWord, '\0');
    put(kBlocks + 2 * kWord, kBlocks, chunk);
    put(second, kBlocks + kWord, chunk);
    appendBytes(std::uint32_t(bytes), chunk);
    chunk.append(data, bytes);
    put(allBytes, kBytes, chunk);
    put(chunk.size(), kPackedBytes, chunk);
}

}  // namespace

std::int64_t appendBlosc(const void* values, std::size_t bytes, std::string& to) {
    // What OpenVDB asks for, whatever the size of a value is.
    constexpr std::size_t kTypeSize = 4;
    return appendChunk(values, bytes, BLOSC_SHUFFLE, kTypeSize, to);
}

std::int64_t appendBloscBits(const void* values, std::size_t count, std::size_t bytesOfOne,
                             std::string& to) {
    // Blosc leaves the bits of a block where they are if its numbers are no multiple of eight: the
    // last up to seven become a block of their own.
    const std::size_t bytes = count * bytesOfOne;
    const std::size_t whole = count / 8 * 8 * bytesOfOne;
    if (whole == 0) return 0;
    std::string chunk;
    if (appendChunk(values, whole, BLOSC_BITSHUFFLE, bytesOfOne, chunk) == 0) return 0;
    if ((chunk[kFlags] & BLOSC_MEMCPYED) != 0) return 0;
    if (whole < bytes)
        addBlock(static_cast<const char*>(values) + whole, bytes - whole, bytes, chunk);
    if (chunk.size() >= bytes) return 0;
    to += chunk;
    return std::int64_t(chunk.size());
}

std::int64_t appendPacked(const void* values, std::size_t bytes, std::string& to) {
    const std::size_t place = to.size();
    appendBytes(std::int64_t{0}, to);
    std::int64_t size = appendBlosc(values, bytes, to);
    const std::int64_t noted = size > 0 ? size : std::int64_t(bytes);
    if (size == 0) {
        to.append(static_cast<const char*>(values), bytes);
        size = -std::int64_t(bytes);
    }
    to.replace(place, sizeof size, reinterpret_cast<const char*>(&size), sizeof size);
    return noted;
}

}  // namespace deltasplat
