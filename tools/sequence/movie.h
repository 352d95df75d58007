// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <filesystem>
#include <glm/vec2.hpp>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "base/uncleared.h"
#include "deltasplat/atomic_file.h"
#include "sequence/frame_sink.h"

namespace deltasplat {

/// What a movie is made as.
struct MovieOptions {
    double framesPerSecond = 24;
    bool dither = true;  ///< as ImageFileOptions
};

/// Refuses a movie that cannot be made: another name than .mp4, .m4v, .mkv (H.264, 8 bits) or .mov
/// (ProRes 422 HQ, 10 bits), or for H.264 an odd size.
/// @throw Error(kUsage)
void checkMovie(const std::filesystem::path& file, glm::ivec2 sizePixels);

/// A movie of all frames, sRGB over black, made by the program ffmpeg, which is on the path. It has
/// one thread, so that the file's bytes do not depend on how many there are.
class Movie : public FrameSink {
  public:
    /// @throw Error(kOutput) without ffmpeg, or if the file cannot be written; as checkMovie
    Movie(const std::filesystem::path& file, glm::ivec2 sizePixels, const MovieOptions& options);
    ~Movie() override;
    Movie(const Movie&) = delete;
    Movie& operator=(const Movie&) = delete;

    /// Waits where frames before are long missing.
    /// @throw Error(kOutput) if ffmpeg has ended
    void put(std::size_t i, const Image& image) override;
    void skip(std::size_t i) override;
    void finish() override;

  private:
    using Bytes = UnclearedVector<unsigned char>;

    Bytes bytesOf(const Image& image) const;
    void start(glm::ivec2 size, double framesPerSecond);
    void pass(std::size_t i, Bytes bytes);
    void write(const Bytes& bytes);
    int wait();
    std::string said() const;
    [[noreturn]] void fail();

    AtomicFile file_;
    bool isProRes_;
    bool dither_;
    int pid_ = -1;
    int frames_ = -1;    // pipe to ffmpeg
    int messages_ = -1;  // what it says
    std::mutex mutex_;
    std::condition_variable changed_;
    std::map<std::size_t, Bytes> waiting_;  // empty: no picture
    std::size_t next_ = 0;                  // to be written
    bool isBroken_ = false;
};

}  // namespace deltasplat
