// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace deltasplat {

/// While one lives, what any thread gets from malloc is zero: for libraries that hand on memory
/// which a damaged file leaves unwritten, so that the same file always gives the same voxels. Only
/// with the GNU C library; elsewhere it does nothing.
class ClearedMemory {
  public:
    ClearedMemory();
    ~ClearedMemory();
    ClearedMemory(const ClearedMemory&) = delete;
    ClearedMemory& operator=(const ClearedMemory&) = delete;

    /// Whether one lives, or the environment has malloc write to all memory (MALLOC_PERTURB_): then
    /// no more should be taken than is used.
    static bool isWritten();
};

}  // namespace deltasplat
