// SPDX-License-Identifier: Apache-2.0
#include "conversion/conversion_files.h"

#include <string>

#include "deltasplat/convert/write_volume.h"
#include "deltasplat/error.h"
#include "output_files.h"

namespace deltasplat {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& output, const std::string& got) {
    throw Error(ErrorCode::kUsage, output.string(), got, "another name");
}

}  // namespace

std::vector<std::filesystem::path> checkConversionFiles(const std::filesystem::path& input,
                                                        const std::filesystem::path& output,
                                                        const std::filesystem::path& stats) {
    const Files sources = filesRead({input}, {});
    const std::filesystem::path dataFile = dataFileOf(output);
    refuseLog("OUTPUT", output);
    refuseLog("OUTPUT", dataFile);
    // By links: "o.raw" may lead to "o.mhd".
    if (!dataFile.empty() && sameFile(output, dataFile)) {
        refuse(output, "the file of its own data, " + dataFile.string() + ",");
    }
    for (const std::filesystem::path& source : sources) {
        if (sameFile(output, source) && !sameFile(output, input)) {
            refuse(output, "a file of the input " + input.string());
        }
        if (!dataFile.empty() && sameFile(dataFile, source)) {
            refuse(output, "the input " + source.string() + " as its data file");
        }
    }
    Files others = sources;
    others.insert(others.end(), {output, dataFile});
    checkOutput("--stats", stats, others, "the input and the output");
    return sources;
}

}  // namespace deltasplat
