// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/image/exr_rows.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string>

#include "cannot_write.h"
#include "default_floats.h"
#include "deltasplat/atomic_file.h"
#include "deltasplat/error.h"
#include "deltasplat/threads.h"
#include "dims_text.h"
#include "exr_threads.h"
#include "image/encode_image.h"
#include "image/quantize.h"
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

}  // namespace

struct ExrRows::Impl {
    Impl(const std::filesystem::path& path, glm::ivec2 sizePixels, const PixelBox& ofPicture,
         const ImageFileOptions& fileOptions)
        : file(path), box(ofPicture), options(fileOptions), proxy(file.descriptor()) {
        if (file.isDevice()) {
            throw Error(ErrorCode::kOutput,
                        gotExpected(path.string(), "a device", "a file, for a picture in parts"));
        }
        limitExrThreads();
        output = OIIO::ImageOutput::create("openexr");
        if (!output || !output->set_ioproxy(&proxy)) fail();
        output->threads(threadCount());
        OIIO::ImageSpec spec = exrSpec(box.size(), options);
        setWindows(options.exr, sizePixels, box.min, spec);
        if (!output->open(path.string(), spec)) fail();
    }

    [[noreturn]] void fail() const {
        if (proxy.problem() != 0) throwCannotWrite(file.finalPath(), proxy.problem());
        const std::string why = output ? output->geterror() : OIIO::geterror();
        throw Error(ErrorCode::kOutput,
                    file.finalPath().string() + ": cannot be encoded: " + printable(why));
    }

    AtomicFile file;
    PixelBox box;
    ImageFileOptions options;
    DescriptorProxy proxy;
    std::unique_ptr<OIIO::ImageOutput> output;
    int done = 0;  // rows
};

ExrRows::ExrRows(const std::filesystem::path& file, glm::ivec2 sizePixels, const PixelBox& box,
                 const ImageFileOptions& options) {
    const DefaultFloats floats;
    const auto refuse = [&](const std::string& got, const std::string& expected) {
        throw Error(ErrorCode::kUsage, gotExpected(file.string(), got, expected));
    };
    if (imageFormatOf(file) != ImageFormat::kExr) refuse("a picture in parts", "an .exr file");
    if (!options.channels.empty()) refuse("other channels besides", "a picture alone");
    ImageFileOptions stored = options;
    stored.region = box;
    checkImageFile(file, sizePixels, stored);
    impl_ = std::make_unique<Impl>(file, sizePixels, box, stored);
}
ExrRows::~ExrRows() = default;

void ExrRows::write(const Image& rows) {
    const DefaultFloats floats;
    const glm::ivec2 left(impl_->box.size().x, impl_->box.size().y - impl_->done);
    if (rows.size.x != left.x || rows.size.y > left.y || rows.size.y < 1) {
        throw Error(ErrorCode::kUsage, gotExpected("rows of a picture", dimsText(rows.size),
                                                   "some of " + dimsText(left)));
    }
    const std::vector<float> values = finiteValues(rows, impl_->options.floatExr);
    const int first = impl_->output->spec().y + impl_->done;
    if (!impl_->output->write_scanlines(first, first + rows.size.y, 0, OIIO::TypeFloat,
                                        values.data()))
        impl_->fail();
    impl_->done += rows.size.y;
}

void ExrRows::finish() {
    if (impl_->done != impl_->box.size().y) {
        throw Error(ErrorCode::kUsage, gotExpected("rows of a picture", std::to_string(impl_->done),
                                                   std::to_string(impl_->box.size().y)));
    }
    if (!impl_->output->close() || impl_->proxy.problem() != 0) impl_->fail();
    impl_->file.commit();
}

}  // namespace deltasplat
