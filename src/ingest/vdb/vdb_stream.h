// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <istream>
#include <streambuf>
#include <string>
#include <vector>

namespace deltasplat {

/// A read-only stream put together from texts in memory and ranges of one file, so that OpenVDB can
/// be handed one grid of a file and not a byte more. Ranges must lie inside of the file.
class VdbStreamBuf : public std::streambuf {
  public:
    /// @throw Error(kInput) if the file cannot be opened
    explicit VdbStreamBuf(const std::filesystem::path& file);
    void addText(std::string text);
    void addRange(std::uint64_t begin, std::uint64_t end);
    /// Calls `step` with the share read, every few megabytes; what it throws ends the reading.
    void onProgress(std::function<void(double)> step) { step_ = std::move(step); }
    /// Returns what `step` threw, if it did.
    std::exception_ptr stopped() const { return stopped_; }

  protected:
    std::streamsize xsgetn(char* to, std::streamsize count) override;
    int_type underflow() override;
    int_type uflow() override;
    pos_type seekoff(off_type offset, std::ios_base::seekdir from,
                     std::ios_base::openmode mode) override;

  private:
    struct Piece {
        std::string text;
        std::uint64_t begin = 0;
        std::uint64_t size = 0;
        bool inFile = false;
    };
    std::streamsize readPiece(char* to, std::streamsize count);
    void tell();

    std::ifstream file_;
    std::vector<Piece> pieces_;
    std::size_t piece_ = 0;
    std::uint64_t offset_ = 0;  // within the piece
    std::uint64_t read_ = 0;
    std::uint64_t total_ = 0;
    std::uint64_t told_ = 0;
    std::function<void(double)> step_;
    std::exception_ptr stopped_;
};

}  // namespace deltasplat
