// SPDX-License-Identifier: Apache-2.0
#include <OpenEXR/ImfOutputFile.h>

#include <optional>

#include "cannot_write.h"
#include "deltasplat/atomic_file.h"
#include "image/exr_files.h"
#include "image/exr_header.h"
#include "image/exr_pixels.h"
#include "image/exr_stream.h"

namespace deltasplat {
namespace {

class RowsFile : public ExrRowsFile {
  public:
    RowsFile(const std::filesystem::path& path, glm::ivec2 sizePixels, const PixelBox& box,
             const ImageFileOptions& options)
        : file_(path), asFloat_(options.floatExr), stream_(path, file_.descriptor()) {
        if (file_.isDevice()) {
            throw Error(ErrorCode::kOutput,
                        gotExpected(path.string(), "a device", "a file, for a picture in parts"));
        }
        writeExr(path, [&] {
            Imf::Header header = exrHeader(options, sizePixels, box, "zip");
            addRgba(asFloat_, header);
            next_ = header.dataWindow().min;
            output_.emplace(stream_, header);
        });
    }

    void write(const Image& rows) override {
        const ExrRgba pixels(rows, {{0, 0}, rows.size}, asFloat_);
        writeExr(file_.finalPath(), [&] {
            output_->setFrameBuffer(pixels.at(next_));
            output_->writePixels(rows.size.y);
        });
        check();
        next_.y += rows.size.y;
    }

    void finish() override {
        // Ends the file.
        output_.reset();
        check();
        file_.commit();
    }

  private:
    void check() const {
        if (stream_.problem() != 0) throwCannotWrite(file_.finalPath(), stream_.problem());
    }

    AtomicFile file_;
    bool asFloat_;
    ExrFileStream stream_;
    std::optional<Imf::OutputFile> output_;
    Imath::V2i next_{0, 0};  // of the pixels to come, the first
};

}  // namespace

std::unique_ptr<ExrRowsFile> openExrRows(const std::filesystem::path& file, glm::ivec2 sizePixels,
                                         const PixelBox& box, const ImageFileOptions& options) {
    return std::make_unique<RowsFile>(file, sizePixels, box, options);
}

}  // namespace deltasplat
