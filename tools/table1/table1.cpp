// SPDX-License-Identifier: Apache-2.0
// Based on: "Accelerating Footprint Method Based on Comparability of Consecutive Image Slices",
// Table 1.
#include "table1/table1.h"

#include <algorithm>
#include <set>
#include <system_error>

#include "deltasplat/error.h"

namespace deltasplat {
namespace {

namespace fs = std::filesystem;

bool isOfTable1(const fs::path& path) {
    return std::any_of(kTable1.begin(), kTable1.end(), [&](const Table1DataSet& dataSet) {
        return path.filename() == dataSet.file;
    });
}

// Orders by the number of folders, then by their names.
bool isNearer(const fs::path& a, const fs::path& b) {
    const auto depth = [](const fs::path& path) { return std::distance(path.begin(), path.end()); };
    return depth(a) != depth(b) ? depth(a) < depth(b) : a < b;
}

// Says whether a folder is met for the first time: links may lead around in circles.
bool isNew(const fs::path& folder, std::set<fs::path>& visited) {
    std::error_code failure;
    const fs::path real = fs::canonical(folder, failure);
    return !failure && visited.insert(real).second;
}

}  // namespace

std::map<std::string, fs::path> findTable1Files(const fs::path& folder, const Listener& listener) {
    std::error_code failure;
    if (!fs::is_directory(folder, failure)) {
        throw Error(ErrorCode::kInput, folder.string(),
                    fs::exists(folder, failure) ? "a file" : "no such folder",
                    "a folder that holds data sets");
    }
    std::map<std::string, fs::path> files;
    std::set<fs::path> visited;
    isNew(folder, visited);
    const auto options = fs::directory_options::skip_permission_denied |
                         fs::directory_options::follow_directory_symlink;
    // What cannot be looked into is passed over: what it may hold will be missed by its name.
    for (fs::recursive_directory_iterator at(folder, options, failure), end; !failure && at != end;
         at.increment(failure)) {
        listener.report(0);
        std::error_code unknown;
        if (at->is_directory(unknown)) {
            if (!isNew(at->path(), visited)) at.disable_recursion_pending();
        } else if (isOfTable1(at->path()) && at->is_regular_file(unknown)) {
            const auto [place, added] = files.emplace(at->path().filename(), at->path());
            if (!added && isNearer(at->path(), place->second)) place->second = at->path();
        }
    }
    return files;
}

RenderOptions table1Options(const Volume& volume, const TransferFunction& transferFunction) {
    RenderOptions options;
    const glm::ivec3 dims = volume.box().dims();
    options.camera.view = "front";
    options.camera.sizePixels = {dims.x, dims.y};
    options.camera.frameWidthWorld = dims.x * volume.voxelSize().x;
    options.optics.transferFunction = transferFunction;
    options.splat.sigma = kTable1Sigma;
    options.splat.footprintWidth = kTable1Footprint;
    options.splat.resolution = 1;
    return options;
}

}  // namespace deltasplat
