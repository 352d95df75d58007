// SPDX-License-Identifier: Apache-2.0
// Based on: Netpbm's description of its pgm format.
#include "oiio/pgm_samples.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "base/memory.h"
#include "deltasplat/error.h"
#include "files/file_bytes.h"
#include "files/file_name.h"

namespace deltasplat {
namespace {

constexpr std::uint32_t kMost = 65535;

// Takes numbers from the front of a file's bytes.
class Numbers {
  public:
    Numbers(const std::filesystem::path& file, const std::vector<unsigned char>& bytes)
        : file_(file), bytes_(bytes) {}

    // What stands between numbers is passed over, comments too.
    std::uint32_t next() {
        while (place_ < bytes_.size() && !std::isdigit(bytes_[place_])) {
            const unsigned char byte = bytes_[place_++];
            if (byte == '#') {
                while (place_ < bytes_.size() && bytes_[place_] != '\n') ++place_;
            } else if (!std::isspace(byte)) {
                refuseFile(file_, "a byte " + std::to_string(byte) + " where a number should be",
                           "a whole .pgm image");
            }
        }
        if (place_ == bytes_.size())
            refuseFile(file_, "a file that is cut short", "a whole .pgm image");
        std::uint64_t number = 0;
        for (; place_ < bytes_.size() && std::isdigit(bytes_[place_]); ++place_) {
            number = 10 * number + (bytes_[place_] - '0');
            if (number > 0xffffffff) refuseFile(file_, "a number of many digits", "a .pgm image");
        }
        return std::uint32_t(number);
    }
    // The raster of a binary image begins behind one byte.
    std::size_t place() const { return place_; }
    void skip(std::size_t bytes) { place_ += bytes; }

  private:
    const std::filesystem::path& file_;
    const std::vector<unsigned char>& bytes_;
    std::size_t place_ = 0;
};

void put(std::uint32_t sample, std::size_t width, std::byte* to) {
    const auto small = std::uint8_t(sample);
    const auto large = std::uint16_t(sample);
    std::memcpy(to, width == 1 ? static_cast<const void*>(&small) : &large, width);
}

}  // namespace

bool isPgm(const std::filesystem::path& file) {
    char magic[2];
    const FileBytes bytes(file);
    return bytes.read(0, magic, 2) == 2 && magic[0] == 'P' && (magic[1] == '2' || magic[1] == '5');
}

void readPgm(const std::filesystem::path& file, std::size_t pixels, std::span<std::byte> to) {
    const FileBytes source(file);
    const auto read = [&](std::uint64_t place, std::uint64_t size) {
        requireClaimedMemory(file.string(), double(size));
        std::vector<unsigned char> bytes(size);
        bytes.resize(source.read(place, bytes.data(), bytes.size()));
        return bytes;
    };
    // Comments aside, a header has some twenty bytes.
    constexpr std::uint64_t kMostHeader = std::uint64_t{1} << 16;
    std::vector<unsigned char> bytes = read(0, std::min(kMostHeader, source.size()));
    const bool isBinary = bytes.size() > 1 && bytes[1] == '5';
    if (!isBinary) bytes = read(0, source.size());
    Numbers numbers(file, bytes);
    numbers.skip(2);
    const std::uint64_t size = std::uint64_t{numbers.next()} * numbers.next();
    const std::uint32_t most = numbers.next();
    if (size != pixels) refuseFile(file, std::to_string(size) + " pixels", std::to_string(pixels));
    if (most < 1 || most > kMost) {
        refuseFile(file, "samples up to " + std::to_string(most),
                   "at most " + std::to_string(kMost) + ", at least 1");
    }
    const std::size_t width = most < 256 ? 1 : 2;
    if (to.size() != pixels * width) {
        refuseFile(file, std::to_string(width) + " bytes a sample",
                   std::to_string(to.size() / pixels));
    }
    std::vector<unsigned char> raster;
    if (isBinary) {
        raster = read(numbers.place() + 1, pixels * width);
        if (raster.size() < pixels * width)
            refuseFile(file, "a file that is cut short", "a whole .pgm image");
    }
    const unsigned char* next = raster.data();
    for (std::size_t i = 0; i < pixels; ++i) {
        std::uint32_t sample = 0;
        if (!isBinary) {
            sample = numbers.next();
        } else {
            for (std::size_t n = 0; n < width; ++n) sample = sample << 8 | *next++;
        }
        if (sample > most) {
            refuseFile(file, "a sample of " + std::to_string(sample),
                       "at most " + std::to_string(most) + ", as its header says");
        }
        put(sample, width, to.data() + i * width);
    }
}

}  // namespace deltasplat
