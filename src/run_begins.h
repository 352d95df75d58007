// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace deltasplat {

/// Cuts a list into runs of neighbours that belong together, as blocks of one column do: returns
/// where each run begins, and at the end the number of all.
/// @param together  together(a, b): whether b, which follows a, is of its run
template <typename T, typename Together>
std::vector<std::size_t> runBegins(const std::vector<T>& items, const Together& together) {
    std::vector<std::size_t> begins;
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (i == 0 || !together(items[i - 1], items[i])) begins.push_back(i);
    }
    begins.push_back(items.size());
    return begins;
}

}  // namespace deltasplat
