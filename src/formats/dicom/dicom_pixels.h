// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "formats/dicom/dicom_slices.h"
#include "formats/dicom/dicom_stream.h"
#include "formats/raw/raw_format.h"
#include "modules/helper_process.h"

namespace deltasplat {

/// The numbers of a picture as they are stored: cells of whole bytes.
struct DicomCells {
    std::vector<std::byte> bytes;
    int bits = 16;                      ///< of a cell: 8, 16 or 32
    bool bigEndian = false;             ///< the order of a cell's bytes
    std::optional<DicomStream> stream;  ///< what they were unpacked from, where that says anything
};

/// What values become: a type that holds them all, and what stands for "nothing there".
struct DicomTarget {
    RawType type = RawType::kUint8;
    double nothing = 0;
};

/// Reads the slices of files one after the other. Of slices that lie in one picture, that is read
/// once. All calls come from one thread.
class DicomReader {
  public:
    /// Reads the values of a slice. GDCM unpacks packed ones, in the helper.
    /// @param to  [rows][columns] of target.type
    /// @throw Error(kInput) if there are no such pixels
    void read(const DicomSlice& slice, const DicomTarget& target, std::byte* to);

  private:
    static constexpr double kBytesOfGdcm = 19 << 20;  // resident, once it is loaded

    HelperProcess helper_{"dicom", kBytesOfGdcm};
    std::filesystem::path file_;
    std::uint64_t place_ = 0;
    DicomCells cells_;
};

}  // namespace deltasplat
