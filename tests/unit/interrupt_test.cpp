// SPDX-License-Identifier: Apache-2.0
#include "process/interrupt.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>

#include "deltasplat/atomic_file.h"
#include "deltasplat/error.h"
#include "support/error_of.h"
#include "unit/temp_folder.h"

namespace deltasplat {
namespace {

using test::errorOf;

// Does something in a process of its own that handles signals. Returns its exit code, or minus the
// signal that ended it.
int inProcess(const std::function<void()>& work) {
    const pid_t child = ::fork();
    if (child == 0) {
        handleSignals();
        work();
        ::_exit(77);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

[[noreturn]] void hang() {
    for (;;) ::pause();
}

TEST(Interrupt, TheFirstSignalIsRemembered) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        const int code = inProcess([&] {
            if (isInterrupted()) ::_exit(1);
            ::raise(signal);
            if (!isInterrupted()) ::_exit(2);
            if (errorOf(throwIfInterrupted) != "interrupted: interrupted") ::_exit(3);
            ::_exit(interruptExitCode());
        });
        EXPECT_EQ(code, 128 + signal);
    }
}

TEST(Interrupt, ASecondOneEndsTheProcess) {
    const test::TempFolder folder;
    const int code = inProcess([&] {
        static AtomicFile file(folder / "out");
        ::raise(SIGTERM);
        ::raise(SIGINT);
    });
    EXPECT_EQ(code, 143);
    EXPECT_EQ(folder.count(), 0);
}

TEST(Interrupt, OneThatIsNotHeardEndsTheProcess) {
    const test::TempFolder folder;
    const int code = inProcess([&] {
        static AtomicFile file(folder / "out");
        ::raise(SIGINT);
        hang();
    });
    EXPECT_EQ(code, 130);
    EXPECT_EQ(folder.count(), 0);
}

TEST(Interrupt, KeepsFilesFromGettingTheirNames) {
    const test::TempFolder folder;
    const int code = inProcess([&] {
        ::raise(SIGTERM);
        const std::string error = errorOf([&] { writeFileAtomically(folder / "out", "x"); });
        ::_exit(error == "interrupted: interrupted" ? 0 : 1);
    });
    EXPECT_EQ(code, 0);
    EXPECT_EQ(folder.count(), 0);
}

// A picture that is there cannot be taken back: what is left to do is done.
TEST(Interrupt, AfterTheFirstFileTheWorkGoesOn) {
    const test::TempFolder folder;
    const int code = inProcess([&] {
        writeFileAtomically(folder / "picture", "x");
        for (const int signal : {SIGTERM, SIGTERM, SIGINT}) ::raise(signal);
        if (isInterrupted()) ::_exit(1);
        throwIfInterrupted();
        writeFileAtomically(folder / "stats", "y");
        ::_exit(0);
    });
    EXPECT_EQ(code, 0);
    EXPECT_EQ(folder.count(), 2);
}

TEST(Interrupt, AfterTheFirstFileWhatHangsIsEnded) {
    const test::TempFolder folder;
    const auto end = [&](bool all) {
        return inProcess([&] {
            writeFileAtomically(folder / "picture", "x");
            if (all) allIsWritten();
            ::raise(SIGTERM);
            hang();
        });
    };
    EXPECT_EQ(end(false), 143);
    EXPECT_EQ(end(true), 0);
}

// Who started the program may have set one, for itself.
TEST(Interrupt, AnAlarmSetBeforeIsNotHeard) {
    const int code = inProcess([] {
        ::alarm(1000);
        handleSignals();
        ::_exit(int(::alarm(0)) == 0 ? 0 : 1);
    });
    EXPECT_EQ(code, 0);
}

TEST(Interrupt, AnAlarmOfAStrangerEndsTheProcessWithItsNumber) {
    EXPECT_EQ(inProcess([] { ::raise(SIGALRM); }), 128 + SIGALRM);
}

TEST(Interrupt, IgnoredSignalsStayIgnored) {
    const auto before = ::signal(SIGINT, SIG_IGN);
    const int code = inProcess([] {
        ::raise(SIGINT);
        ::_exit(isInterrupted() ? 1 : 0);
    });
    ::signal(SIGINT, before);
    EXPECT_EQ(code, 0);
}

}  // namespace
}  // namespace deltasplat
