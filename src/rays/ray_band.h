// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "rays/ray_plane.h"
#include "rays/ray_strip.h"
#include "splat/sheet_reading.h"

namespace deltasplat {

/// What all bands of a picture have in common.
struct RayInput {
    const RayVolume& volume;
    RayRule rule;
    const SheetLayout& layout;  ///< of one pixel a voxel
    const BasePlane& plane;     ///< with pixels as far apart as voxels
    bool marksPlaces = false;   ///< of largest values: whether it matters where values are from
};

/// Follows the lines of sight of a few rows of the base plane, slice by slice. What a pixel gets
/// does not depend on how the plane is cut into bands. Holds what that takes, to be used for one
/// band after the other; not thread-safe.
class RayBand {
  public:
    /// @param rows  the most that a band has
    RayBand(const RayInput& input, int rows);

    /// Reads all slices, in increasing order, at rows [firstRow, lastRow) of the plane. Of largest
    /// values, what is not met stays what it is.
    void run(int firstRow, int lastRow, RayPlanes& planes);

    /// What a band of so many rows takes.
    static double bytes(const RayInput& input, int rows);

  private:
    /// Cells [first, last) of a row: squares of 8x8 pixels that read a block and those beside it.
    struct CellRun {
        int first;
        int last;
        RayStrip::Fill fill;
    };
    /// A slice on the base plane: pixel p reads voxel p + offset + fraction, (v, u).
    struct Slice {
        int index;  // in its layer
        SliceMark mark;
        glm::ivec2 offset;
        glm::vec2 fraction;
    };

    void findSlices(int layer);
    void findRuns(int firstCell, int lastCell);
    RayStrip::Fill cellFill(int row, int column, bool both) const;
    void addSlice(const Slice& slice, int firstRow, int lastRow, RayPlanes& planes);
    void addRow(const Slice& slice, int y, RayPlanes& planes);
    float* restRow(int y, const RayPlane& plane);
    const std::uint8_t* findMet(const Slice& slice, int y, const CellRun& run);
    std::vector<CellRun>& runsOf(int cellRow, bool both) {
        return runs_[2 * std::size_t(cellRow - firstCell_) + both];
    }

    const RayInput& input_;
    glm::ivec2 blocks_;
    RayStrip strip_;
    std::vector<Slice> slices_;
    int firstCell_ = 0;
    int lastCell_ = 0;
    /// For each row of cells, those of pixels that read one row of blocks, and two.
    std::vector<std::vector<CellRun>> runs_;
    std::vector<RaySpan> spans_;
    std::vector<std::uint8_t> met_;
    int firstRow_ = 0;
    std::vector<float> rest_;  // as RaySpan::rest, for the band's rows; only for sums
    std::size_t metBytes_ = 0;
};

}  // namespace deltasplat
