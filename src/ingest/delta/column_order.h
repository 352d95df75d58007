// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <tuple>
#include <vector>

#include "ingest/delta/delta_columns.h"
#include "parallel_sort.h"
#include "run_begins.h"

namespace deltasplat {

/// Sorts items by u, v and slice, and returns the columns that they make.
/// @param blockOf  where an item is, (slice, u, v) divided by 8
template <typename T, typename BlockOf>
std::vector<DeltaColumn> orderByColumns(std::vector<T>& items, const BlockOf& blockOf) {
    parallelSort(items, [&](const T& a, const T& b) {
        const glm::ivec3 p = blockOf(a), q = blockOf(b);
        return std::tie(p.y, p.z, p.x) < std::tie(q.y, q.z, q.x);
    });
    const std::vector<std::size_t> begins = runBegins(items, [&](const T& a, const T& b) {
        const glm::ivec3 p = blockOf(a), q = blockOf(b);
        return p.y == q.y && p.z == q.z;
    });
    std::vector<DeltaColumn> columns;
    for (std::size_t i = 0; i + 1 < begins.size(); ++i) {
        const glm::ivec3 first = blockOf(items[begins[i]]);
        columns.push_back({{first.y, first.z}, begins[i], begins[i + 1]});
    }
    return columns;
}

}  // namespace deltasplat
