// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <glm/geometric.hpp>
#include <string>

#include "deltasplat/cameras/read_camera.h"
#include "deltasplat/error.h"
#include "unit/temp_folder.h"

namespace deltasplat::test {

/// Returns the camera on a volume of no account.
inline Camera cameraFor(const FilmCamera& film, glm::ivec2 size) {
    return makeCamera(cameraOptions(film, size), {glm::ivec3(0), glm::ivec3(1)}, glm::dmat4(1));
}

inline void expectPixel(const Camera& camera, const glm::dvec3& world, const glm::dvec2& pixel,
                        double within = 1e-9) {
    const glm::dvec2 found = camera.pixelFromWorld(world);
    EXPECT_LE(glm::distance(found, pixel), within)
        << found.x << ',' << found.y << " instead of " << pixel.x << ',' << pixel.y;
}

/// Returns what was said of a camera in a file of this name and text; "" of one that was read.
inline std::string complaint(const std::string& name, const std::string& text,
                             const std::string& prim = "") {
    const TempFolder folder;
    std::ofstream(folder / name, std::ios::binary) << text;
    try {
        readCamera(folder / name, prim);
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::kInput);
        const std::string said = error.what();
        EXPECT_EQ(said.find('\n'), std::string::npos) << said;
        const std::string path = (folder / name).string();
        return said.starts_with(path) ? said.substr(path.size()) : said;
    }
    return "";
}

inline CameraMotion motionOf(const std::string& name, const std::string& text,
                             const std::string& prim = "", const Listener& listener = {}) {
    const TempFolder folder;
    std::ofstream(folder / name, std::ios::binary) << text;
    return readCamera(folder / name, prim, listener);
}

}  // namespace deltasplat::test
