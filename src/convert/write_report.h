// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "deltasplat/convert/write_volume.h"

namespace deltasplat {

/// Collects the notes of a WriteReport.
class Notes {
  public:
    Notes(WriteReport& report, const std::filesystem::path& file)
        : report_(report), file_(file.string()) {}
    /// A detail that is there, but otherwise.
    void remark(const std::string& what) { report_.notes.push_back(file_ + ": " + what); }
    /// A detail that cannot be read back.
    void loss(const std::string& what) {
        remark(what);
        report_.lossless = false;
    }

  private:
    WriteReport& report_;
    std::string file_;
};

}  // namespace deltasplat
