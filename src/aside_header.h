// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "descriptor.h"
#include "temporary_file.h"
#include "temporary_list.h"

namespace deltasplat {

/// Takes an old header, if there is one, out of the way while the data file that it describes is
/// replaced and the new header gets its name. Destroyed, or when the process ends by a signal
/// (removeTemporaryFiles()), it brings that to its end: if the data file has been replaced, the new
/// header has the name, otherwise the old one has it back. Nothing but a kill leaves the header
/// without its name.
class AsideHeader {
  public:
    /// Folders and files must outlive this; for `finalPath` see TemporaryFile.
    /// @throw Error(kOutput) if the old header cannot be renamed
    AsideHeader(const NameInFolder& header, const TemporaryFile& freshHeader,
                const NameInFolder& data, const TemporaryFile& freshData,
                const std::filesystem::path& finalPath);
    ~AsideHeader();
    AsideHeader(const AsideHeader&) = delete;
    AsideHeader& operator=(const AsideHeader&) = delete;

  private:
    TemporaryFile placeholder_;  // lends its name to the old header
    Descriptor old_;             // keeps it locked: no other process takes it for a dead one's
    int place_ = -1;
};

}  // namespace deltasplat
