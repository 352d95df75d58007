// SPDX-License-Identifier: Apache-2.0
// Turns a volume a quarter about its up axis and writes it as a .vdb: turn_vdb cloud.vdb turned.vdb
#include <cstdio>
#include <glm/gtc/matrix_transform.hpp>
#include <utility>
#include <vector>

#include "deltasplat/convert/write_volume.h"
#include "deltasplat/error.h"
#include "deltasplat/ingest/read_volume.h"

using namespace deltasplat;

int main(int argc, char** argv) {
    if (argc != 3) return std::fprintf(stderr, "Usage: turn_vdb INPUT OUTPUT.vdb\n"), 2;
    try {
        // The file's own values, besides the codes that pictures are made of.
        ReadOptions read;
        read.keepSource = true;
        Volume volume = readVolume(argv[1], read);

        // No voxel changes: only the way from indices to the world does.
        const double quarter = glm::radians(90.0);
        const glm::dmat4 turn = glm::rotate(glm::dmat4(1), quarter, glm::dvec3(0, 1, 0));
        volume =
            volume.withPlace(turn * volume.worldFromIndex(), volume.space(), volume.lengthUnit());

        std::vector<Volume> volumes;
        volumes.push_back(std::move(volume));
        const WriteReport report = writeVolumes(argv[2], std::move(volumes));
        for (const std::string& note : report.notes) std::printf("%s\n", note.c_str());
        std::printf("largest error: %g\n", report.maxError);
    } catch (const Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
