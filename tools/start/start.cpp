// SPDX-License-Identifier: Apache-2.0
// The program that is called. It becomes the one that has OpenVDB, whose loading takes longer than
// most commands, or the one that only knows versions. It needs nothing but the C library, for it
// takes its time from both.
#include <limits.h>
#include <stdlib.h>
#include <sys/auxv.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cstdio>
#include <cstring>

namespace {

// Finds a program where the installation has it, as seen from this one, by whatever link it is
// called.
bool findProgram(const char* name, char (&file)[2 * PATH_MAX]) {
    // Without /proc there is what the system was told to run.
    const auto* const called = std::bit_cast<const char*>(::getauxval(AT_EXECFN));
    char self[PATH_MAX];
    if (!::realpath("/proc/self/exe", self) && !(called && ::realpath(called, self))) return false;
    *std::strrchr(self, '/') = 0;
    std::snprintf(file, sizeof file, "%s/" DELTASPLAT_PROGRAMS "/%s", self, name);
    return true;
}

}  // namespace

int main(int argc, char** argv) {
    const bool asksVersion = argc == 2 && std::strcmp(argv[1], "--version") == 0;
    char file[2 * PATH_MAX] = "place of the program";
    if (findProgram(asksVersion ? "version" : "deltasplat", file)) ::execv(file, argv);
    std::fprintf(stderr, "deltasplat: %s: got %s; expected a program, installed with this one\n",
                 file, std::strerror(errno));
    // diff has idiff's exit codes, where 1 is a warning. Before it there may be options.
    for (int i = 1; i < argc; ++i) {
        if (std::strcmp(argv[i], "diff") == 0) return 4;
        if (argv[i][0] != '-' && (i == 1 || argv[i - 1][0] != '-')) break;
    }
    return 1;
}
