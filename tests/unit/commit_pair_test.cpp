// SPDX-License-Identifier: Apache-2.0
// A header and its data file, replaced by processes that a signal ends, that fail, or that are not
// alone: the two that are there in the end belong together, always.
#include <errno.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>
#include <string>

#include "deltasplat/atomic_file.h"
#include "support/error_of.h"
#include "unit/temp_folder.h"

namespace deltasplat {
namespace {

namespace fs = std::filesystem;
using test::errorOf;
using test::readBytes;

constexpr int kEnded = 7;

// Called at every change of a name and at every fsync, with how many there were before.
std::function<void(int)> atMoment;
int moments = 0;

void passMoment() {
    if (atMoment) atMoment(moments++);
}

class CommitPair : public testing::Test {
  protected:
    CommitPair() {
        std::ofstream(head()) << "old";
        std::ofstream(data()) << "old";
    }
    ~CommitPair() override { setSyncFiles(false); }

    fs::path head() const { return folder_ / "out.mhd"; }
    fs::path data() const { return folder_ / "out.raw"; }
    std::string both() const { return readBytes(head()) + " " + readBytes(data()); }

    void write(const std::string& what) const {
        AtomicFile head(this->head()), data(this->data());
        head.write(what.data(), what.size());
        data.write(what.data(), what.size());
        head.commitWithData(data);
    }
    // Writes in a process of its own, which does something at every moment.
    pid_t startWriting(const std::string& what, std::function<void(int)> action) const {
        const pid_t child = ::fork();
        if (child != 0) return child;
        moments = 0;
        atMoment = std::move(action);
        setCommitGate(passMoment);
        setSyncFiles(true);
        ::_exit(errorOf([&] { write(what); }) == "no error" ? 0 : 1);
    }
    static int exitCodeOf(pid_t child) {
        int status = 0;
        ::waitpid(child, &status, 0);
        return WEXITSTATUS(status);
    }

    test::TempFolder folder_;
};

TEST_F(CommitPair, ASignalLeavesTheOldTwoOrTheNewTwo) {
    int moment = 0;
    std::string seen;
    for (int code = kEnded; code == kEnded; ++moment) {
        ASSERT_LT(moment, 100);
        code = exitCodeOf(startWriting("new", [moment](int now) {
            if (now < moment) return;
            removeTemporaryFiles();
            ::_exit(kEnded);
        }));
        EXPECT_TRUE(both() == "old old" || both() == "new new")
            << "at " << moment << ": " << both();
        EXPECT_EQ(folder_.count(), 2) << "at " << moment;
        seen += both() + (code == kEnded ? ", " : "");
        std::ofstream(head()) << "old";
        std::ofstream(data()) << "old";
    }
    // Both files and three times the folder are brought to the disk, and three names change.
    EXPECT_EQ(moment, 2 + 3 + 3 + 1) << seen;
}

// What does not exist before is not there, or whole.
TEST_F(CommitPair, ASignalLeavesNothingOrTheNewTwo) {
    for (int moment = 0, code = kEnded; code == kEnded; ++moment) {
        fs::remove(head());
        fs::remove(data());
        code = exitCodeOf(startWriting("new", [moment](int now) {
            if (now < moment) return;
            removeTemporaryFiles();
            ::_exit(kEnded);
        }));
        EXPECT_TRUE(both() == " " || both() == "new new") << "at " << moment << ": " << both();
    }
}

TEST_F(CommitPair, WhatCannotReachTheDiskIsAnErrorOfAWholePair) {
    for (int moment = 0, code = 1; code == 1; ++moment) {
        ASSERT_LT(moment, 100);
        std::ofstream(head()) << "old";
        std::ofstream(data()) << "old";
        code = exitCodeOf(startWriting("new", [moment](int now) {
            // Turns what comes next into a failure: fsync's, or the gate's.
            if (now == moment) throw Error(ErrorCode::kOutput, "failed");
        }));
        EXPECT_TRUE(both() == "old old" || both() == "new new")
            << "at " << moment << ": " << both();
        EXPECT_EQ(folder_.count(), 2) << "at " << moment;
    }
}

// While the old header is set aside, another run comes along and removes what dead ones left.
TEST_F(CommitPair, AnotherRunLeavesAHeaderThatIsSetAside) {
    const pid_t child = startWriting("new", [this](int now) {
        if (fs::exists(head()) || fs::is_directory(data())) return;
        const pid_t other = ::fork();
        if (other == 0) {
            atMoment = nullptr;
            { const AtomicFile probe(head()); }
            ::_exit(now >= 0 ? 0 : 1);
        }
        exitCodeOf(other);
        fs::rename(data(), folder_ / "kept");
        fs::create_directory(data());
    });
    EXPECT_EQ(exitCodeOf(child), 1);
    EXPECT_EQ(readBytes(head()), "old");
    fs::remove(data());
    fs::rename(folder_ / "kept", data());
    EXPECT_EQ(both(), "old old");
    EXPECT_EQ(folder_.count(), 2);
}

// Whether a process has ended, or sleeps, as those do that wait for a lock.
bool restsOrHasEnded(pid_t child) {
    siginfo_t ended{};
    if (::waitid(P_PID, id_t(child), &ended, WEXITED | WNOHANG | WNOWAIT) != 0 || ended.si_pid != 0)
        return true;
    std::string stat = readBytes("/proc/" + std::to_string(child) + "/stat");
    const std::size_t name = stat.rfind(") ");
    return name == std::string::npos || stat[name + 2] == 'S';
}

// At every moment of one process another one begins to write the same pair.
TEST_F(CommitPair, TwoAtOnceDoNotMixTheirFiles) {
    for (int moment = 0, last = 0; moment <= last; ++moment) {
        std::ofstream(head()) << "old";
        std::ofstream(data()) << "old";
        int told[2];
        ASSERT_EQ(::pipe(told), 0);
        const pid_t first = startWriting("first", [&](int now) {
            (void)!::write(told[1], "", 1);
            if (now != moment) return;
            const pid_t second = startWriting("second", nullptr);
            while (!restsOrHasEnded(second)) ::sched_yield();
        });
        ::close(told[1]);
        // Ends when both have ended.
        char byte = 0;
        for (last = -1; ::read(told[0], &byte, 1) == 1; ++last) continue;
        EXPECT_EQ(exitCodeOf(first), 0);
        EXPECT_TRUE(both() == "first first" || both() == "second second")
            << "at " << moment << ": " << both();
        ::close(told[0]);
    }
}

}  // namespace

int syncAt(int) {
    try {
        passMoment();
    } catch (const Error&) {
        errno = EIO;
        return -1;
    }
    return 0;
}

}  // namespace deltasplat

// Stands in for the C library's.
extern "C" int fsync(int descriptor) {
    return deltasplat::syncAt(descriptor);
}
