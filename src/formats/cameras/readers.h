// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "deltasplat/cameras/read_camera.h"

namespace deltasplat {

/// As readCamera, of one format each.
CameraMotion readJsonCamera(const std::filesystem::path& file);
CameraMotion readUsdCamera(const std::filesystem::path& file, const std::string& name,
                           const Listener& listener);
CameraMotion readExrCamera(const std::filesystem::path& file, const Listener& listener);

}  // namespace deltasplat
