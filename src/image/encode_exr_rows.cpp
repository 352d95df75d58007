// SPDX-License-Identifier: Apache-2.0
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string>

#include "cannot_write.h"
#include "deltasplat/atomic_file.h"
#include "deltasplat/error.h"
#include "deltasplat/threads.h"
#include "exr_threads.h"
#include "image/encode_image.h"
#include "image/quantize.h"
#include "modules/image_module.h"
#include "printable.h"

namespace deltasplat {
namespace {

// Lets OpenImageIO write to a descriptor, here and there.
class DescriptorProxy : public OIIO::Filesystem::IOProxy {
  public:
    explicit DescriptorProxy(int file) : IOProxy("", Write), file_(file) {}

    const char* proxytype() const override { return "descriptor"; }
    std::size_t size() const override { return std::size_t(size_); }
    std::size_t write(const void* bytes, std::size_t size) override {
        const std::size_t written = pwrite(bytes, size, m_pos);
        m_pos += std::int64_t(written);
        return written;
    }
    std::size_t pwrite(const void* bytes, std::size_t size, std::int64_t at) override {
        const char* next = static_cast<const char*>(bytes);
        std::size_t left = size;
        while (left > 0) {
            const ssize_t count = ::pwrite(file_, next, left, off_t(at));
            if (count < 0 && errno == EINTR) continue;
            if (count <= 0) {
                problem_ = count < 0 ? errno : ENOSPC;
                break;
            }
            next += count;
            at += count;
            left -= std::size_t(count);
        }
        size_ = std::max(size_, at);
        return size - left;
    }
    // What went wrong last, or 0.
    int problem() const { return problem_; }

  private:
    int file_;
    std::int64_t size_ = 0;
    int problem_ = 0;
};

class RowsFile : public ExrRowsFile {
  public:
    RowsFile(const std::filesystem::path& path, glm::ivec2 sizePixels, const PixelBox& box,
             const ImageFileOptions& options)
        : file_(path), asFloat_(options.floatExr), proxy_(file_.descriptor()) {
        if (file_.isDevice()) {
            throw Error(ErrorCode::kOutput,
                        gotExpected(path.string(), "a device", "a file, for a picture in parts"));
        }
        limitExrThreads();
        output_ = OIIO::ImageOutput::create("openexr");
        if (!output_ || !output_->set_ioproxy(&proxy_)) fail();
        output_->threads(threadCount());
        OIIO::ImageSpec spec = exrSpec(box.size(), options);
        setWindows(options.exr, sizePixels, box.min, spec);
        if (!output_->open(path.string(), spec)) fail();
        nextRow_ = output_->spec().y;
    }

    void write(const Image& rows) override {
        const std::vector<float> values = finiteValues(rows, asFloat_);
        if (!output_->write_scanlines(nextRow_, nextRow_ + rows.size.y, 0, OIIO::TypeFloat,
                                      values.data()))
            fail();
        nextRow_ += rows.size.y;
    }

    void finish() override {
        if (!output_->close() || proxy_.problem() != 0) fail();
        file_.commit();
    }

  private:
    [[noreturn]] void fail() const {
        if (proxy_.problem() != 0) throwCannotWrite(file_.finalPath(), proxy_.problem());
        const std::string why = output_ ? output_->geterror() : OIIO::geterror();
        throw Error(ErrorCode::kOutput,
                    file_.finalPath().string() + ": cannot be encoded: " + printable(why));
    }

    AtomicFile file_;
    bool asFloat_;
    DescriptorProxy proxy_;
    std::unique_ptr<OIIO::ImageOutput> output_;
    int nextRow_ = 0;
};

}  // namespace

std::unique_ptr<ExrRowsFile> image_module::openExrRows(const std::filesystem::path& file,
                                                       glm::ivec2 sizePixels, const PixelBox& box,
                                                       const ImageFileOptions& options) {
    return std::make_unique<RowsFile>(file, sizePixels, box, options);
}

}  // namespace deltasplat
