// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/convert/write_volume.h"

#include <utility>

#include "base/parallel.h"
#include "base/text.h"
#include "deltasplat/atomic_file.h"
#include "deltasplat/error.h"
#include "files/file_name.h"
#include "formats/dense/dense_layout.h"
#include "formats/dense/write_dense.h"
#include "formats/format.h"
#include "formats/vdb/write_grids.h"

namespace deltasplat {
namespace {

bool isVdb(const std::filesystem::path& file) {
    return lowerExtension(file) == ".vdb";
}

const DenseFormat& writtenFormat(const std::filesystem::path& file) {
    const std::string extension = lowerExtension(file);
    if (const DenseFormat* format = findDenseFormat(extension)) return *format;
    throw Error(ErrorCode::kUsage, file.string(), "extension \"" + extension + "\"",
                writableText());
}

// Headers are lines of text, and MetaImage replaces "%" by slice numbers.
void requireWritableName(const std::filesystem::path& dataFile) {
    const std::string name = dataFile.filename().string();
    if (printable(name) == name && name.find('%') == std::string::npos) return;
    throw Error(ErrorCode::kUsage, name, "a name with \"%\" or control characters",
                "one that a header can hold");
}

}  // namespace

std::filesystem::path dataFileOf(const std::filesystem::path& file) {
    const DenseFormat* format = findDenseFormat(lowerExtension(file));
    if (format == nullptr || *format->dataExtension == '\0') return {};
    return file.parent_path() / (nameWithoutExtensions(file) + format->dataExtension);
}

void checkVolumeFile(const std::filesystem::path& file) {
    if (!isVdb(file)) writtenFormat(file);
    const AtomicFile probe(file);
    const std::filesystem::path dataFile = dataFileOf(file);
    if (dataFile.empty()) return;
    requireWritableName(dataFile);
    const AtomicFile dataProbe(dataFile);
}

WriteReport writeVolumes(const std::filesystem::path& file, std::vector<Volume> volumes,
                         const WriteOptions& options, const Listener& listener) {
    const DefaultFloats floats;
    if (isVdb(file)) return writeGrids(file, std::move(volumes), options, listener);
    const DenseFormat& format = writtenFormat(file);
    if (volumes.size() != 1) {
        throw Error(ErrorCode::kUsage, file.string(), std::to_string(volumes.size()) + " volumes",
                    "one, except in a .vdb");
    }
    return writeDense(file, format, volumes.front(), listener);
}

}  // namespace deltasplat
