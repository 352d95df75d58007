// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace deltasplat {

#ifdef DELTASPLAT_LATE_OPENVDB
/// Loads OpenVDB's library, unless it is there. Who calls one of its functions need not: that loads
/// it as well. It takes some 40 ms, most of them for looking up 47 thousand names.
/// @throw Error(kFailed) if it cannot be loaded
void loadOpenVdb();
#else
/// The program is linked with it.
inline void loadOpenVdb() {}
#endif

}  // namespace deltasplat
