// SPDX-License-Identifier: Apache-2.0
// Based on: the OpenVDB file format, as OpenVDB 10's headers read it (LeafNode.h, InternalNode.h,
// io/Compression.h).
#include "formats/vdb/packed_values.h"

#include <blosc.h>
#include <openvdb/Types.h>
#include <openvdb/io/Compression.h>
#include <zlib.h>

#include <array>
#include <bit>
#include <cstring>
#include <type_traits>

namespace deltasplat {

bool unpackZip(std::span<const char> chunk, std::span<char> values, std::size_t size) {
    uLongf unpacked = values.size();
    const int status =
        ::uncompress(reinterpret_cast<Bytef*>(values.data()), &unpacked,
                     reinterpret_cast<const Bytef*>(chunk.data()), uLong(chunk.size()));
    return status == Z_OK && unpacked == size;
}

namespace {

// Reads fields from the front of some bytes.
class Front {
  public:
    explicit Front(std::span<const char> bytes) : rest_(bytes) {}

    template <typename T>
    bool take(T& value) {
        if (rest_.size() < sizeof value) return false;
        std::memcpy(&value, rest_.data(), sizeof value);
        rest_ = rest_.subspan(sizeof value);
        return true;
    }
    bool skip(std::size_t bytes) {
        if (rest_.size() < bytes) return false;
        rest_ = rest_.subspan(bytes);
        return true;
    }
    std::span<const char> rest() const { return rest_; }

  private:
    std::span<const char> rest_;
};

}  // namespace

std::optional<PackedValues> packedValues(std::span<const char> bytes,
                                         std::span<const std::uint64_t> mask,
                                         const VdbValueFormat& format) {
    using namespace openvdb::io;
    Front front(bytes);
    std::uint8_t kind = 0;
    if (!front.take(kind) || !front.skip(format.inactiveBytes(kind, mask.size_bytes())))
        return std::nullopt;
    auto count = std::uint32_t(64 * mask.size());
    if ((format.compression & COMPRESS_ACTIVE_MASK) != 0 && kind != NO_MASK_AND_ALL_VALS) {
        count = 0;
        for (const std::uint64_t word : mask) count += std::uint32_t(std::popcount(word));
    }
    const std::size_t size = std::size_t{format.stored} * count;
    if ((format.compression & (COMPRESS_BLOSC | COMPRESS_ZIP)) == 0 ||
        (format.areKeptAsHalves() && count == 0)) {
        if (front.rest().size() != size) return std::nullopt;
        return PackedValues{count, front.rest(), false};
    }
    std::int64_t packed = 0;
    if (!front.take(packed)) return std::nullopt;
    // A negative size marks values that are not packed.
    const std::uint64_t stored = packed > 0 ? std::uint64_t(packed) : size;
    if (front.rest().size() != stored || (packed <= 0 && packed != -std::int64_t(size)))
        return std::nullopt;
    return PackedValues{count, front.rest(), packed > 0};
}

bool unpackBlosc(std::span<const char> chunk, std::span<char> values, std::size_t size) {
    // The decoder trusts the sizes in the second and fourth word of a chunk.
    std::array<std::uint32_t, 4> words;
    if (chunk.size() < sizeof words) return false;
    std::memcpy(words.data(), chunk.data(), sizeof words);
    if (words[1] != size || words[3] != chunk.size()) return false;
    if (size == 0) return true;
    // The third byte flags values that are only copied behind these words; the first byte is the
    // format's version. Copying them here saves loading Blosc.
    constexpr std::uint32_t kIsStored = std::uint32_t{BLOSC_MEMCPYED} << 16;
    if ((words[0] & kIsStored) != 0 && (words[0] & 0xff) == BLOSC_VERSION_FORMAT) {
        if (chunk.size() != sizeof words + size || values.size() < size) return false;
        std::memcpy(values.data(), chunk.data() + sizeof words, size);
        return true;
    }
    const int count = blosc_decompress_ctx(chunk.data(), values.data(), values.size(), 1);
    return count > 0 && std::size_t(count) == size;
}

bool unpack(const PackedValues& packed, const VdbValueFormat& format, std::span<char> values) {
    const std::size_t size = std::size_t{format.stored} * packed.count;
    if (packed.isPacked) {
        const bool isBlosc = (format.compression & openvdb::io::COMPRESS_BLOSC) != 0;
        return isBlosc ? unpackBlosc(packed.data, values, size)
                       : unpackZip(packed.data, values, size);
    }
    std::memcpy(values.data(), packed.data.data(), size);
    return true;
}

namespace {

template <typename T>
using Traits = openvdb::VecTraits<T>;

// Returns OpenVDB's opposite of a value.
template <typename T>
T opposite(const T& value) {
    if constexpr (Traits<T>::IsVec) {
        T parts;
        for (int i = 0; i < Traits<T>::Size; ++i) parts[i] = opposite(value[i]);
        return parts;
    } else if constexpr (std::is_same_v<T, std::uint8_t>) {
        return value == 0;  // a bool
    } else if constexpr (std::is_floating_point_v<T>) {
        return -value;
    } else {
        return T(0 - std::make_unsigned_t<T>(value));
    }
}

// Values of inactive places in a node that stores active values alone.
template <typename T>
struct InactivePlaces {
    std::array<T, 2> values;
    std::span<const char> second;  // a bit per place that has the second value; empty: no place has

