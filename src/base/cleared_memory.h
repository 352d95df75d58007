// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace deltasplat {

/// While an object lives, malloc clears the memory that it returns, for all threads. Meant for
/// libraries that hand on memory which a damaged file leaves unwritten, so that one file always
/// gives the same voxels. Works with the GNU C library; elsewhere it does nothing.
class ClearedMemory {
  public:
    ClearedMemory();
    ~ClearedMemory();
    ClearedMemory(const ClearedMemory&) = delete;
    ClearedMemory& operator=(const ClearedMemory&) = delete;

    /// Whether malloc writes to all memory that it returns, because an object lives or because of
    /// MALLOC_PERTURB_. Then allocate no more than you use.
    static bool isWritten();
};

}  // namespace deltasplat
