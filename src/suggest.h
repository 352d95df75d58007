// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace deltasplat {

/// Returns " Did you mean 'word'?" for the word most like `text` (the first of several), or nothing
/// if none is near enough to be a slip of the finger.
std::string suggestion(const std::string& text, const std::vector<std::string>& words);

/// The same behind a sentence that has no stop yet.
inline std::string afterStop(const std::string& suggestion) {
    return suggestion.empty() ? "" : "." + suggestion;
}

}  // namespace deltasplat
