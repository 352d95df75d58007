// SPDX-License-Identifier: Apache-2.0
#include "aside_header.h"

#include <fcntl.h>
#include <stdio.h>
#include <sys/file.h>

#include <cerrno>
#include <string>

#include "cannot_write.h"

namespace deltasplat {

AsideHeader::AsideHeader(const NameInFolder& header, const TemporaryFile& freshHeader,
                         const NameInFolder& data, const TemporaryFile& freshData,
                         const std::filesystem::path& finalPath)
    : placeholder_(header.folder, header.name, 0600, finalPath),
      // For writing, for network file systems lock nothing else.
      old_(::openat(header.folder, header.name.c_str(),
                    O_WRONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC)) {
    if (old_) ::flock(old_.get(), LOCK_EX | LOCK_NB);

    // From here on the name is that of an old header, which nobody may remove.
    const std::string aside = placeholder_.name();
    place_ = listHeaderChange({header, aside, placeholder_.identity(), freshHeader.name(),
                               freshHeader.identity(), data, freshData.identity()});
    if (place_ < 0) throwCannotWrite(finalPath, EMFILE);
    placeholder_.release();
    if (::renameat(header.folder, header.name.c_str(), header.folder, aside.c_str()) == 0) return;
    const int problem = errno;
    if (problem == ENOENT) return;
    settleHeaderChange(place_);
    throwCannotWrite(finalPath, problem);
}

AsideHeader::~AsideHeader() {
    settleHeaderChange(place_);
}

}  // namespace deltasplat
