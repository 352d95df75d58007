// SPDX-License-Identifier: Apache-2.0
#include "drawing/plot_file.h"

#include "base/text.h"
#include "deltasplat/atomic_file.h"
#include "deltasplat/error.h"
#include "deltasplat/image/write_image.h"

namespace deltasplat {
namespace {

constexpr double kPngScale = 2;

std::string extensionOf(const std::filesystem::path& file) {
    return lowerCase(file.extension().string());
}

bool isSvg(const std::filesystem::path& file) {
    if (isDrawingFile(file)) return extensionOf(file) == ".svg";
    throw Error(ErrorCode::kUsage, file.string(), "extension \"" + file.extension().string() + "\"",
                ".png or .svg");
}

}  // namespace

bool isDrawingFile(const std::filesystem::path& file) {
    return extensionOf(file) == ".svg" || extensionOf(file) == ".png";
}

void checkDrawingFile(const std::filesystem::path& file) {
    isSvg(file);
    const AtomicFile probe(file);
}

void writeDrawing(const std::filesystem::path& file, const Drawing& drawing) {
    if (isSvg(file)) {
        writeFileAtomically(file, svgText(drawing));
    } else {
        ImageFileOptions flat;
        flat.dither = false;
        writeImage(file, rasterize(drawing, kPngScale), flat);
    }
}

}  // namespace deltasplat
