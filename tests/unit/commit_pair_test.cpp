// SPDX-License-Identifier: Apache-2.0
// A header and its data file, replaced by a process that a signal ends or in which writing fails:
// each file is whole, no new header lies beside old data, and nothing else is left.
#include <errno.h>
#include <gtest/gtest.h>
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
    fs::path head() const { return folder_ / "out.mhd"; }
    fs::path data() const { return folder_ / "out.raw"; }

    void writeOld() const {
        std::ofstream(head()) << "old";
        std::ofstream(data()) << "old";
    }
    // Writes in a process of its own, which does something at every moment. Returns its exit code.
    int write(std::function<void(int)> action) const {
        const pid_t child = ::fork();
        if (child != 0) {
            int status = 0;
            ::waitpid(child, &status, 0);
            return WEXITSTATUS(status);
        }
        moments = 0;
        atMoment = std::move(action);
        setCommitGate(passMoment);
        setSyncFiles(true);
        ::_exit(errorOf([&] {
                    AtomicFile header(head()), described(data());
                    header.write("new", 3);
                    described.write("new", 3);
                    header.commitWithData(described);
                }) == "no error"
                    ? 0
                    : 1);
    }
    void expectSound(int moment) const {
        const std::string both = readBytes(head()) + " " + readBytes(data());
        EXPECT_TRUE(both == "old old" || both == "old new" || both == "new new")
            << "at " << moment << ": " << both;
        EXPECT_EQ(folder_.count(), 2) << "at " << moment;
    }

    test::TempFolder folder_;
};

TEST_F(CommitPair, ASignalAtAnyMoment) {
    int moment = 0;
    for (int code = kEnded; code == kEnded; ++moment) {
        ASSERT_LT(moment, 100);
        writeOld();
        code = write([moment](int now) {
            if (now < moment) return;
            removeTemporaryFiles();
            ::_exit(kEnded);
        });
        expectSound(moment);
    }
    // Both files and twice the folder are brought to the disk, and two names change.
    EXPECT_EQ(moment, 2 + 2 + 2 + 1);
}

TEST_F(CommitPair, AFailureAtAnyMoment) {
    for (int moment = 0, code = 1; code == 1; ++moment) {
        ASSERT_LT(moment, 100);
        writeOld();
        code = write([moment](int now) {
            // Turns what comes next into a failure: fsync's, or the gate's.
            if (now == moment) throw Error(ErrorCode::kOutput, "failed");
        });
        expectSound(moment);
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
