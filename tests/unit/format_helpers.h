// SPDX-License-Identifier: Apache-2.0
// Files of foreign formats, byte by byte.
#pragma once

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "deltasplat/ingest/read_volume.h"
#include "unit/ingest_helpers.h"
#include "volume/code_tree.h"

namespace deltasplat::testing {

/// Returns the value of the voxel (x, y, z).
inline double valueAt(const Volume& volume, int x, int y, int z) {
    return volume.codeBook().valueOf(volume.codes()->tree().getValue(openvdb::Coord(x, y, z)));
}

/// Returns all values, x fastest.
inline std::vector<double> valuesOf(const Volume& volume) {
    std::vector<double> values;
    for (int z = 0; z <= volume.box().max.z; ++z) {
        for (int y = 0; y <= volume.box().max.y; ++y) {
            for (int x = 0; x <= volume.box().max.x; ++x) {
                values.push_back(valueAt(volume, x, y, z));
            }
        }
    }
    return values;
}

/// first, first + step, ... as T.
template <typename T>
std::vector<T> ramp(std::size_t count, double first = 0, double step = 1) {
    std::vector<T> values(count);
    for (std::size_t i = 0; i < count; ++i) values[i] = T(first + step * double(i));
    return values;
}

/// Writes numbers into bytes at given places.
class ByteImage {
  public:
    ByteImage(std::size_t size, bool bigEndian) : bytes_(size, '\0'), bigEndian_(bigEndian) {}
    template <typename T>
    void put(std::size_t place, const std::vector<T>& values) {
        const std::string bytes = bytesOf(values, bigEndian_);
        std::copy(bytes.begin(), bytes.end(), bytes_.begin() + std::ptrdiff_t(place));
    }
    void text(std::size_t place, const std::string& text) {
        std::copy(text.begin(), text.end(), bytes_.begin() + std::ptrdiff_t(place));
    }
    const std::string& bytes() const { return bytes_; }

  private:
    std::string bytes_;
    bool bigEndian_;
};

/// What a NIfTI file of our own making holds.
struct NiftiFile {
    int version = 1;
    bool bigEndian = false;
    std::vector<int> dims{4, 3, 2};
    int dataType = 4;  // int16
    int bits = 16;
    std::string magic;  // empty: right
    double slope = 0;
    double intercept = 0;
    int units = 2;
    double dataStart = 0;  // 0: behind the header
    int qformCode = 0;
    int sformCode = 1;
    std::vector<double> pixelSizes{1, 2, 3, 4, 1, 1, 1, 1};
    std::vector<double> quaternion{0, 0, 0, 0, 0, 0};  // b, c, d, offsets
    std::vector<double> sform{2, 0, 0, 10, 0, 3, 0, 20, 0, 0, 4, 30};
    std::string data;

    std::string bytes() const { return version == 1 ? first() : second(); }

  private:
    template <typename T>
    static std::vector<T> as(const std::vector<double>& values) {
        return {values.begin(), values.end()};
    }
    template <typename T>
    std::vector<T> dimField() const {
        std::vector<T> field(8, 1);
        field[0] = T(dims.size());
        std::copy(dims.begin(), dims.end(), field.begin() + 1);
        return field;
    }
    std::string first() const {
        ByteImage header(352, bigEndian);
        header.put<std::int32_t>(0, {348});
        header.put(40, dimField<std::int16_t>());
        header.put<std::int16_t>(70, {std::int16_t(dataType), std::int16_t(bits)});
        header.put(76, as<float>(pixelSizes));
        header.put<float>(
            108, {float(dataStart == 0 ? 352 : dataStart), float(slope), float(intercept)});
        header.text(123, std::string(1, char(units)));
        header.put<std::int16_t>(252, {std::int16_t(qformCode), std::int16_t(sformCode)});
        header.put(256, as<float>(quaternion));
        header.put(280, as<float>(sform));
        header.text(344, magic.empty() ? "n+1" : magic);
        return header.bytes() + data;
    }
    std::string second() const {
        ByteImage header(544, bigEndian);
        header.put<std::int32_t>(0, {540});
        header.text(4, magic.empty() ? std::string("n+2\0\r\n\x1a\n", 8) : magic);
        header.put<std::int16_t>(12, {std::int16_t(dataType), std::int16_t(bits)});
        header.put(16, dimField<std::int64_t>());
        header.put(104, pixelSizes);
        header.put<std::int64_t>(168, {std::int64_t(dataStart == 0 ? 544 : dataStart)});
        header.put<double>(176, {slope, intercept});
        header.put<std::int32_t>(344, {qformCode, sformCode});
        header.put(352, quaternion);
        header.put(400, sform);
        header.put<std::int32_t>(500, {units});
        return header.bytes() + data;
    }
};

/// Collects warnings.
struct Warnings {
    std::vector<std::string> lines;
    Listener listener() {
        Listener result;
        result.warning = [this](const std::string& line) { lines.push_back(line); };
        return result;
    }
};

/// Expects `file` to be refused with this message, and exit code 3.
inline void expectRefused(const std::string& message, const std::string& file,
                          const ReadOptions& options = {}) {
    expectError(ErrorCode::kInput, message, [&] { readVolume(file, options); });
}

/// Expects `file` to be refused with exit code 3 and one line.
inline void expectInputError(const std::string& file, const ReadOptions& options = {}) {
    try {
        readVolume(file, options);
        ADD_FAILURE() << file << " was read";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::kInput) << error.what();
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
}

}  // namespace deltasplat::testing
