// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/image/exr_options.h"

#include <algorithm>
#include <cmath>

#include "deltasplat/error.h"
#include "dims_text.h"
#include "number_text.h"

namespace deltasplat {
namespace {

[[noreturn]] void refuse(const char* option, const std::string& got, const std::string& expected) {
    throw Error(ErrorCode::kUsage, gotExpected(option, got, expected));
}

void checkLevel(const ExrOptions& options) {
    if (!options.level) return;
    const std::string& name = options.compression;
    const std::string got = name + ":" + numberText(*options.level);
    const bool isZip = name.empty() || name == "zip" || name == "zips";
    if (!isZip && name != "dwaa" && name != "dwab")
        refuse("`compression`", got, "a level with zip, zips, dwaa or dwab alone");
    if (isZip && !(*options.level >= 1 && *options.level <= 9 &&
                   *options.level == std::floor(*options.level)))
        refuse("`compression`", got, "a level that is a whole number within 1..9");
    if (!(*options.level >= 0 && *options.level <= 1e6))
        refuse("`compression`", got, "a level within 0..1000000");
}

std::string namesText() {
    const std::vector<std::string>& names = exrCompressions();
    std::string text;
    for (const std::string& name : names)
        text += (text.empty() ? "" : &name == &names.back() ? " or " : ", ") + name;
    return text;
}

}  // namespace

const std::vector<std::string>& exrCompressions() {
    static const std::vector<std::string> names{"none",  "rle", "zip",  "zips", "piz",
                                                "pxr24", "b44", "b44a", "dwaa", "dwab"};
    return names;
}

void checkExrOptions(const ExrOptions& options, bool isDeep) {
    const std::string& name = options.compression;
    const std::vector<std::string>& names = exrCompressions();
    if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end())
        refuse("`compression`", name, namesText());
    // OpenEXR has none and rle for these as well, which pack worse.
    if (isDeep && !name.empty() && name != "zips")
        refuse("`compression`", name + " of a deep picture", "zips");
    checkLevel(options);
    if (!(options.pixelAspect >= 1e-6 && options.pixelAspect <= 1e6))
        refuse("pixel aspect", numberText(options.pixelAspect), "a number within 1e-06..1e+06");
    if (options.displaySize && (options.displaySize->x < 1 || options.displaySize->y < 1))
        refuse("display window", dimsText(*options.displaySize), "WxH, each at least 1");
}

}  // namespace deltasplat
