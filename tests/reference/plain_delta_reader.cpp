// SPDX-License-Identifier: Apache-2.0
#include "reference/plain_delta_reader.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

namespace deltasplat::testing {
namespace {

template <typename T>
T entry(const openvdb::GridBase& grid, const std::string& name) {
    const auto found = grid.getMetadata<openvdb::TypedMetadata<T>>(name);
    if (!found) throw std::runtime_error("no metadata " + name);
    return found->value();
}

// Section "Metadata": what is usual may be missing.
template <typename T>
T entry(const openvdb::GridBase& grid, const std::string& name, const T& byDefault) {
    return grid[name] ? entry<T>(grid, name) : byDefault;
}

std::vector<double> numbers(const std::string& text) {
    std::vector<double> list;
    std::istringstream words(text);
    for (std::string word; words >> word;) list.push_back(std::strtod(word.c_str(), nullptr));
    return list;
}

// Section "Packed deltas": bits of words that are the voxels of a grid.
class Bits {
  public:
    explicit Bits(const openvdb::Int64Grid& grid) : words_(grid.getConstAccessor()) {}
    std::uint64_t take(int count) {
        std::uint64_t taken = 0;
        for (int i = 0; i < count; ++i, ++next_) taken |= (word(next_ / 64) >> next_ % 64 & 1) << i;
        return taken;
    }
    std::uint64_t takeNumber() {
        int zeros = 0;
        while (take(1) == 0) ++zeros;
        return (std::uint64_t{1} << zeros) + take(zeros) - 1;
    }
    // Numbers of so many places, in planes.
    std::vector<std::uint64_t> takePlanes(std::size_t count, int parameter, int width) {
        std::vector<std::uint64_t> quotients(count), numbers(count);
        for (std::uint64_t level = 0; level < 8; ++level)
            for (std::uint64_t& quotient : quotients) quotient += quotient == level ? take(1) : 0;
        for (int bit = 0; bit < parameter; ++bit)
            for (std::uint64_t& number : numbers) number |= take(1) << bit;
        for (std::size_t i = 0; i < count; ++i) {
            const bool isLarge = quotients[i] == 8;
            numbers[i] += (isLarge ? take(width - parameter) : quotients[i]) << parameter;
        }
        return numbers;
    }
    int takeParameter(int width) { return int(take(width > 32 ? 6 : 5)); }
    void skipToWord() { next_ = (next_ + 63) / 64 * 64; }
    // The CRC-32 of all words so far.
    std::uint64_t sum() {
        std::uint32_t sum = 0xffffffff;
        for (std::uint64_t i = 0; i < next_ / 64; ++i) {
            for (int bit = 0; bit < 64; ++bit) {
                const bool isOdd = ((word(i) >> bit ^ sum) & 1) != 0;
                sum = sum >> 1 ^ (isOdd ? 0xedb88320 : 0);
            }
        }
        return std::uint64_t(~sum);
    }

  private:
    std::uint64_t word(std::uint64_t i) {
        const auto part = [&](int low, int bits) {
            return int(i >> low & ((std::uint64_t{1} << bits) - 1));
        };
        const openvdb::Coord place(part(6, 3) + 8 * part(17, 4) + 128 * part(31, 20),
                                   part(3, 3) + 8 * part(13, 4) + 128 * part(26, 5),
                                   part(0, 3) + 8 * part(9, 4) + 128 * part(21, 5));
        if (!words_.isValueOn(place)) throw std::runtime_error("the stream ends early");
        return std::uint64_t(words_.getValue(place));
    }
    openvdb::Int64Grid::ConstAccessor words_;
    std::uint64_t next_ = 0;
};

// Section "Exact books": slots of values, 32 or 64 bits, and the first of inactive ones.
struct ExactBook {
    explicit ExactBook(const std::string& kind) : kind_(kind) {}
    bool is32() const { return kind_ == "float32"; }
    bool isOne() const {
        return is32() || kind_ == "float64" || kind_ == "int32" || kind_ == "int64";
    }
    std::uint64_t firstInactive() const {
        if (kind_ == "float32") return 4286578689u;
        if (kind_ == "float64") return 18442240474082181121u;
        if (kind_ == "int32") return 4294967297u;
        return 18446744073709486080u;
    }
    double value(std::uint64_t code) const {
        if (kind_ == "float32") {
            const auto bits =
                std::uint32_t(code >= 2147483648u ? code - 2147483648u : 4294967295u - code);
            float value = 0;
            std::memcpy(&value, &bits, sizeof value);
            return double(value);
        }
        if (kind_ == "float64") {
            const std::uint64_t half = std::uint64_t{1} << 63;
            const std::uint64_t bits = code >= half ? code - half : ~code;
            double value = 0;
            std::memcpy(&value, &bits, sizeof value);
            return value;
        }
        if (kind_ == "int32") return double(std::int64_t(code) - 2147483648ll);
        return double(std::int64_t(code - (std::uint64_t{1} << 63)));
    }

