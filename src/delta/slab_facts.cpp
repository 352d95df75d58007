// SPDX-License-Identifier: Apache-2.0
#include "delta/slab_facts.h"

namespace deltasplat {

int SlabFacts::endOf(int share, int count) const {
    double all = 0;
    for (const Seen& slab : seen) all += slab.work;
    double before = 0;
    for (std::size_t slab = 0; slab < seen.size(); ++slab) {
        if (before + 0.5 * seen[slab].work >= all * share / count) return int(slab);
        before += seen[slab].work;
    }
    return int(seen.size());
}

}  // namespace deltasplat
