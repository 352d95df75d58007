// SPDX-License-Identifier: Apache-2.0
#include "process/end.h"
#include "program.h"
#include "subcommands.h"

int main(int argc, char** argv) {
    using namespace deltasplat;
    const int exitCode =
        runProgram({argv, argv + argc}, {addInfo, addConvert, addDelta, addRestore, addDiff,
                                         addRender, addFold, addBench, addSynth});
    endProgram(exitCode);
}
