// SPDX-License-Identifier: Apache-2.0
#include "options/transfer_function_option.h"

#include <string>
#include <vector>

#include "deltasplat/error.h"
#include "deltasplat/optics/transfer_function_names.h"
#include "lower_case.h"
#include "optics/read_label_table.h"
#include "suggest.h"

namespace deltasplat {
namespace {

bool isThere(const std::filesystem::path& file) {
    std::error_code error;
    return std::filesystem::exists(file, error);
}

bool looksLikeFile(const std::string& text) {
    return text.find_first_of("./:") != std::string::npos;
}

[[noreturn]] void refuse(const std::string& text) {
    std::vector<std::string> names;
    std::string known;
    for (const Preset& preset : presets()) {
        names.push_back(preset.name);
        known += (known.empty() ? "" : ", ") + preset.name;
    }
    throw Error(ErrorCode::kUsage,
                gotExpected("--tf", text, "a file, or one of " + known + suggestion(text, names)));
}

}  // namespace

TransferFunctionOption parseTransferFunction(const std::filesystem::path& given) {
    const std::string text = given.string();
    if (text.empty()) return {};
    if (isThere(given)) return {given, "", nullptr};
    if (const Preset* preset = findPreset(text)) return {{}, "", preset};
    const std::size_t colon = text.rfind(':');
    if (colon != std::string::npos && isThere(text.substr(0, colon)))
        return {text.substr(0, colon), text.substr(colon + 1), nullptr};
    if (!looksLikeFile(text)) refuse(text);
    return {given, "", nullptr};
}

TransferFunction readTransferFunctionOption(const std::filesystem::path& given,
                                            const Listener& listener) {
    const TransferFunctionOption option = parseTransferFunction(given);
    if (option.preset) return presetFunction(option.preset->name);
    if (!option.name.empty()) return readTransferFunction(option.file, option.name, listener);
    const std::string extension = lowerCase(option.file.extension().string());
    if (extension == ".ctbl" || extension == ".label" || extension == ".txt")
        return readLabelTable(option.file);
    return readTransferFunction(option.file, listener);
}

}  // namespace deltasplat