  private:
    std::string kind_;
};

// Section "Code books".
class Book {
  public:
    explicit Book(const openvdb::GridBase& grid)
        : kind_(entry<std::string>(grid, "delta_code_book", "integer")) {
        if (kind_ == "integer" || kind_ == "linear")
            offset_ = entry<double>(grid, "delta_offset", 0);
        if (kind_ == "linear") step_ = entry<double>(grid, "delta_step");
        if (kind_ == "table") table_ = numbers(entry<std::string>(grid, "delta_table"));
        if (kind_ != "pieces") return;
        const std::vector<double> list = numbers(entry<std::string>(grid, "delta_pieces"));
        for (std::size_t i = 0; i < list.size(); i += 3) {
            for (int k = 0; k < int(list[i + 2]); ++k) table_.push_back(list[i] + list[i + 1] * k);
        }
    }
    double value(int code) const {
        if (!table_.empty()) return table_.at(std::size_t(code));
        if (kind_ != "half") return offset_ + step_ * code;
        const int bits = code >= 0x8000 ? code - 0x8000 : 0xffff - code;
        openvdb::math::half half;
        half.setBits(std::uint16_t(bits));
        return double(float(half));
    }

  private:
    std::string kind_;
    double offset_ = 0;
    double step_ = 1;
    std::vector<double> table_;
};

// Numbers of deltas as in the stream, [s][u][v] of the box in the order of slices; 0: none.
class PackedDeltas {
  public:
    PackedDeltas(const openvdb::Coord& first, const openvdb::Coord& last)
        : first_(first),
          size_(last - first + openvdb::Coord(1)),
          numbers_(std::size_t(size_.x()) * std::size_t(size_.y()) * std::size_t(size_.z())) {}
    std::uint64_t& at(const openvdb::Coord& suv) {
        const openvdb::Coord place = suv - first_;
        if (!openvdb::CoordBBox({0, 0, 0}, size_ - openvdb::Coord(1)).isInside(place))
            throw std::runtime_error("a delta outside of the box");
        return numbers_[(std::size_t(place.x()) * std::size_t(size_.y()) + std::size_t(place.y())) *
                            std::size_t(size_.z()) +
                        std::size_t(place.z())];
    }
    // What the stream says of codes, if it does: of columns (slab, u, v) of blocks, lowest and
    // highest; how many active voxels have each; and the box of these.
    struct Said {
        bool isThere = false;
        std::map<openvdb::Coord, std::pair<int, int>> ranges;
        std::map<int, std::uint64_t> counts;
        openvdb::Coord first = openvdb::Coord::max();
        openvdb::Coord last = openvdb::Coord::min();
    };
    void take(Bits& bits, int interval, int width) {
        std::vector<openvdb::Coord> columns;
        std::uint64_t slab = 0, u = 0, next = 0;
        const auto block = [](int low, std::uint64_t more) { return (low >> 3) + int(more); };
        const std::uint64_t number = bits.takeNumber();
        said.isThere = bits.take(1) == 1;
        for (std::uint64_t left = number; left > 0; --left) {
            const std::uint64_t moreSlabs = bits.takeNumber();
            slab += moreSlabs;
            if (moreSlabs > 0) u = next = 0;
            const std::uint64_t more = bits.takeNumber();
            u += more;
            if (more > 0) next = 0;
            next += bits.takeNumber() + 1;
            bits.takeNumber();  // its words: for those who read several at a time
            columns.push_back({block(first_.x(), slab * std::uint64_t(interval / 8)),
                               block(first_.y(), u), block(first_.z(), next - 1)});
            if (!said.isThere) continue;
            const int lowest = int(bits.takeNumber());
            said.ranges[columns.back()] = {lowest, lowest + int(bits.takeNumber())};
        }
        if (said.isThere) {
            int code = 0;
            for (std::uint64_t left = bits.takeNumber(); left > 0; --left, ++code) {
                code += int(bits.takeNumber());
                said.counts[code] = bits.takeNumber() + 1;
            }
            for (int axis = 0; axis < 3; ++axis) {
                said.first[axis] = first_[axis] + int(bits.takeNumber());
                said.last[axis] = first_[axis] + size_[axis] - 1 - int(bits.takeNumber());
            }
            bits.skipToWord();
            const std::uint64_t sum = bits.sum();
            if (bits.take(64) != sum) throw std::runtime_error("another sum");
        }
        for (const openvdb::Coord& column : columns) {
            bits.skipToWord();
            int s = column.x();
            for (std::uint64_t left = bits.takeNumber() + 1; left > 0; --left, ++s) {
                s += int(bits.takeNumber());
                takeBlock(bits, openvdb::Coord(8 * s, 8 * column.y(), 8 * column.z()), width);
            }
        }
    }

