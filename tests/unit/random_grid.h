// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "volume/tree_types.h"

#include <random>
#include <type_traits>

namespace deltasplat::testing {

/// What inactive voxels of a leaf hold.
enum class Inactive { kBackground, kMinus, kOne, kBoth, kOneBesideBackground, kTwo, kMany };
constexpr Inactive kAllInactive[] = {
    Inactive::kBackground,          Inactive::kMinus, Inactive::kOne, Inactive::kBoth,
    Inactive::kOneBesideBackground, Inactive::kTwo,   Inactive::kMany};

template <typename T>
T valueOf(int number) {
    if constexpr (std::is_same_v<T, bool>) {
        return number % 2 != 0;
    } else if constexpr (openvdb::VecTraits<T>::IsVec) {
        return T(typename T::ValueType(number), typename T::ValueType(number + 1),
                 typename T::ValueType(-2 * number));
    } else {
        return T(number);
    }
}

template <typename T>
T inactiveValue(Inactive kind, int number, T background) {
    const T minus = openvdb::math::negative(background);
    switch (kind) {
        case Inactive::kMinus:
            return minus;
        case Inactive::kOne:
            return valueOf<T>(77);
        case Inactive::kBoth:
            return number % 3 == 0 ? background : minus;
        case Inactive::kOneBesideBackground:
            return number % 3 == 0 ? valueOf<T>(77) : background;
        case Inactive::kTwo:
            return valueOf<T>(number % 3 == 0 ? 77 : 78);
        case Inactive::kMany:
            return valueOf<T>(number % 100);
        default:
            return background;
    }
}

/// Returns a grid with leaves, and tiles of all levels, in several nodes of the root.
/// @param leaves  how many, of which every fifth is full
template <typename Grid>
typename Grid::Ptr randomGrid(int leaves, Inactive inactive, int background, unsigned seed) {
    openvdb::initialize();
    using Tree = typename Grid::TreeType;
    using T = typename Grid::ValueType;
    constexpr bool kIsMask = std::is_same_v<typename Tree::BuildType, openvdb::ValueMask>;
    std::mt19937 random(seed);
    const T empty = valueOf<T>(background);
    auto grid = Grid::create(empty);
    Tree& tree = grid->tree();
    for (int i = 0; i < leaves; ++i) {
        const int edge = 600;
        const openvdb::Coord origin(int(random() % edge) - 300, int(random() % edge),
                                    int(random() % 5000));
        auto* leaf = tree.touchLeaf(origin);
        for (openvdb::Index n = 0; n < leaf->SIZE; ++n) {
            const bool isOn = i % 5 == 0 || random() % 3 != 0;
            leaf->setActiveState(n, isOn);
            if constexpr (!kIsMask) {
                leaf->setValueOnly(n, isOn
                                          ? valueOf<T>(int(random() % 50))
                                          : inactiveValue<T>(inactive, int(random() % 999), empty));
            }
        }
    }
    if (leaves > 2) {
        const T tile = valueOf<T>(7);
        tree.addTile(1, openvdb::Coord(1000, 0, 0), tile, true);
        tree.addTile(1, openvdb::Coord(1008, 0, 0), inactiveValue<T>(inactive, 3, empty), false);
        tree.addTile(1, openvdb::Coord(1016, 0, 0), inactiveValue<T>(inactive, 1, empty), false);
        tree.addTile(2, openvdb::Coord(2048, 0, 0), tile, true);
        tree.addTile(2, openvdb::Coord(2048, 128, 0), inactiveValue<T>(inactive, 4, empty), false);
        tree.addTile(3, openvdb::Coord(-8192, 4096, 0), tile, true);
        tree.addTile(3, openvdb::Coord(-4096, 4096, 0), tile, false);
    }
    grid->setName("grid");
    return grid;
}

}  // namespace deltasplat::testing
