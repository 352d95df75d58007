// SPDX-License-Identifier: Apache-2.0
#include "stats_file.h"

#include <system_error>

#include "deltasplat/atomic_file.h"
#include "deltasplat/error.h"

namespace deltasplat {

bool sameFile(const std::filesystem::path& a, const std::filesystem::path& b) {
    std::error_code ignored;
    // Names that differ may lead to one file: by a hard link, or where case does not count.
    if (equivalent(a, b, ignored)) return true;
    return weakly_canonical(absolute(a), ignored) == weakly_canonical(absolute(b), ignored);
}

void checkStatsFile(const std::filesystem::path& stats,
                    const std::vector<std::filesystem::path>& others, const std::string& names) {
    if (stats.empty()) return;
    for (const std::filesystem::path& other : others) {
        if (!sameFile(stats, other)) continue;
        throw Error(ErrorCode::kUsage,
                    gotExpected("--stats", stats.string(), "another file than " + names));
    }
    // Asked now, rather than after hours of work.
    const AtomicFile probe(stats);
}

}  // namespace deltasplat
