// SPDX-License-Identifier: Apache-2.0
#include "name_list.h"

#include <algorithm>

#include "count_text.h"

namespace deltasplat {

namespace {

std::string shortened(const std::string& name) {
    constexpr std::size_t kMost = 120;
    if (name.size() <= kMost) return name;
    std::size_t end = kMost;
    while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xc0) == 0x80) --end;  // in UTF-8
    return name.substr(0, end) + "...";
}

}  // namespace

std::string nameList(const std::vector<std::string>& names) {
    constexpr std::size_t kMost = 32;
    // One more is named rather than counted.
    const std::size_t named = names.size() <= kMost + 1 ? names.size() : kMost;
    std::string list;
    for (std::size_t i = 0; i < named; ++i) list += (i == 0 ? "" : ", ") + shortened(names[i]);
    if (named < names.size()) list += " and " + countText(names.size() - named, "other");
    return list;
}

}  // namespace deltasplat
