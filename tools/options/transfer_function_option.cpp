// SPDX-License-Identifier: Apache-2.0
#include "options/transfer_function_option.h"

#include <string>
#include <vector>

#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/optics/transfer_function_names.h"
#include "optics/label_function.h"
#include "optics/located_json.h"
#include "options/file_and_name.h"

namespace deltasplat {
namespace {

bool looksLikeFile(const std::string& text) {
    return text.find_first_of("./:") != std::string::npos;
}

// A table of labels by its extension, unless what is in the file is JSON.
bool isLabelTable(const std::filesystem::path& file) {
    const std::string extension = lowerCase(file.extension().string());
    if (extension != ".ctbl" && extension != ".label" && extension != ".txt") return false;
    const std::string text = readSmallText(file, "a table of labels");
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    return first == std::string::npos || (text[first] != '[' && text[first] != '{');
}

[[noreturn]] void refuse(const std::string& text) {
    std::vector<std::string> names;
    std::string known;
    for (const Preset& preset : presets()) {
        names.push_back(preset.name);
        known += (known.empty() ? "" : ", ") + preset.name;
    }
    throw Error(ErrorCode::kUsage, "--tf", text,
                "a file, or one of " + known + afterStop(suggestion(text, names)));
}

}  // namespace

TransferFunctionOption parseTransferFunction(const std::filesystem::path& given) {
    const std::string text = given.string();
    if (text.empty()) return {};
    const std::optional<FileAndName> found = findFileAndName("--tf", given);
    // A file comes before all else of its name, and a preset before a part of its name.
    if (found && found->name.empty()) return {found->file, "", nullptr};
    if (const Preset* preset = findPreset(text)) return {{}, "", preset};
    if (found) return {found->file, found->name, nullptr};
    if (!looksLikeFile(text)) refuse(text);
    return {given, "", nullptr};
}

TransferFunction readTransferFunctionOption(const std::filesystem::path& given,
                                            const Listener& listener) {
    const TransferFunctionOption option = parseTransferFunction(given);
    if (option.preset) return presetFunction(option.preset->name);
    const bool isTable = isLabelTable(option.file);
    if (isTable && option.name.empty()) return readLabelTable(option.file, listener);
    if (isTable) {
        throw Error(ErrorCode::kUsage, "--tf", given.string(),
                    option.file.string() +
                        " alone, a table of labels, which holds no "
                        "transfer functions with names");
    }
    if (!option.name.empty()) return readTransferFunction(option.file, option.name, listener);
    return readTransferFunction(option.file, listener);
}

bool isForLabels(const std::filesystem::path& given) {
    try {
        const TransferFunctionOption option = parseTransferFunction(given);
        if (option.preset) return option.preset->values == Preset::Values::kLabels;
        return !option.file.empty() && isLabelTable(option.file);
    } catch (const Error&) {
        return false;
    }
}

std::map<int, std::string> labelNames(const std::filesystem::path& given) {
    const TransferFunctionOption option = parseTransferFunction(given);
    if (option.file.empty() || !isLabelTable(option.file)) return {};
    return readLabelNames(option.file);
}

}  // namespace deltasplat