    // @param bytes  checked to be long enough
    InactivePlaces(std::span<const char> bytes, std::size_t maskBytes, T background,
                   const VdbValueFormat& format) {
        using namespace openvdb::io;
        const auto kind = std::uint8_t(bytes[0]);
        values = {kind == NO_MASK_OR_INACTIVE_VALS ? background : opposite(background), background};
        const bool hasTwo = kind == MASK_AND_TWO_INACTIVE_VALS;
        const bool hasOne =
            kind == NO_MASK_AND_ONE_INACTIVE_VAL || kind == MASK_AND_ONE_INACTIVE_VAL || hasTwo;
        const std::size_t count = std::size_t{hasOne} + std::size_t{hasTwo};
        const std::size_t size = count * format.alone;
        for (std::size_t i = 0; i < count; ++i)
            values[i] = valueAlone<T>(&bytes[1 + i * format.alone], format);
        if (hasTwo || kind == MASK_AND_ONE_INACTIVE_VAL || kind == MASK_AND_NO_INACTIVE_VALS)
            second = bytes.subspan(1 + size, maskBytes);
    }
    T at(std::size_t place) const {
        const bool isSecond =
            !second.empty() && (std::uint8_t(second[place / 8]) >> (place % 8) & 1) != 0;
        return values[isSecond ? 1 : 0];
    }
};

template <typename T>
void widen(const char* stored, std::size_t count, bool areHalves, T* values) {
    if (!areHalves) {
        std::memcpy(static_cast<void*>(values), stored, count * sizeof(T));
        return;
    }
    const auto take = [&](auto& value) {
        openvdb::math::half half;
        std::memcpy(&half, stored, sizeof half);
        stored += sizeof half;
        value = std::decay_t<decltype(value)>(float(half));
    };
    for (std::size_t i = 0; i < count; ++i) {
        if constexpr (Traits<T>::IsVec) {
            for (int part = 0; part < Traits<T>::Size; ++part) take(values[i][part]);
        } else {
            take(values[i]);
        }
    }
}

}  // namespace

template <typename T>
bool unpackAll(std::span<const char> bytes, std::span<const std::uint64_t> mask,
               const VdbValueFormat& format, T background, std::vector<char>& stored, T* values) {
    const auto packed = packedValues(bytes, mask, format);
    if (!packed) return false;
    const std::size_t size = std::size_t{format.stored} * packed->count + kUnpackBytes;
    if (stored.size() < size) stored.resize(size);
    if (!unpack(*packed, format, {stored.data(), size})) return false;
    widen(stored.data(), packed->count, format.areHalves(), values);
    const std::size_t places = 64 * mask.size();
    if (packed->count == places) return true;
    // Runs backwards: each value moves to its own place or a later one.
    const InactivePlaces<T> inactive(bytes, mask.size_bytes(), background, format);
    std::size_t next = packed->count;
    for (std::size_t place = places; place-- > 0;) {
        const bool isActive = (mask[place / 64] >> (place % 64) & 1) != 0;
        values[place] = isActive ? values[--next] : inactive.at(place);
    }
    return true;
}

using Bytes = std::span<const char>;
using MaskWords = std::span<const std::uint64_t>;
template bool unpackAll(Bytes, MaskWords, const VdbValueFormat&, float, std::vector<char>&, float*);
template bool unpackAll(Bytes, MaskWords, const VdbValueFormat&, double, std::vector<char>&,
                        double*);
template bool unpackAll(Bytes, MaskWords, const VdbValueFormat&, std::int32_t, std::vector<char>&,
                        std::int32_t*);
template bool unpackAll(Bytes, MaskWords, const VdbValueFormat&, std::int64_t, std::vector<char>&,
                        std::int64_t*);
template bool unpackAll(Bytes, MaskWords, const VdbValueFormat&, std::uint8_t, std::vector<char>&,
                        std::uint8_t*);
template bool unpackAll(Bytes, MaskWords, const VdbValueFormat&, openvdb::Vec3f, std::vector<char>&,
                        openvdb::Vec3f*);
template bool unpackAll(Bytes, MaskWords, const VdbValueFormat&, openvdb::Vec3d, std::vector<char>&,
                        openvdb::Vec3d*);
template bool unpackAll(Bytes, MaskWords, const VdbValueFormat&, openvdb::Vec3i, std::vector<char>&,
                        openvdb::Vec3i*);

std::int64_t appendBlosc(const void* values, std::size_t bytes, std::string& to) {
    const std::size_t place = to.size();
    const std::size_t most = bytes + BLOSC_MAX_OVERHEAD;
    to.resize(place + most);
    // OpenVDB's parameters, whatever the size of a value.
    constexpr int kLevel = 9;
    constexpr std::size_t kTypeSize = 4;
    const int size = blosc_compress_ctx(kLevel, BLOSC_SHUFFLE, kTypeSize, bytes, values,
                                        to.data() + place, most, BLOSC_LZ4_COMPNAME,
                                        /*blocksize=*/bytes, /*numinternalthreads=*/1);
    to.resize(place + std::size_t(std::max(0, size)));
    return std::max(0, size);
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
