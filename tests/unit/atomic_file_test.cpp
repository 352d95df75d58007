// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <string>
#include <thread>
#include <vector>

#include "deltasplat/error.h"
#include "support/error_of.h"
#include "unit/file_limits.h"
#include "unit/temp_folder.h"

namespace deltasplat {
namespace {

namespace fs = std::filesystem;
using test::errorOf;
using test::readBytes;

// What was asked to be on the disk, in this order.
std::string synced;

TEST(AtomicFile, AppearsOnlyWhenCommitted) {
    const test::TempFolder folder;
    AtomicFile file(folder / "out.exr");
    file.write("wh", 2);
    file.write("", 0);
    file.write("ole", 3);
    EXPECT_FALSE(fs::exists(folder / "out.exr"));
    EXPECT_TRUE(fs::exists(folder / ".deltasplat.out.exr.0.tmp"));
    file.commit();
    EXPECT_EQ(readBytes(folder / "out.exr"), "whole");
    EXPECT_EQ(folder.count(), 1);
}

TEST(AtomicFile, LeavesNothingWithoutCommit) {
    const test::TempFolder folder;
    {
        AtomicFile file(folder / "out.exr");
        file.write("half", 4);
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
    AtomicFile first(folder / "out.raw");
    AtomicFile second(folder / "out.raw");
    EXPECT_EQ(folder.count(), 2);
    first.write("first", 5);
    second.write("second", 6);
    second.commit();
    EXPECT_EQ(readBytes(folder / "out.raw"), "second");
    first.commit();
    EXPECT_EQ(readBytes(folder / "out.raw"), "first");
    EXPECT_EQ(folder.count(), 1);
}

TEST(AtomicFile, ManyWritersOfOneFileAllEndWell) {
    const test::TempFolder folder;
    constexpr int kWriters = 4;
    std::vector<std::string> problems(kWriters, "no error");
    std::vector<std::thread> writers;
    for (std::string& problem : problems) {
        writers.emplace_back([&] {
            for (int i = 0; i < 500 && problem == "no error"; ++i)
                problem = errorOf([&] { writeFileAtomically(folder / "out", "whole"); });
        });
    }
    for (std::thread& writer : writers) writer.join();
    for (const std::string& problem : problems) EXPECT_EQ(problem, "no error");
    EXPECT_EQ(readBytes(folder / "out"), "whole");
    EXPECT_EQ(folder.count(), 1);
}

TEST(AtomicFile, KeepsPermissionsOfTheFileItReplaces) {
    const test::TempFolder folder;
    writeFileAtomically(folder / "out.raw", "old");
    fs::permissions(folder / "out.raw", fs::perms(0640));
    writeFileAtomically(folder / "out.raw", "new");
    EXPECT_EQ(fs::status(folder / "out.raw").permissions(), fs::perms(0640));
}

TEST(AtomicFile, GivesNewFilesWhatTheUmaskLeaves) {
    const test::TempFolder folder;
    const mode_t before = ::umask(027);
    writeFileAtomically(folder / "out.raw", "new");
    ::umask(before);
    EXPECT_EQ(fs::status(folder / "out.raw").permissions(), fs::perms(0640));
}

// While a private file is replaced, nobody else may read the new one, either.
TEST(AtomicFile, IsAsPrivateAsTheFileItReplaces) {
    const test::TempFolder folder;
    const mode_t before = ::umask(0);
    writeFileAtomically(folder / "out.raw", "secret");
    EXPECT_EQ(fs::status(folder / "out.raw").permissions(), fs::perms(0666));
    fs::permissions(folder / "out.raw", fs::perms(0600));
    AtomicFile file(folder / "out.raw");
    ::umask(before);
    struct stat status {};
    ASSERT_EQ(::fstat(file.descriptor(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777, 0600u);
    file.commit();
    EXPECT_EQ(fs::status(folder / "out.raw").permissions(), fs::perms(0600));
}

TEST(AtomicFile, KeepsOwnerAndGroupOfTheFileItReplaces) {
    if (::geteuid() != 0) GTEST_SKIP() << "only the superuser gives files away";
    const test::TempFolder folder;
    writeFileAtomically(folder / "out.raw", "old");
    ASSERT_EQ(::chown((folder / "out.raw").c_str(), 12345, 23456), 0);
    writeFileAtomically(folder / "out.raw", "new");
    struct stat status {};
    ASSERT_EQ(::stat((folder / "out.raw").c_str(), &status), 0);
    EXPECT_EQ(status.st_uid, 12345u);
    EXPECT_EQ(status.st_gid, 23456u);
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
              "output: " + link.string() + ": cannot be written: No space left on device");
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
    EXPECT_EQ(error,
              "output: " + (folder / "out.raw").string() + ": cannot be written: File too large");
    EXPECT_EQ(folder.count(), 0);
}

TEST(AtomicFile, NamesTheFinalFileWhenTheFolderIsMissing) {
    const test::TempFolder folder;
    const fs::path file = folder / "missing/out.exr";
    EXPECT_EQ(errorOf([&] { const AtomicFile probe(file); }),
              "output: " + file.string() + ": cannot be written: there is no folder " +
                  (folder / "missing").string());
}

TEST(AtomicFile, RefusesFoldersAndEmptyNames) {
    const test::TempFolder folder;
    EXPECT_EQ(errorOf([&] { const AtomicFile probe(folder.path()); }),
              "output: " + folder.path().string() + ": cannot be written: Is a directory");
    EXPECT_EQ(errorOf([&] { const AtomicFile probe(""); }),
              "output: : cannot be written: No such file or directory");
    writeFileAtomically(folder / "file", "");
    EXPECT_EQ(
        errorOf([&] { const AtomicFile probe(folder / "file/out.exr"); }),
        "output: " + (folder / "file/out.exr").string() + ": cannot be written: Not a directory");
}

TEST(AtomicFile, RefusesReadOnlyFilesAndFolders) {
    if (::geteuid() == 0) GTEST_SKIP() << "the superuser may write everywhere";
    const test::TempFolder folder;
    writeFileAtomically(folder / "out.raw", "precious");
    ::chmod((folder / "out.raw").c_str(), 0400);
    EXPECT_EQ(
        errorOf([&] { writeFileAtomically(folder / "out.raw", ""); }),
        "output: " + (folder / "out.raw").string() + ": cannot be written: Permission denied");
    ::chmod(folder.path().c_str(), 0500);
    EXPECT_EQ(
        errorOf([&] { writeFileAtomically(folder / "new.raw", ""); }),
        "output: " + (folder / "new.raw").string() + ": cannot be written: Permission denied");
    ::chmod(folder.path().c_str(), 0700);
}

TEST(AtomicFile, HoldsBackWhatTheGateHoldsBack) {
    const test::TempFolder folder;
    writeFileAtomically(folder / "out.raw", "old");
    setCommitGate([] { throw Error(ErrorCode::kInterrupted, "not now"); });
    EXPECT_EQ(errorOf([&] { writeFileAtomically(folder / "out.raw", "new"); }),
              "interrupted: not now");
    setCommitGate(nullptr);
    EXPECT_EQ(readBytes(folder / "out.raw"), "old");
    EXPECT_EQ(folder.count(), 1);
}

TEST(AtomicFile, RemovesWhatIsLeftWhenTheProcessHasToEnd) {
    const test::TempFolder folder;
    const AtomicFile first(folder / "a.raw");
    AtomicFile second(folder / "b.raw");
    second.commit();
    EXPECT_EQ(folder.count(), 2);
    removeTemporaryFiles();
    EXPECT_EQ(folder.count(), 1);
    EXPECT_TRUE(fs::exists(folder / "b.raw"));
}

TEST(AtomicFile, IsOnTheDiskBeforeItGetsItsNameIfAsked) {
    const test::TempFolder folder;
    synced.clear();
    writeFileAtomically(folder / "out.raw", "soon");
    EXPECT_EQ(synced, "");
    setSyncFiles(true);
    writeFileAtomically(folder / "out.raw", "now");
    setSyncFiles(false);
    EXPECT_EQ(synced, "file folder ");
}

}  // namespace

void noteSync(bool folder) {
    synced += folder ? "folder " : "file ";
}

}  // namespace deltasplat

// Stands in for the C library's.
extern "C" int fsync(int descriptor) {
    struct stat status {};
    ::fstat(descriptor, &status);
    deltasplat::noteSync(S_ISDIR(status.st_mode));
    return int(::syscall(SYS_fsync, descriptor));
}
