// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "deltasplat/ingest/volume.h"

namespace deltasplat {

/// Whether a volume has been read from deltas of its codes: then the codes are all that there is,
/// and exact whatever their book was. Otherwise the values are those of `source`, if any.
inline bool isOfCodes(const Volume& volume) {
    return volume.origin && volume.origin->codeBook == volume.codeBook.name();
}

}  // namespace deltasplat
