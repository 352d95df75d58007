// SPDX-License-Identifier: Apache-2.0
// What becomes of an output in a folder that others write as well, and of what dead processes
// leave.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>

#include "deltasplat/atomic_file.h"
#include "files/temporary_file.h"
#include "support/error_of.h"
#include "unit/temp_folder.h"

namespace deltasplat {
namespace {

namespace fs = std::filesystem;
using test::errorOf;
using test::readBytes;

constexpr const char* kTemporary = ".deltasplat.out.png.0.tmp";

// A child process that does something and then waits, until it is killed.
class Child {
  public:
    explicit Child(const std::function<void()>& work) {
        int done[2];
        EXPECT_EQ(::pipe(done), 0);
        id_ = ::fork();
        if (id_ == 0) {
            work();
            (void)!::write(done[1], "", 1);
            for (;;) ::pause();
        }
        char byte = 0;
        EXPECT_EQ(::read(done[0], &byte, 1), 1);
        ::close(done[0]);
        ::close(done[1]);
    }
    ~Child() { kill(); }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    void kill() {
        if (id_ > 0) {
            ::kill(id_, SIGKILL);
            ::waitpid(id_, nullptr, 0);
        }
        id_ = 0;
    }

  private:
    pid_t id_ = 0;
};

TEST(SharedFolder, WritesNothingToWhereItsNameIsRedirected) {
    const test::TempFolder folder, other;
    writeFileAtomically(other / "victim", "precious");
    AtomicFile file(folder / "out.png");
    fs::remove(folder / kTemporary);
    fs::create_symlink(other / "victim", folder / kTemporary);
    file.write("picture", 7);
    const std::string problem =
        "output: " + (folder / "out.png").string() +
        ": got another file in place of the one written; expected a folder in which others leave "
        "files alone";
    EXPECT_EQ(errorOf([&] { file.commit(); }), problem);
    EXPECT_EQ(readBytes(other / "victim"), "precious");
    EXPECT_FALSE(fs::exists(fs::symlink_status(folder / "out.png")));
}

TEST(SharedFolder, DoesNotTakeAnotherFileForItsOwn) {
    const test::TempFolder folder;
    AtomicFile file(folder / "out.png");
    file.write("picture", 7);
    fs::rename(folder / kTemporary, folder / "stolen");
    std::ofstream(folder / kTemporary) << "forged";
    EXPECT_NE(errorOf([&] { file.commit(); }), "no error");
    EXPECT_FALSE(fs::exists(folder / "out.png"));
    EXPECT_EQ(readBytes(folder / kTemporary), "forged");
}

TEST(SharedFolder, StaysInTheFolderThatItBeganIn) {
    const test::TempFolder folder, other;
    fs::create_directory(folder / "a");
    AtomicFile file(folder / "a/out.png");
    fs::rename(folder / "a", folder / "b");
    fs::create_symlink(other.path(), folder / "a");
    file.write("picture", 7);
    file.commit();
    EXPECT_EQ(readBytes(folder / "b/out.png"), "picture");
    EXPECT_EQ(other.count(), 0);
}

TEST(SharedFolder, LinksThatLeadNowhereAreErrors) {
    const test::TempFolder folder;
    fs::create_symlink("b.png", folder / "a.png");
    fs::create_symlink("a.png", folder / "b.png");
    fs::create_symlink("nowhere/c.png", folder / "c.png");
    fs::create_symlink("new/", folder / "d.png");
    const auto error = [&](const std::string& name) {
        return errorOf([&] { writeFileAtomically(folder / name, ""); });
    };
    const auto expected = [&](const std::string& name, const std::string& why) {
        return "output: " + (folder / name).string() + ": cannot be written: " + why;
    };
    EXPECT_EQ(error("a.png"), expected("a.png", "Too many levels of symbolic links"));
    EXPECT_EQ(error("c.png"), expected("c.png", "No such file or directory"));
    EXPECT_EQ(error("d.png"), expected("d.png", "No such file or directory"));
    for (const char* const name : {"a.png", "b.png", "c.png", "d.png"})
        EXPECT_TRUE(fs::is_symlink(folder / name)) << name;
    EXPECT_EQ(folder.count(), 4);
}

// What a shell has opened for several is not replaced: all write behind each other.
TEST(SharedFolder, OpenFilesAreWrittenToThroughTheirDescriptors) {
    const test::TempFolder folder;
    const fs::path log = folder / "log";
    const int file = ::open(log.c_str(), O_RDWR | O_CREAT, 0600);
    ASSERT_GE(file, 0);
    struct stat before {
    }, after{};
    ::fstat(file, &before);
    ASSERT_EQ(::write(file, "one ", 4), 4);
    const std::string number = std::to_string(file);
    fs::create_symlink("/dev/fd/" + number, folder / "link");
    writeFileAtomically("/proc/self/fd/" + number, "two ");
    writeFileAtomically("/dev/fd/" + number, "three ");
    writeFileAtomically(folder / "link", "four ");
    ASSERT_EQ(::write(file, "five ", 5), 5);
    // That of another process, which has its own place in the file.
    const pid_t child = ::fork();
    if (child == 0) {
        ::close(file);
        writeFileAtomically("/proc/" + std::to_string(::getppid()) + "/fd/" + number, "six");
        ::_exit(0);
    }
    ::waitpid(child, nullptr, 0);
    EXPECT_EQ(readBytes(log), "one two three four five six");
    ASSERT_EQ(::stat(log.c_str(), &after), 0);
    EXPECT_EQ(after.st_ino, before.st_ino);
    fs::remove(log);
    writeFileAtomically("/proc/self/fd/" + number, "seven");
    EXPECT_EQ(folder.count(), 1) << "a file that is gone gets no new name";
    ::close(file);
}

TEST(SharedFolder, LinksOfStrangersAreNotFollowed) {
    if (::geteuid() != 0) GTEST_SKIP() << "only the superuser makes a stranger's link";
    const test::TempFolder folder, other;
    fs::create_symlink(other / "victim", folder / "out.png");
    ASSERT_EQ(::lchown((folder / "out.png").c_str(), 12345, 12345), 0);
    for (const int mode : {01777, 0777, 01775, 0775, 0770, 0702}) {
        fs::permissions(folder.path(), fs::perms(mode));
        EXPECT_EQ(
            errorOf([&] { writeFileAtomically(folder / "out.png", "x"); }),
            "output: " + (folder / "out.png").string() + ": cannot be written: Permission denied")
            << std::oct << mode;
        EXPECT_EQ(other.count(), 0);
    }
    // A device is no exception.
    fs::create_symlink("/dev/null", folder / "null.png");
    ASSERT_EQ(::lchown((folder / "null.png").c_str(), 12345, 12345), 0);
    EXPECT_NE(errorOf([&] { writeFileAtomically(folder / "null.png", "x"); }), "no error");
    // The folder's owner may say where outputs in it go.
    ASSERT_EQ(::chown(folder.path().c_str(), 12345, 12345), 0);
    writeFileAtomically(folder / "out.png", "owner's");
    EXPECT_EQ(readBytes(other / "victim"), "owner's");
    ASSERT_EQ(::chown(folder.path().c_str(), 0, 0), 0);
    // In a folder of this user alone it is this user's doing.
    fs::permissions(folder.path(), fs::perms(0700));
    writeFileAtomically(folder / "out.png", "x");
    EXPECT_EQ(readBytes(other / "victim"), "x");
}

TEST(SharedFolder, TheNextOneRemovesWhatDeadProcessesLeft) {
    const test::TempFolder folder;
    const auto write = [&] {
        static AtomicFile* file = nullptr;
        file = new AtomicFile(folder / "out.png");
        file->write("half", 4);
    };
    {
        Child first(write), second(write), third(write);
        EXPECT_EQ(folder.count(), 3);
    }
    EXPECT_EQ(folder.count(), 3);
    std::ofstream(folder / ".deltasplat.other.png.0.tmp") << "of another output";
    writeFileAtomically(folder / "out.png", "whole");
    EXPECT_EQ(readBytes(folder / "out.png"), "whole");
    EXPECT_EQ(folder.count(), 2);
    EXPECT_TRUE(fs::exists(folder / ".deltasplat.other.png.0.tmp"));
}

TEST(SharedFolder, LivingProcessesKeepTheirs) {
    const test::TempFolder folder;
    int go[2];
    ASSERT_EQ(::pipe(go), 0);
    const pid_t child = ::fork();
    if (child == 0) {
        AtomicFile file(folder / "out.png");
        file.write("child's", 7);
        char byte = 0;
        (void)!::read(go[0], &byte, 1);
        file.commit();
        ::_exit(0);
    }
    while (!fs::exists(folder / kTemporary)) ::sched_yield();
    while (fs::file_size(folder / kTemporary) == 0) ::sched_yield();
    writeFileAtomically(folder / "out.png", "parent's");
    EXPECT_TRUE(fs::exists(folder / kTemporary));
    (void)!::write(go[1], "", 1);
    int status = -1;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
    EXPECT_EQ(readBytes(folder / "out.png"), "child's");
    EXPECT_EQ(folder.count(), 1);
    ::close(go[0]);
    ::close(go[1]);
}

// A file that is replaced while it is looked at is no link.
TEST(SharedFolder, OthersWhoWriteTheSameDoNotDisturb) {
    const test::TempFolder folder;
    std::ofstream(folder / "out.png") << "x";
    const pid_t child = ::fork();
    if (child == 0) {
        for (;;) {
            std::ofstream(folder / "new") << "y";
            ::rename((folder / "new").c_str(), (folder / "out.png").c_str());
        }
    }
    std::string errors;
    for (int i = 0; i < 20000 && errors.empty(); ++i) {
        const std::string error = errorOf([&] { findTarget(folder / "out.png"); });
        if (error != "no error") errors = error;
    }
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    EXPECT_EQ(errors, "");
}

TEST(SharedFolder, LongNamesFit) {
    const test::TempFolder folder;
    const std::string name(255, 'x');
    writeFileAtomically(folder / name, "x");
    EXPECT_EQ(readBytes(folder / name), "x");
    EXPECT_EQ(folder.count(), 1);
}

TEST(SharedFolder, WritesToPipes) {
    const test::TempFolder folder;
    ASSERT_EQ(::mkfifo((folder / "out.png").c_str(), 0600), 0);
    { const AtomicFile probe(folder / "out.png"); }  // waits for no reader
    const pid_t child = ::fork();
    if (child == 0) {
        writeFileAtomically(folder / "out.png", "through");
        ::_exit(0);
    }
    EXPECT_EQ(readBytes(folder / "out.png"), "through");
    ::waitpid(child, nullptr, 0);
    EXPECT_TRUE(fs::is_fifo(folder / "out.png"));
    EXPECT_EQ(folder.count(), 1);
}

}  // namespace
}  // namespace deltasplat
