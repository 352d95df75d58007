// SPDX-License-Identifier: Apache-2.0
#include "conversion/read_grids.h"

#include <string>

namespace deltasplat {

std::string forEachScalarGrid(const std::filesystem::path& input, const ReadOptions& options,
                              const std::function<void(Volume)>& use, const Listener& listener) {
    std::string others;
    VolumeVisitor visitor;
    visitor.volume = use;
    visitor.other = [&](const std::string& name, const std::string& type) {
        others += (others.empty() ? "" : ", ") + name + " (" + type + ")";
    };
    forEachVolume(input, options, visitor, listener);
    if (!others.empty()) listener.warn(input.string() + ": left out " + others);
    return others;
}

}  // namespace deltasplat
