// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "output_file.h"
#include "unit/file_limits.h"
#include "unit/temp_folder.h"

namespace deltasplat {
namespace {

namespace fs = std::filesystem;
using test::errorOf;
using test::readBytes;

TEST(AtomicFile, AppearsOnlyWhenCommitted) {
    const test::TempFolder folder;
    AtomicFile file(folder / "out.exr");
    std::ofstream(file.path()) << "whole";
    EXPECT_FALSE(fs::exists(folder / "out.exr"));
    EXPECT_EQ(file.path().extension(), ".exr");
    EXPECT_EQ(file.path().parent_path(), folder.path());
    file.commit();
    EXPECT_EQ(readBytes(folder / "out.exr"), "whole");
    EXPECT_EQ(folder.count(), 1);
}

TEST(AtomicFile, LeavesNothingWithoutCommit) {
    const test::TempFolder folder;
    {
        const AtomicFile file(folder / "out.exr");
        std::ofstream(file.path()) << "half";
        EXPECT_EQ(folder.count(), 1);
    }
    EXPECT_EQ(folder.count(), 0);
}

TEST(AtomicFile, KeepsTheOldFileUntilTheNewOneIsWhole) {
    const test::TempFolder folder;
    writeFileAtomically(folder / "out.raw", "old");
    { const AtomicFile abandoned(folder / "out.raw"); }
    EXPECT_EQ(readBytes(folder / "out.raw"), "old");
    writeFileAtomically(folder / "out.raw", "new");
    EXPECT_EQ(readBytes(folder / "out.raw"), "new");
}

TEST(AtomicFile, TwoAtOnceDoNotShareAName) {
    const test::TempFolder folder;
    const AtomicFile first(folder / "out.raw");
    const AtomicFile second(folder / "out.raw");
    EXPECT_NE(first.path(), second.path());
}

TEST(AtomicFile, KeepsPermissionsOfTheFileItReplaces) {
    const test::TempFolder folder;
    writeFileAtomically(folder / "out.raw", "old");
    fs::permissions(folder / "out.raw", fs::perms(0640));
    writeFileAtomically(folder / "out.raw", "new");
    EXPECT_EQ(fs::status(folder / "out.raw").permissions(), fs::perms(0640));
}

TEST(AtomicFile, WritesWhatALinkPointsTo) {
    const test::TempFolder folder;
    fs::create_directory(folder / "real");
    fs::create_symlink("real/target.raw", folder / "link.raw");
    for (const char* content : {"first", "second"}) {  // a dangling link, then a live one
        writeFileAtomically(folder / "link.raw", content);
        EXPECT_TRUE(fs::is_symlink(folder / "link.raw"));
        EXPECT_EQ(readBytes(folder / "real/target.raw"), content);
    }
    EXPECT_EQ(folder.count(), 2);
}

TEST(AtomicFile, WritesDevicesDirectly) {
    const test::TempFolder folder;
    fs::create_symlink("/dev/null", folder / "out.png");
    writeFileAtomically(folder / "out.png", "gone");
    EXPECT_EQ(fs::read_symlink(folder / "out.png"), "/dev/null");
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
    EXPECT_EQ(folder.count(), 1);
}

TEST(AtomicFile, NoticesAFullDisk) {
    const test::TempFolder folder;
    const fs::path link = folder / "out.png";
    fs::create_symlink("/dev/full", link);
    EXPECT_EQ(errorOf([&] { writeFileAtomically(link, "bytes"); }),
              "4: " + link.string() + ": cannot be written: No space left on device");
    EXPECT_EQ(fs::read_symlink(link), "/dev/full");
    EXPECT_EQ(folder.count(), 1);
}

TEST(AtomicFile, NoticesAFileSizeLimit) {
    const test::TempFolder folder;
    const std::string bytes(10000, 'x');
    std::string error;
    {
        const test::FileSizeLimit limit(9999);
        error = errorOf([&] { writeFileAtomically(folder / "out.raw", bytes); });
    }
    EXPECT_EQ(error, "4: " + (folder / "out.raw").string() + ": cannot be written: File too large");
    EXPECT_EQ(folder.count(), 0);
}

TEST(AtomicFile, NamesTheFinalFileWhenTheFolderIsMissing) {
    const test::TempFolder folder;
    const fs::path file = folder / "missing/out.exr";
    EXPECT_EQ(errorOf([&] { const AtomicFile probe(file); }),
              "4: " + file.string() + ": cannot be written: No such file or directory");
}

TEST(AtomicFile, RefusesFoldersAndEmptyNames) {
    const test::TempFolder folder;
    EXPECT_EQ(errorOf([&] { const AtomicFile probe(folder.path()); }),
              "4: " + folder.path().string() + ": cannot be written: Is a directory");
    EXPECT_EQ(errorOf([&] { const AtomicFile probe(""); }),
              "4: : cannot be written: No such file or directory");
    writeFileAtomically(folder / "file", "");
    EXPECT_EQ(errorOf([&] { const AtomicFile probe(folder / "file/out.exr"); }),
              "4: " + (folder / "file/out.exr").string() + ": cannot be written: Not a directory");
}

TEST(AtomicFile, RefusesReadOnlyFilesAndFolders) {
    if (::geteuid() == 0) GTEST_SKIP() << "the superuser may write everywhere";
    const test::TempFolder folder;
    writeFileAtomically(folder / "out.raw", "precious");
    ::chmod((folder / "out.raw").c_str(), 0400);
    EXPECT_EQ(errorOf([&] { writeFileAtomically(folder / "out.raw", ""); }),
              "4: " + (folder / "out.raw").string() + ": cannot be written: Permission denied");
    ::chmod(folder.path().c_str(), 0500);
    EXPECT_EQ(errorOf([&] { writeFileAtomically(folder / "new.raw", ""); }),
              "4: " + (folder / "new.raw").string() + ": cannot be written: Permission denied");
    ::chmod(folder.path().c_str(), 0700);
}

TEST(OutputFile, WritesPiecesInOrder) {
    const test::TempFolder folder;
    OutputFile out(folder / "out.raw");
    out.write("ab", 2);
    out.write("", 0);
    out.write("c", 1);
    EXPECT_FALSE(fs::exists(folder / "out.raw"));
    out.commit();
    EXPECT_EQ(readBytes(folder / "out.raw"), "abc");
}

}  // namespace
}  // namespace deltasplat
