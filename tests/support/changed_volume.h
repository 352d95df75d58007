// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include "deltasplat/ingest/volume.h"

namespace deltasplat::test {

/// Lets a statement change one member of a volume: changed(volume)->space = "LPS".
class Changed {
  public:
    explicit Changed(Volume& volume) : volume_(volume), data_(volume.data()) {}
    ~Changed() noexcept(false) { volume_ = Volume(std::move(data_)); }
    Changed(const Changed&) = delete;
    Changed& operator=(const Changed&) = delete;
    VolumeData* operator->() { return &data_; }

  private:
    Volume& volume_;
    VolumeData data_;
};

inline Changed changed(Volume& volume) {
    return Changed(volume);
}

}  // namespace deltasplat::test
