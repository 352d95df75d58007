// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/cameras/read_camera.h"

#include "base/default_floats.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "formats/cameras/readers.h"

namespace deltasplat {

bool isCameraName(const std::filesystem::path& file) {
    const std::string ending = lowerCase(file.extension().string());
    return ending == ".json" || ending == ".usda" || ending == ".exr";
}

CameraMotion readCamera(const std::filesystem::path& file, const std::string& name,
                        const Listener& listener) {
    const DefaultFloats floats;
    const std::string ending = lowerCase(file.extension().string());
    if (ending == ".usda") return readUsdCamera(file, name, listener);
    if (!name.empty()) {
        throw Error(ErrorCode::kInput, file.string() + ":" + name, "no .usda",
                    "a name behind a .usda's only");
    }
    if (ending == ".json") return readJsonCamera(file);
    if (ending == ".exr") return readExrCamera(file, listener);
    const bool isOtherUsd = ending == ".usd" || ending == ".usdc" || ending == ".usdz";
    throw Error(ErrorCode::kInput, file.string(),
                isOtherUsd ? "USD that is no text" : "an unknown ending",
                isOtherUsd ? ".usda, as usdcat -o x.usda writes it" : ".json, .usda or .exr");
}

}  // namespace deltasplat
