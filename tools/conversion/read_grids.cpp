// SPDX-License-Identifier: Apache-2.0
#include "conversion/read_grids.h"

#include <string>
#include <vector>

#include "base/text.h"

namespace deltasplat {

std::string forEachScalarGrid(const std::filesystem::path& input, const ReadOptions& options,
                              const std::function<void(Volume)>& use, const Listener& listener) {
    std::vector<std::string> left;
    VolumeVisitor visitor;
    visitor.volume = use;
    visitor.other = [&](const std::string& name, const std::string& type) {
        left.push_back(name + " (" + type + ")");
    };
    forEachVolume(input, options, visitor, listener);
    const std::string others = nameList(left);
    if (!others.empty()) listener.warn(input.string() + ": left out " + others);
    return others;
}

}  // namespace deltasplat
