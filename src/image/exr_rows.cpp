// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/image/exr_rows.h"

#include <string>

#include "base/default_floats.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "image/encode_exr.h"

namespace deltasplat {

struct ExrRows::Impl {
    PixelBox box;
    std::unique_ptr<ExrRowsFile> file;
    int done = 0;  // rows
};

ExrRows::ExrRows(const std::filesystem::path& file, glm::ivec2 sizePixels, const PixelBox& box,
                 const ImageFileOptions& options) {
    const DefaultFloats floats;
    const auto refuse = [&](const std::string& got, const std::string& expected) {
        throw Error(ErrorCode::kUsage, file.string(), got, expected);
    };
    if (imageFormatOf(file) != ImageFormat::kExr) refuse("a picture in parts", "an .exr file");
    if (!options.channels.empty()) refuse("other channels besides", "a picture alone");
    ImageFileOptions stored = options;
    stored.region = box;
    checkImageFile(file, sizePixels, stored);
    impl_ = std::make_unique<Impl>();
    impl_->box = box;
    impl_->file = openExrRows(file, sizePixels, box, stored);
}
ExrRows::~ExrRows() = default;

void ExrRows::write(const Image& rows) {
    const DefaultFloats floats;
    const glm::ivec2 left(impl_->box.size().x, impl_->box.size().y - impl_->done);
    if (rows.size.x != left.x || rows.size.y > left.y || rows.size.y < 1) {
        throw Error(ErrorCode::kUsage, "rows of a picture", dimsText(rows.size),
                    "some of " + dimsText(left));
    }
    impl_->file->write(rows);
    impl_->done += rows.size.y;
}

void ExrRows::finish() {
    if (impl_->done != impl_->box.size().y) {
        throw Error(ErrorCode::kUsage, "rows of a picture", std::to_string(impl_->done),
                    std::to_string(impl_->box.size().y));
    }
    impl_->file->finish();
}

}  // namespace deltasplat
