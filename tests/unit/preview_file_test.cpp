// SPDX-License-Identifier: Apache-2.0
#include "render/preview_file.h"

#include <gtest/gtest.h>

#include <string>

#include "deltasplat/atomic_file.h"
#include "deltasplat/error.h"
#include "deltasplat/image/write_image.h"
#include "unit/temp_folder.h"

namespace deltasplat {
namespace {

namespace fs = std::filesystem;

class PreviewFiles : public testing::Test {
  protected:
    void writePreview(const fs::path& file) {
        ImageFileOptions options;
        options.metadata = {{"version", "1"}, {kPreviewMark, "a.png"}};
        writeImage(file, Image(glm::ivec2(3, 2)), options);
    }
    void writeOther(const fs::path& file) { writeFileAtomically(file, "precious"); }

    test::TempFolder folder_;
    const fs::path file_ = folder_ / "a.preview.png";
};

TEST_F(PreviewFiles, LieBesideThePicture) {
    EXPECT_EQ(previewFile("t/a.b.png"), "t/a.b.preview.png");
}

TEST_F(PreviewFiles, GoWithTheirObject) {
    {
        PreviewFile preview(file_);
        writePreview(file_);
        preview.noteWritten();
        EXPECT_TRUE(fs::exists(file_));
    }
    EXPECT_FALSE(fs::exists(file_));
}

// The same if what writes them fails when they are whole.
TEST_F(PreviewFiles, GoWithoutBeingNoted) {
    for (const bool isLeftOver : {false, true}) {
        if (isLeftOver) writePreview(file_);
        {
            const PreviewFile preview(file_);
            writePreview(file_);
        }
        EXPECT_FALSE(fs::exists(file_)) << isLeftOver;
    }
}

TEST_F(PreviewFiles, LeaveWhatOthersPutThere) {
    {
        PreviewFile preview(file_);
        writePreview(file_);
        preview.noteWritten();
        writeOther(file_);
    }
    EXPECT_EQ(test::readBytes(file_), "precious");
    { const PreviewFile preview(file_); }
    EXPECT_EQ(test::readBytes(file_), "precious");
    {
        const PreviewFile preview(file_);
        writeOther(file_);
    }
    EXPECT_EQ(test::readBytes(file_), "precious");
}

TEST_F(PreviewFiles, MayTakeTheNameOfAnother) {
    for (const char* name : {"a.preview.png", "a.preview.exr", "a.preview.jpg", "a.preview.tif"}) {
        EXPECT_NO_THROW(requireFreePreview(folder_ / name));
        writePreview(folder_ / name);
        EXPECT_NO_THROW(requireFreePreview(folder_ / name)) << name;
    }
}

TEST_F(PreviewFiles, MayNotTakeOtherNames) {
    const auto expectRefused = [&](const std::string& name) {
        try {
            requireFreePreview(folder_ / name);
            ADD_FAILURE() << name;
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::kOutput);
            EXPECT_EQ(error.what(),
                      "--progressive: got " + (folder_ / name).string() +
                          ", a file that is no preview; expected no file of this name, or what a "
                          "preview has left");
        }
    };
    writeOther(file_);
    expectRefused("a.preview.png");
    writeImage(folder_ / "b.preview.png", Image(glm::ivec2(3, 2)), {});
    expectRefused("b.preview.png");
    writePreview(folder_ / "real.png");
    fs::create_symlink("real.png", folder_ / "c.preview.png");
    expectRefused("c.preview.png");
    fs::create_directory(folder_ / "d.preview.png");
    expectRefused("d.preview.png");
}

// However far behind in the file it says so.
TEST_F(PreviewFiles, AreKnownByAllOfTheFile) {
    for (const std::size_t before : {0, 1 << 20, (1 << 20) - 5, (3 << 20) - 19}) {
        writeFileAtomically(file_, std::string(before, 'x') + "deltasplat:" + kPreviewMark);
        EXPECT_NO_THROW(requireFreePreview(file_)) << before;
    }
}

}  // namespace
}  // namespace deltasplat
