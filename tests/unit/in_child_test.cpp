// SPDX-License-Identifier: Apache-2.0
#include "base/in_child.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>

#include "process/interrupt.h"
#include "support/error_of.h"

namespace deltasplat {
namespace {

using test::errorOf;

TEST(InChild, GivesWhatTheWorkWrote) {
    std::array<std::byte, 3> bytes{};
    EXPECT_TRUE(inChild(
        bytes.size(),
        [](std::byte* to) {
            for (int i = 0; i < 3; ++i) to[i] = std::byte(i + 1);
            return true;
        },
        bytes.data()));
    EXPECT_EQ(bytes[2], std::byte{3});
}

TEST(InChild, OutlivesWorkThatEndsTheProcess) {
    std::byte byte{};
    EXPECT_FALSE(inChild(
        1, [](std::byte*) -> bool { ::abort(); }, &byte));
    EXPECT_FALSE(inChild(
        1, [](std::byte*) -> bool { ::_exit(0); }, &byte));
    EXPECT_FALSE(inChild(
        1, [](std::byte*) -> bool { throw 1; }, &byte));
}

// Some libraries do so while they handle an exception: what that one says is kept, and files that
// the parent writes stay.
TEST(InChild, TellsWhatEndedTheWork) {
    const auto whyOf = [](const std::function<bool(std::byte*)>& work) {
        std::byte byte{};
        std::string why = "before";
        EXPECT_FALSE(inChild(1, work, &byte, &why));
        return why;
    };
    EXPECT_EQ(whyOf([](auto*) -> bool { throw std::runtime_error("a {b}"); }), "a {b}");
    EXPECT_EQ(whyOf([](auto*) -> bool {
                  try {
                      throw std::runtime_error("a {b}");
                  } catch (...) {
                      std::terminate();
                  }
              }),
              "a {b}");
    EXPECT_EQ(whyOf([](auto*) -> bool { std::terminate(); }), "");
    EXPECT_EQ(whyOf([](auto*) { return false; }), "");
    EXPECT_EQ(whyOf([](auto*) -> bool { throw std::runtime_error(std::string(9000, 'x')); }),
              std::string(4095, 'x'));
}

TEST(InChild, RemovesNoFilesOfItsParent) {
    const std::terminate_handler before = std::set_terminate([] { ::kill(::getppid(), SIGUSR1); });
    std::byte byte{};
    EXPECT_FALSE(inChild(
        1, [](auto*) -> bool { std::terminate(); }, &byte));
    std::set_terminate(before);
}

// A decoder that believes a size in its bytes takes no more than a child is given.
TEST(InChild, TakesNoMemoryWithoutEnd) {
    std::byte byte{};
    const auto takes = [&](std::size_t bytes) {
        return inChild(
            1,
            [bytes](std::byte*) {
                const std::unique_ptr<char, decltype(&std::free)> taken(
                    static_cast<char*>(std::malloc(bytes)), &std::free);
                if (taken) std::memset(taken.get(), 1, std::min<std::size_t>(bytes, 4096));
                return taken != nullptr;
            },
            &byte);
    };
    EXPECT_TRUE(takes(std::size_t{16} << 20));
    EXPECT_FALSE(takes(std::size_t{2} << 30));
}

// As the system does when memory runs out: the bytes are not to blame.
TEST(InChild, WorkThatSomebodyEndsIsNotBadInput) {
    std::byte byte{};
    const auto killed = [](std::byte*) -> bool { return ::raise(SIGKILL) == 0; };
    EXPECT_EQ(errorOf([&] { inChild(1, killed, &byte); }),
              "failed: work in a process of its own failed: it was ended by signal 9");
}

TEST(InChild, AForkThatFailsIsNotBadInput) {
    if (::geteuid() != 0) GTEST_SKIP() << "needs to become a user without other processes";
    const pid_t other = ::fork();
    if (other == 0) {
        const rlimit none{1, 1};
        ::setrlimit(RLIMIT_NPROC, &none);
        constexpr uid_t kNobodyElse = 3123456789;
        if (::setresuid(kNobodyElse, kNobodyElse, kNobodyElse) != 0) ::_exit(3);
        std::byte byte{};
        const std::string error = errorOf([&] {
            inChild(
                1, [](auto*) { return true; }, &byte);
        });
        ::_exit(error == "no error" ? 2 : error.rfind("failed: work in a process", 0) != 0);
    }
    int status = 0;
    ::waitpid(other, &status, 0);
    if (WEXITSTATUS(status) >= 2) GTEST_SKIP() << "this system does not limit processes";
    EXPECT_EQ(WEXITSTATUS(status), 0);
}

// Runs a process whose child hangs, ends the process, and waits for the end of the child, which
// alone holds the writing end of a pipe.
int endOfParent(int signal) {
    int alive[2];
    EXPECT_EQ(::pipe(alive), 0);
    const pid_t parent = ::fork();
    if (parent == 0) {
        handleSignals();
        std::byte byte{};
        const auto hang = [&](std::byte*) -> bool {
            (void)!::write(alive[1], "", 1);
            for (;;) ::pause();
        };
        inChild(1, hang, &byte);
        ::_exit(0);
    }
    ::close(alive[1]);
    char byte = 0;
    EXPECT_EQ(::read(alive[0], &byte, 1), 1);
    ::kill(parent, signal);
    int status = 0;
    ::waitpid(parent, &status, 0);
    EXPECT_EQ(::read(alive[0], &byte, 1), 0) << "the child outlives its parent";
    ::close(alive[0]);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

TEST(InChild, EndsWithItsParent) {
    EXPECT_EQ(endOfParent(SIGKILL), -SIGKILL);
}

TEST(InChild, EndsAtASignalForItsParent) {
    EXPECT_EQ(endOfParent(SIGTERM), 143);
    EXPECT_EQ(endOfParent(SIGINT), 130);
}

}  // namespace
}  // namespace deltasplat
