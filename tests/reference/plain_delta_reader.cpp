// SPDX-License-Identifier: Apache-2.0
#include "reference/plain_delta_reader.h"

#include <cstdint>
#include <cstring>
#include <sstream>
#include <stdexcept>

namespace deltasplat::testing {
namespace {

template <typename T>
T entry(const openvdb::GridBase& grid, const std::string& name) {
    const auto found = grid.getMetadata<openvdb::TypedMetadata<T>>(name);
    if (!found) throw std::runtime_error("no metadata " + name);
    return found->value();
}

std::vector<double> numbers(const std::string& text) {
    std::vector<double> list;
    std::istringstream words(text);
    for (std::string word; words >> word;) list.push_back(std::strtod(word.c_str(), nullptr));
    return list;
}

// Section "Exact books": slots of values, 32 or 64 bits, and the first of inactive ones.
struct ExactBook {
    explicit ExactBook(const std::string& kind) : kind_(kind) {}
    bool is32() const { return kind_ == "float32"; }
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
        : kind_(entry<std::string>(grid, "delta_code_book")) {
        if (kind_ == "integer" || kind_ == "linear") offset_ = entry<double>(grid, "delta_offset");
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
    if (version < 1 || version > 4) throw std::runtime_error("version");

    // Axis of the source that slices, u and v run along.
    const int axis = entry<std::string>(*deltas, "delta_slice_axis")[0] - 'x';
    const int order[3] = {axis, (axis + 1) % 3, (axis + 2) % 3};
    PlainVolume volume;
    const auto low = entry<openvdb::Vec3i>(*deltas, "delta_box_min");
    const auto high = entry<openvdb::Vec3i>(*deltas, "delta_box_max");
    volume.min = openvdb::Coord(low[0], low[1], low[2]);
    volume.max = openvdb::Coord(high[0], high[1], high[2]);
    volume.background = entry<double>(*deltas, "delta_background");
    volume.sourceType = entry<std::string>(*deltas, "delta_source_type");
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
    const ExactBook exact(entry<std::string>(*deltas, "delta_code_book"));
    const bool restActive = entry<std::string>(*deltas, "delta_rest") == "active";
    const std::vector<double> inactive =
        numbers(entry<std::string>(*deltas, "delta_inactive_values"));
    const int interval = entry<std::int32_t>(*deltas, "delta_key_interval");
    const int firstSlab = (low[axis] >> 3) << 3;
    const openvdb::Coord size = volume.max - volume.min + openvdb::Coord(1);
    const std::size_t count = std::size_t(size.x()) * std::size_t(size.y()) * std::size_t(size.z());
    volume.values.resize(count);
    volume.active.resize(count);
    for (int u = low[order[1]]; u <= high[order[1]]; ++u) {
        for (int v = low[order[2]]; v <= high[order[2]]; ++v) {
            std::uint64_t slot = 0;  // of version 4 modulo 2^32 or 2^64
            for (int s = low[axis]; s <= high[axis]; ++s) {
                // A key slice is a change from nothing.
                if ((s - firstSlab) % interval == 0) slot = 0;
                const openvdb::Coord place(s, u, v);
                std::int32_t delta = 0;
                std::int64_t wideDelta = 0;
                if (narrow && narrow->tree().probeValue(place, delta)) {
                    // Section "Reading it".
                    const auto z = std::int64_t(std::uint32_t(delta));
                    if (version < 3) {
                        slot += std::uint64_t(std::int64_t{delta});
                    } else {
                        slot += std::uint64_t(z % 2 == 0 ? z / 2 : -(z + 1) / 2);
                    }
                } else if (wide && wide->tree().probeValue(place, wideDelta)) {
                    const auto z = std::uint64_t(wideDelta);
                    slot += z % 2 == 0 ? z / 2 : ~(z / 2);
                }
                if (version == 4 && exact.is32()) slot %= std::uint64_t{1} << 32;
                openvdb::Coord xyz;
                xyz[order[0]] = s;
                xyz[order[1]] = u;
                xyz[order[2]] = v;
                const std::size_t at = volume.at(xyz);
                const std::uint64_t first = version == 4 ? exact.firstInactive() : 65537;
                const auto value = [&] {
                    if (slot == 0) return volume.background;
                    if (slot >= first) return inactive.at(std::size_t(slot - first));
                    return version == 4 ? exact.value(slot - 1) : book.value(int(slot - 1));
                };
                volume.values[at] = value();
                volume.active[at] = slot == 0 ? restActive : slot < first;
            }
        }
    }
    return volume;
}

}  // namespace deltasplat::testing
