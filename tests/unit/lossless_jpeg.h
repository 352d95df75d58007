// SPDX-License-Identifier: Apache-2.0
// Based on: ITU-T T.81 (1992), annex H: lossless JPEG, here of one grey channel of 16 bits, by the
// left neighbour, with Huffman codes of five bits for all.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "unit/ingest_helpers.h"

namespace deltasplat::testing {

class BitWriter {
  public:
    void put(std::uint32_t value, int bits) {
        for (int i = bits - 1; i >= 0; --i) add(value >> i & 1);
    }
    std::string finish() {
        while (count_ != 0) add(1);
        return bytes_;
    }

  private:
    void add(std::uint32_t bit) {
        byte_ = byte_ << 1 | bit;
        if (++count_ < 8) return;
        bytes_ += char(byte_);
        // A byte that looks like the begin of a marker is followed by a zero.
        if ((byte_ & 0xff) == 0xff) bytes_ += '\0';
        count_ = 0;
        byte_ = 0;
    }
    std::string bytes_;
    std::uint32_t byte_ = 0;
    int count_ = 0;
};

/// Where the code stream of a JPEG begins.
inline std::size_t scanStart(const std::string& jpeg) {
    const std::size_t marker = jpeg.find("\xff\xda");
    return marker + 2 + std::size_t(static_cast<unsigned char>(jpeg[marker + 3]));
}

/// Packs pixels, row by row.
inline std::string losslessJpeg(int columns, int rows, const std::vector<std::uint16_t>& pixels) {
    const auto word = [](int value) {
        return bytesOf<std::uint16_t>({std::uint16_t(value)}, true);
    };
    std::string lengths(16, '\0');
    lengths[4] = 17;  // so many codes of five bits
    std::string categories;
    for (int i = 0; i < 17; ++i) categories += char(i);
    std::string jpeg = "\xff\xd8\xff\xc3" + word(11) + '\x10' + word(rows) + word(columns);
    jpeg += std::string("\x01\x01\x11\x00", 4);
    jpeg += "\xff\xc4" + word(2 + 1 + 16 + 17) + std::string(1, '\0') + lengths + categories;
    jpeg += "\xff\xda" + word(8) + std::string("\x01\x01\x00\x01\x00\x00", 6);
    BitWriter bits;
    for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < columns; ++x) {
            const std::size_t at = std::size_t(y) * std::size_t(columns) + std::size_t(x);
            const int before = x > 0   ? pixels[at - 1]
                               : y > 0 ? pixels[at - std::size_t(columns)]
                                       : 1 << 15;
            const int change = std::int16_t(pixels[at] - before);
            int category = 0;
            while (change != 0 && std::abs(change) >> category != 0) ++category;
            bits.put(std::uint32_t(category), 5);
            const int code = change < 0 ? change + (1 << category) - 1 : change;
            if (category < 16) bits.put(std::uint32_t(code), category);
        }
    }
    return jpeg + bits.finish() + "\xff\xd9";
}

}  // namespace deltasplat::testing
