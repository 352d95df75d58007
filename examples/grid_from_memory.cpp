// SPDX-License-Identifier: Apache-2.0
// Values in memory become a volume, and its first picture: grid_from_memory ball.png
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>
#include <vector>

#include "deltasplat/error.h"
#include "deltasplat/image/write_image.h"
#include "deltasplat/ingest/make_volume.h"
#include "deltasplat/render.h"

using namespace deltasplat;

int main(int argc, char** argv) {
    if (argc != 2) return std::fprintf(stderr, "Usage: grid_from_memory PICTURE\n"), 2;
    try {
        // A ball that thins out, x the fastest index.
        const int side = 96;
        std::vector<float> values;
        for (int z = 0; z < side; ++z) {
            for (int y = 0; y < side; ++y) {
                for (int x = 0; x < side; ++x) {
                    const double away = std::hypot(x - 47.5, y - 47.5, z - 47.5);
                    values.push_back(float(std::max(0.0, 1 - away / 48)));
                }
            }
        }
        MemoryLayout layout;
        layout.dims = {side, side, side};
        layout.worldFromIndex[2][2] = 1.5;  // slices lie farther apart than voxels in them
        layout.background = 0;              // empty, as an inactive voxel of a .vdb
        const Volume volume = makeVolume(std::span<const float>(values), layout);
        std::printf("%llu voxels\n", (unsigned long long)volume.activeCount());

        const RenderResult result = render(volume);
        writeImage(argv[1], result.image, {});
    } catch (const Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
