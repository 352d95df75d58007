// SPDX-License-Identifier: Apache-2.0
#include "output_files.h"

#include <sys/stat.h>

#include <optional>
#include <system_error>
#include <tuple>

#include "deltasplat/atomic_file.h"
#include "deltasplat/error.h"
#include "files/file_bytes.h"
#include "files/temporary_file.h"
#include "formats/input_files.h"
#include "process/interrupt.h"
#include "process/run_log.h"

namespace deltasplat {
namespace {

// Returns where a name leads to, links followed: a folder and a name in it.
std::optional<std::tuple<dev_t, ino_t, std::string>> placeOf(const std::filesystem::path& file) {
    try {
        const OutputTarget target = findTarget(file);
        struct stat folder {};
        if (target.isDevice || ::fstat(target.folder.get(), &folder) != 0) return {};
        return std::tuple(folder.st_dev, folder.st_ino, target.name);
    } catch (const Error&) {
        return {};
    }
}

}  // namespace

bool sameFile(const std::filesystem::path& a, const std::filesystem::path& b) {
    std::error_code ignored;
    // Names that differ may lead to one file: by a hard link, or where case does not count.
    if (equivalent(a, b, ignored)) return true;
    const auto place = placeOf(a);
    return place && place == placeOf(b);
}

Files filesRead(const Files& inputs, const std::filesystem::path& transferFunction) {
    Files files;
    for (const std::filesystem::path& input : inputs) {
        const Files parts = filesOf(input);
        files.insert(files.end(), parts.begin(), parts.end());
    }
    if (!transferFunction.empty()) files.push_back(transferFunction);
    return files;
}

void checkOutput(const std::string& option, const std::filesystem::path& file, const Files& others,
                 const std::string& names) {
    if (file.empty()) return;
    requireOther(option, file, others, names);
    // Asked now, rather than after hours of work.
    const AtomicFile probe(file);
}

void requireOther(const std::string& option, const std::filesystem::path& file, const Files& others,
                  const std::string& names) {
    refuseLog(option, file);
    for (const std::filesystem::path& other : others) {
        if (other.empty() || !sameFile(file, other)) continue;
        throw Error(ErrorCode::kUsage, option, file.string(), "another file than " + names);
    }
}

void refuseLog(const std::string& option, const std::filesystem::path& file) {
    const std::filesystem::path log = runLogFile();
    if (log.empty() || !sameFile(file, log)) return;
    dropRunLog();
    throw Error(ErrorCode::kUsage, option, file.string(), "another file than --log");
}

Files makeFolderOf(const std::filesystem::path& file) {
    Files made;
    std::error_code error;
    for (std::filesystem::path folder = file.parent_path();
         !folder.empty() && !exists(folder, error); folder = folder.parent_path())
        made.push_back(folder);
    if (made.empty()) return made;
    create_directories(file.parent_path(), error);
    if (error) throwCannotWrite(file, error.value());
    return made;
}

void OutputFolders::makeFor(const std::filesystem::path& file) {
    // One at a time, or a folder in one that another thread has just made might be listed after it.
    const std::lock_guard lock(mutex_);
    const Files made = makeFolderOf(file);
    made_.insert(made_.begin(), made.begin(), made.end());
}

OutputFolders::~OutputFolders() {
    std::error_code ignored;
    for (const std::filesystem::path& folder : made_) remove(folder, ignored);
}

void writeStats(const std::filesystem::path& file, std::string_view json) {
    if (!file.empty()) writeFileAtomically(file, json);
    allIsWritten();
}

}  // namespace deltasplat
