// SPDX-License-Identifier: Apache-2.0
#include "deltasplat/ingest/list_grids.h"

#include "ingest/delta/delta_format.h"
#include "ingest/files/file_name.h"
#include "ingest/files/input_files.h"
#include "ingest/vdb/default_grid.h"
#include "ingest/vdb/vdb_file.h"

namespace deltasplat {

GridList listGrids(const std::filesystem::path& file) {
    requireRegularFile(file);
    if (inputsAreConfined()) requireConfined(file);
    GridList list;
    const VdbFile vdb(file);
    const VdbGrid* const preferred = toldDefaultGrid(vdb);
    if (preferred && preferred->isScalar()) list.preferred = preferred->name;
    for (const VdbGrid& grid : vdb.grids()) {
        if (grid.isScalar()) {
            list.scalar.push_back(grid.name);
        } else {
            list.others.push_back(grid.describe());
        }
        const bool mayBeDelta = grid.type == "int32" || grid.type == "int64";
        if (mayBeDelta && isDeltaGrid(grid.type, vdb.metadata(grid))) {
            list.deltas.push_back(grid.name);
        } else {
            list.ordinary.push_back(grid.describe());
        }
    }
    return list;
}

}  // namespace deltasplat
