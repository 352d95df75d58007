// SPDX-License-Identifier: Apache-2.0
#include "formats/format.h"

#include <algorithm>
#include <array>

#include "base/text.h"
#include "files/file_name.h"

namespace deltasplat {

std::span<const Format* const> formats() {
    static const std::array kAll{&vdbFormat(),   &rawVolumeFormat(), &npyFormat(),
                                 &nrrdFormat(),  &metaImageFormat(), &niftiFormat(),
                                 &dicomFormat(), &imageFormat()};
    return kAll;
}

const Format* formatOf(const std::filesystem::path& file) {
    std::string extension = lowerExtension(file);
    const bool gzip = extension.ends_with(".gz");
    if (gzip) extension.resize(extension.size() - 3);
    for (const Format* format : formats()) {
        if (std::ranges::find(format->extensions, extension) == format->extensions.end()) continue;
        return gzip && !format->mayBePacked ? nullptr : format;
    }
    return nullptr;
}

const DenseFormat* findDenseFormat(const std::string& extension) {
    for (const Format* format : formats())
        for (const DenseFormat& written : format->written)
            if (extension == written.extension) return &written;
    return nullptr;
}

namespace {

std::string listText(const std::vector<std::string>& all) {
    std::string text;
    for (std::size_t i = 0; i < all.size(); ++i)
        text += (i == 0 ? "" : i + 1 == all.size() ? " or " : ", ") + all[i];
    return text;
}

}  // namespace

std::string readableText() {
    std::string packed;
    std::vector<std::string> others;
    for (const Format* format : formats()) {
        for (const std::string& extension : format->extensions) {
            if (format->mayBePacked) {
                packed += (packed.empty() ? "" : ", ") + extension;
            } else {
                others.push_back(extension);
            }
        }
    }
    return packed + " (all of these also with .gz), " + listText(others);
}

std::string writableText() {
    std::vector<std::string> all{".vdb"};
    for (const Format* format : formats())
        for (const DenseFormat& written : format->written) all.push_back(written.extension);
    return listText(all);
}

}  // namespace deltasplat
