// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "deltasplat/ingest/code_book.h"
#include "volume/code_math.h"
#include "volume/tree_grid.h"

namespace deltasplat {

/// Returns a delta (int32 or int64) as a number without sign: 0, -1, 1, -2, ... become 0, 1, 2, 3,
/// ... Blosc groups bytes of equal weight, and small negative numbers would spoil its upper zeros.
template <typename Delta>
Delta toZigzag(Delta delta) {
    using Bits = std::make_unsigned_t<Delta>;
    return Delta((Bits(delta) << 1) ^ Bits(delta >> (8 * sizeof(Delta) - 1)));
}

/// Inverts toZigzag; any number is valid.
template <typename Delta>
Delta fromZigzag(Delta number) {
    using Bits = std::make_unsigned_t<Delta>;
    const auto bits = Bits(number);
    return Delta((bits >> 1) ^ (Bits{0} - (bits & 1u)));
}

/// Value types that delta grids store by their bits: for more than 65536 different values.
enum class ExactValues { kFloat32, kFloat64, kInt32, kInt64 };

/// Names of these code books, in the order of ExactValues.
inline constexpr const char* kExactNames[] = {"float32", "float64", "int32", "int64"};

/// Trees of these values, in the order of ExactValues.
using ExactTrees =
    TreeTypes<openvdb::FloatTree, openvdb::DoubleTree, openvdb::Int32Tree, openvdb::Int64Tree>;

/// Whether a number has a slot in the type.
bool hasSlot(ExactValues type, double value);

/// Slots for values of type T (float, double, std::int32_t or std::int64_t), in the order of
/// values, so that similar values differ by little. Arithmetic is modulo 2^32 (float) or 2^64.
template <typename T>
struct ExactSlots {
    static constexpr bool kIsFloat = std::is_same_v<T, float>;
    using Slot = std::conditional_t<kIsFloat, std::uint32_t, std::uint64_t>;
    using Delta = std::make_signed_t<Slot>;
    using DeltaTree = std::conditional_t<kIsFloat, openvdb::Int32Tree, openvdb::Int64Tree>;

    /// Returns the slot of an active voxel. `value` is finite, and an int64 at most largest().
    static Slot slotOf(T value) {
        if constexpr (std::is_floating_point_v<T>) {
            return orderOfBits(std::bit_cast<Slot>(value)) + 1;
        } else {
            return Slot(std::int64_t{value}) - Slot(std::int64_t{std::numeric_limits<T>::min()}) +
                   1;
        }
    }
    static T valueOf(Slot slot) {
        if constexpr (std::is_floating_point_v<T>) {
            return std::bit_cast<T>(bitsOfOrder(Slot(slot - 1)));
        } else {
            return T(std::int64_t(slot - 1 + Slot(std::int64_t{std::numeric_limits<T>::min()})));
        }
    }
    static bool isValue(Slot slot) { return slot >= lowest() && slot <= highest(); }
    static Slot lowest() { return slotOf(std::numeric_limits<T>::lowest()); }
    static Slot highest() { return slotOf(largest()); }
    /// Returns the largest value with a slot: 2^63 - 65538 for int64.
    static T largest() {
        if constexpr (std::is_same_v<T, std::int64_t>)
            return std::numeric_limits<T>::max() - kCodeCount - 1;
        return std::numeric_limits<T>::max();
    }
    /// Returns the slot of the first of the inactive values.
    static Slot firstInactive() { return highest() + 1; }
};

}  // namespace deltasplat
