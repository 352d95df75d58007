// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "ingest/files/file_bytes.h"

namespace deltasplat {

/// The rows of a volume that lie in a file one after the other, slice by slice.
class StoredRows {
  public:
    /// @param start        place in the file of the first one
    /// @param rowsOfSlice  how many make a slice
    StoredRows(std::shared_ptr<const FileBytes> file, std::uint64_t start, std::size_t rowBytes,
               std::int64_t rowsOfSlice)
        : file_(std::move(file)), start_(start), rowBytes_(rowBytes), rowsOfSlice_(rowsOfSlice) {}

    /// Reads some rows of a slice. From any thread.
    /// @throw Error(kInput) if the file has become shorter
    void read(int slice, int firstRow, int rows, std::byte* to) const {
        const auto row = std::uint64_t(std::int64_t{slice} * rowsOfSlice_ + firstRow);
        const std::size_t wanted = std::size_t(rows) * rowBytes_;
        if (file_->read(start_ + row * rowBytes_, to, wanted) != wanted) file_->throwChanged();
    }
    /// @throw Error(kInput) if the file was written to after it was opened
    void requireUnchanged() const { file_->requireUnchanged(); }

  private:
    std::shared_ptr<const FileBytes> file_;
    std::uint64_t start_;
    std::size_t rowBytes_;
    std::int64_t rowsOfSlice_;
};

}  // namespace deltasplat
