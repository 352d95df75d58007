// SPDX-License-Identifier: Apache-2.0
#include "modules/helper_process.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>

#include "process/interrupt.h"
#include "support/error_of.h"

namespace deltasplat {
namespace {

using test::errorOf;

// What the helper is asked for here, unit/helper_fault.cpp does.
struct Faults {
    HelperProcess helper{"fault", 0};
    std::string note;

    // The answer, or "not done".
    std::string answerTo(const std::string& request) {
        std::array<std::byte, 16> bytes{};
        helper.beginRequest(request, bytes.size());
        if (!helper.finishRequest(bytes.data(), &note)) return "not done";
        return reinterpret_cast<const char*>(bytes.data());
    }
    std::string noteAt(const std::string& request) {
        EXPECT_EQ(answerTo(request), "not done") << request;
        return note;
    }
};

bool hasChildren() {
    return ::waitpid(-1, nullptr, WNOHANG) >= 0 || errno != ECHILD;
}

TEST(HelperProcess, ServesManyRequests) {
    {
        Faults faults;
        const std::string process = faults.answerTo("process");
        EXPECT_NE(process, std::to_string(::getpid()));
        EXPECT_EQ(faults.answerTo("process"), process);
        EXPECT_TRUE(hasChildren());
    }
    EXPECT_FALSE(hasChildren());
}

TEST(HelperProcess, AnotherOneFollowsAFault) {
    Faults faults;
    for (const char* fault : {"abort", "exit", "throw 1"}) {
        const std::string before = faults.answerTo("process");
        EXPECT_EQ(faults.noteAt(fault), "at " + std::string(fault) + ": ");
        EXPECT_FALSE(hasChildren()) << fault;
        EXPECT_NE(faults.answerTo("process"), before) << fault;
        EXPECT_EQ(faults.note, "");
    }
}

// Some libraries end the process while they handle an exception: what that one says is kept.
TEST(HelperProcess, TellsWhatEndedTheWork) {
    Faults faults;
    EXPECT_EQ(faults.noteAt("throw"), "at throw: a {b}");
    EXPECT_EQ(faults.noteAt("terminate while handling"), "at terminate while handling: a {b}");
    const std::string start = "at throw much: ";
    EXPECT_EQ(faults.noteAt("throw much"), start + std::string(4096 - start.size(), 'x'));
}

// A decoder that believes a size in its bytes takes no more than the helper is given.
TEST(HelperProcess, TakesNoMemoryWithoutEnd) {
    Faults faults;
    EXPECT_NE(faults.answerTo("take 16 MiB"), "not done");
    EXPECT_EQ(faults.answerTo("take 2 GiB"), "not done");
}

// Descriptors are standard input, output and errors, and the folder that lists them.
TEST(HelperProcess, HasAMinuteAndNoDescriptorsOfItsParent) {
    const int open = ::open("/dev/null", O_RDONLY);
    Faults faults;
    EXPECT_EQ(faults.answerTo("descriptors"), "4");
    const std::string seconds = faults.answerTo("seconds");
    EXPECT_TRUE(seconds == "61" || seconds == "62") << seconds;
    ::close(open);
}

TEST(HelperProcess, IsLeftInTheMiddleOfItsWork) {
    {
        HelperProcess helper("fault", 0);
        helper.beginRequest("pause", 1);
    }
    EXPECT_FALSE(hasChildren());
}

// As the system does when memory runs out: the bytes are not to blame.
TEST(HelperProcess, WorkThatSomebodyEndsIsNotBadInput) {
    EXPECT_EQ(errorOf([] { Faults().answerTo("kill"); }),
              "failed: work in a process of its own failed: it was ended by signal 9");
}

TEST(HelperProcess, OneThatDoesNotStartIsNotBadInput) {
    const std::string failed = "failed: work in a process of its own failed: ";
    ::setenv("DELTASPLAT_HELPER", "/bin/true", 1);
    EXPECT_EQ(errorOf([] { Faults().answerTo("process"); }), failed + "it did not start");
    ::setenv("DELTASPLAT_HELPER", "/etc/passwd", 1);
    EXPECT_EQ(errorOf([] { Faults().answerTo("process"); }), failed + "Permission denied");
    ::unsetenv("DELTASPLAT_HELPER");
    const std::string error = errorOf([] { Faults{{"nothing", 0}, {}}.answerTo(""); });
    EXPECT_TRUE(error.starts_with(failed + "it did not start: ")) << error;
    EXPECT_NE(error.find("helper_nothing.so"), std::string::npos) << error;
    EXPECT_FALSE(hasChildren());
}

// Whether a process is there; one that nobody has waited for is not.
bool isAlive(pid_t process) {
    std::ifstream in("/proc/" + std::to_string(process) + "/stat");
    std::string text;
    return std::getline(in, text) && text.find(") Z") == std::string::npos;
}

// Runs a process whose helper hangs, ends the process, and waits for the end of the helper.
int endOfParent(int signal) {
    int said[2];
    EXPECT_EQ(::pipe2(said, O_CLOEXEC), 0);
    const pid_t parent = ::fork();
    if (parent == 0) {
        handleSignals();
        Faults faults;
        const pid_t helper = std::stoi(faults.answerTo("process"));
        (void)!::write(said[1], &helper, sizeof helper);
        faults.answerTo("pause");
        ::_exit(0);
    }
    pid_t helper = 0;
    EXPECT_EQ(::read(said[0], &helper, sizeof helper), ssize_t(sizeof helper));
    for (const int end : said) ::close(end);
    ::kill(parent, signal);
    int status = 0;
    ::waitpid(parent, &status, 0);
    for (int i = 0; i < 200 && isAlive(helper); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    EXPECT_FALSE(isAlive(helper)) << "the helper outlives its parent";
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

TEST(HelperProcess, EndsWithItsParent) {
    EXPECT_EQ(endOfParent(SIGKILL), -SIGKILL);
    EXPECT_EQ(endOfParent(SIGTERM), 143);
    EXPECT_EQ(endOfParent(SIGINT), 130);
}

}  // namespace
}  // namespace deltasplat