    Said said;

  private:
    void takeBlock(Bits& bits, const openvdb::Coord& corner, int width) {
        for (int s = 0; s < 8; ++s) {
            if (bits.take(1) == 0) continue;
            const int form = int(bits.take(2)), parameter = bits.takeParameter(width);
            std::uint64_t mask = form == 1 ? bits.take(64) : 0;
            if (form == 2) {
                const std::uint64_t rows = bits.take(8);
                for (int row = 0; row < 8; ++row)
                    mask |= (rows >> row & 1) == 0 ? 0 : bits.take(8) << 8 * row;
            }
            std::vector<int> places;
            for (int n = 0; n < 64; ++n)
                if (form == 0 || (mask >> n & 1) != 0) places.push_back(n);
            const std::vector<std::uint64_t> numbers =
                bits.takePlanes(places.size(), parameter, width);
            for (std::size_t i = 0; i < places.size(); ++i) {
                const std::uint64_t number = numbers[i] + (form != 0);
                if (number != 0)
                    at(corner + openvdb::Coord(s, places[i] / 8, places[i] % 8)) = number;
            }
        }
    }

    openvdb::Coord first_;
    openvdb::Coord size_;
    std::vector<std::uint64_t> numbers_;
};

}  // namespace

std::size_t PlainVolume::at(const openvdb::Coord& xyz) const {
    const openvdb::Coord size = max - min + openvdb::Coord(1), place = xyz - min;
    return (std::size_t(place.x()) * std::size_t(size.y()) + std::size_t(place.y())) *
               std::size_t(size.z()) +
           std::size_t(place.z());
}

double PlainVolume::valueAt(const openvdb::Coord& xyz) const {
    return openvdb::CoordBBox(min, max).isInside(xyz) ? values[at(xyz)] : background;
}

bool PlainVolume::activeAt(const openvdb::Coord& xyz) const {
    return openvdb::CoordBBox(min, max).isInside(xyz) && active[at(xyz)] != 0;
}

PlainVolume readPlainDeltas(const std::string& file, const std::string& name) {
    openvdb::initialize();
    openvdb::io::File input(file);
    input.open();
    const openvdb::GridBase::Ptr deltas = input.readGrid(name);
    const auto narrow = openvdb::gridPtrCast<openvdb::Int32Grid>(deltas);
    const auto wide = openvdb::gridPtrCast<openvdb::Int64Grid>(deltas);
    const int version = entry<std::int32_t>(*deltas, "delta_version");
    if (version != 6 && version != 7) throw std::runtime_error("version");
    const bool isPacked = version == 7;

    // Axis of the source that slices, u and v run along.
    const int axis = entry<std::string>(*deltas, "delta_slice_axis", "z")[0] - 'x';
    const int order[3] = {axis, (axis + 1) % 3, (axis + 2) % 3};
    PlainVolume volume;
    const auto low = entry(*deltas, "delta_box_min", openvdb::Vec3i(0));
    const auto high = entry(*deltas, "delta_box_max", openvdb::Vec3i(-1));
    volume.min = openvdb::Coord(low[0], low[1], low[2]);
    volume.max = openvdb::Coord(high[0], high[1], high[2]);
    volume.background = entry<double>(*deltas, "delta_background", 0);
    volume.sourceType = entry<std::string>(*deltas, "delta_source_type", "float");
    const openvdb::Mat4d permuted = deltas->transform().baseMap()->getAffineMap()->getMat4();
    volume.worldFromIndex = permuted;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column)
            volume.worldFromIndex[order[row]][column] = permuted[row][column];
    }
    for (auto meta = deltas->beginMeta(); meta != deltas->endMeta(); ++meta) {
        if (meta->first.compare(0, 7, "source:") == 0)
            volume.metadata.insertMeta(meta->first.substr(7), *meta->second);
    }
    if (low[0] > high[0] || low[1] > high[1] || low[2] > high[2]) return volume;

    const Book book(*deltas);
    const ExactBook exact(entry<std::string>(*deltas, "delta_code_book", "integer"));
    const bool restActive = entry<std::string>(*deltas, "delta_rest", "inactive") == "active";
    const std::vector<double> inactive =
        numbers(entry<std::string>(*deltas, "delta_inactive_values", ""));
    const int interval = entry<std::int32_t>(*deltas, "delta_key_interval", 128);
    const int firstSlab = (low[axis] >> 3) << 3;
    const openvdb::Coord size = volume.max - volume.min + openvdb::Coord(1);
    const std::size_t count = std::size_t(size.x()) * std::size_t(size.y()) * std::size_t(size.z());
    volume.values.resize(count);
    volume.active.resize(count);
    const bool isExact = exact.isOne();
    PackedDeltas packed({low[order[0]], low[order[1]], low[order[2]]},
                        {high[order[0]], high[order[1]], high[order[2]]});
    if (isPacked && !wide->empty()) {
        const std::size_t codes =
            isExact ? 0 : std::size_t(entry<std::int32_t>(*deltas, "delta_code_count", 1));
        const std::size_t largest = inactive.empty() ? codes : 65536 + inactive.size();
        int width = isExact ? (exact.is32() ? 32 : 64) : 0;
        while (!isExact && 2 * largest >> width != 0) ++width;
        Bits bits(*wide);
        packed.take(bits, interval, width);
    }
    PackedDeltas::Said found;
    const auto note = [&](const openvdb::Coord& suv, int code) {
        ++found.counts[code];
        found.first.minComponent(suv);
        found.last.maxComponent(suv);
        const int slab = (suv.x() - firstSlab) / interval;
        const openvdb::Coord column((firstSlab + slab * interval) >> 3, suv.y() >> 3, suv.z() >> 3);
        auto& range = found.ranges.try_emplace(column, code, code).first->second;
        range = {std::min(range.first, code), std::max(range.second, code)};
    };
    int rest = 0;
    while (restActive && packed.said.isThere && book.value(rest) != volume.background) ++rest;
    for (int u = low[order[1]]; u <= high[order[1]]; ++u) {
        for (int v = low[order[2]]; v <= high[order[2]]; ++v) {
            std::uint64_t slot = 0;  // of exact books modulo 2^32 or 2^64
            for (int s = low[axis]; s <= high[axis]; ++s) {
                // A key slice is a change from nothing.
                if ((s - firstSlab) % interval == 0) slot = 0;
                const openvdb::Coord place(s, u, v);
                std::int32_t delta = 0;
                std::int64_t wideDelta = 0;
                if (isPacked) {
                    const std::uint64_t z = packed.at(place);
                    slot += z % 2 == 0 ? z / 2 : ~(z / 2);
                } else if (narrow && narrow->tree().probeValue(place, delta)) {
                    // Section "Reading it".
                    const auto z = std::int64_t(std::uint32_t(delta));
                    slot += std::uint64_t(z % 2 == 0 ? z / 2 : -(z + 1) / 2);
                } else if (wide && wide->tree().probeValue(place, wideDelta)) {
                    const auto z = std::uint64_t(wideDelta);
                    slot += z % 2 == 0 ? z / 2 : ~(z / 2);
                }
                if (isExact && exact.is32()) slot %= std::uint64_t{1} << 32;
                openvdb::Coord xyz;
                xyz[order[0]] = s;
                xyz[order[1]] = u;
                xyz[order[2]] = v;
                const std::size_t at = volume.at(xyz);
                const std::uint64_t first = isExact ? exact.firstInactive() : 65537;
                const auto value = [&] {
                    if (slot == 0) return volume.background;
                    if (slot >= first) return inactive.at(std::size_t(slot - first));
                    return isExact ? exact.value(slot - 1) : book.value(int(slot - 1));
                };
                volume.values[at] = value();
                volume.active[at] = slot == 0 ? restActive : slot < first;
                if (packed.said.isThere && volume.active[at])
                    note(place, slot == 0 ? rest : int(slot - 1));
            }
        }
    }
    if (!packed.said.isThere) return volume;
    if (found.first != packed.said.first || found.last != packed.said.last)
        throw std::runtime_error("another box");
    if (found.counts != packed.said.counts) throw std::runtime_error("other numbers of codes");
    for (const auto& [column, range] : packed.said.ranges)
        if (found.ranges.at(column) != range) throw std::runtime_error("other codes in a column");
    return volume;
}

}  // namespace deltasplat::testing
