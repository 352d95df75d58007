// SPDX-License-Identifier: Apache-2.0
#include "program.h"
#include "subcommands.h"

int main(int argc, char** argv) {
    using namespace deltasplat;
    return runProgram({argv, argv + argc}, {addInfo, addConvert, addDelta, addRestore, addDiff,
                                            addRender, addFold, addBench, addSynth});
}
