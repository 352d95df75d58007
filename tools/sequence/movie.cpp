// SPDX-License-Identifier: Apache-2.0
#include "sequence/movie.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cstring>
#include <iterator>
#include <sstream>
#include <string>
#include <utility>

#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/image/write_image.h"
#include "files/file_name.h"
#include "image/quantize.h"
#include "process/interrupt.h"

// Handed on to the program that is started.
extern char** environ;

namespace deltasplat {
namespace {

// Frames that may wait for one before them.
constexpr std::size_t kMostWaiting = 64;
// Where ffmpeg finds the file that it writes.
constexpr int kOutput = 3;

bool isProRes(const std::filesystem::path& file) {
    return lowerExtension(file) == ".mov";
}

std::string formatOf(const std::filesystem::path& file) {
    const std::string extension = lowerExtension(file);
    return extension == ".mkv" ? "matroska" : extension == ".mov" ? "mov" : "mp4";
}

// Words between spaces.
std::vector<std::string> argumentsFor(const std::filesystem::path& file, glm::ivec2 size,
                                      double framesPerSecond) {
    const bool proRes = isProRes(file);
    // Large digits first or last, as this machine has them.
    const std::string order = std::endian::native == std::endian::little ? "le" : "be";
    const std::string text =
        "ffmpeg -hide_banner -nostdin -loglevel error -xerror -y -f rawvideo -pix_fmt " +
        (proRes ? "rgba64" + order : "rgb24") + " -s " + dimsText(size) + " -framerate " +
        numberText(framesPerSecond) +
        " -i pipe:0 -an -threads 1 -filter_threads 1 -vf scale=flags=accurate_rnd+full_chroma_int:"
        "out_color_matrix=bt709:out_range=tv,format=" +
        (proRes ? "yuv422p10le" : "yuv420p") +
        ",setparams=color_primaries=bt709:color_trc=iec61966-2-1:colorspace=bt709" +
        " -color_primaries bt709 -colorspace bt709 -color_trc iec61966-2-1 -color_range tv"
        " -map_metadata -1 -fflags +bitexact -flags:v +bitexact -c:v " +
        (proRes ? "prores_ks -profile:v 3 -vendor apl0" : "libx264 -preset medium -crf 16") +
        (formatOf(file) == "matroska" ? "" : " -movflags +faststart+write_colr") + " -f " +
        formatOf(file) + " /proc/self/fd/" + std::to_string(kOutput);
    std::istringstream words(text);
    return {std::istream_iterator<std::string>(words), {}};
}

struct Pipe {
    int read = -1;
    int write = -1;
};

[[noreturn]] void failWithErrno(const char* what) {
    throw Error(ErrorCode::kFailed, std::string(what) + ": " + std::strerror(errno));
}

// Returns a descriptor in place of one, which is closed, that is none of those that a program that
// is started has: they may be free here.
int aboveStandard(int descriptor) {
    if (descriptor < 0) failWithErrno("no file for a movie");
    const int other = fcntl(descriptor, F_DUPFD_CLOEXEC, kOutput + 1);
    if (other < 0) failWithErrno("no file for a movie");
    close(descriptor);
    return other;
}

Pipe openPipe() {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) failWithErrno("no pipe for a movie");
    return {aboveStandard(ends[0]), aboveStandard(ends[1])};
}

void closeIt(int& descriptor) {
    if (descriptor >= 0) close(descriptor);
    descriptor = -1;
}

}  // namespace

void checkMovie(const std::filesystem::path& file, glm::ivec2 sizePixels) {
    const std::string extension = lowerExtension(file);
    if (extension != ".mp4" && extension != ".m4v" && extension != ".mkv" && extension != ".mov") {
        throw Error(ErrorCode::kUsage, "--movie", file.string(), ".mp4, .m4v, .mkv or .mov");
    }
    if (!isProRes(file) && (sizePixels.x % 2 != 0 || sizePixels.y % 2 != 0)) {
        throw Error(ErrorCode::kUsage, "--size",
                    dimsText(sizePixels) + " with --movie " + file.string(),
                    "an even width and height, or a .mov");
    }
}

Movie::Movie(const std::filesystem::path& file, glm::ivec2 sizePixels, const MovieOptions& options)
    : file_(file), isProRes_(isProRes(file)), dither_(options.dither) {
    checkMovie(file, sizePixels);
    start(sizePixels, options.framesPerSecond);
}

Movie::~Movie() {
    closeIt(frames_);
    if (pid_ >= 0) {
        kill(pid_, SIGKILL);
        wait();
    }
    closeIt(messages_);
}

void Movie::start(glm::ivec2 size, double framesPerSecond) {
    Pipe frames = openPipe();
    frames_ = frames.write;
    // No pipe, which would have to be read while frames are written.
    messages_ = aboveStandard(memfd_create("messages of ffmpeg", MFD_CLOEXEC));
    int output = aboveStandard(dup(file_.descriptor()));
    std::vector<std::string> arguments = argumentsFor(file_.finalPath(), size, framesPerSecond);
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, frames.read, STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, messages_, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, messages_, STDERR_FILENO);
    posix_spawn_file_actions_adddup2(&actions, output, kOutput);
    // Interrupts are for this program to hear, which then ends that one.
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    posix_spawnattr_setpgroup(&attributes, 0);
    const int error = posix_spawnp(&pid_, "ffmpeg", &actions, &attributes, argv.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    closeIt(frames.read);
    closeIt(output);
    if (error == 0) return;
    pid_ = -1;
    closeIt(frames_);
    closeIt(messages_);
    throw Error(ErrorCode::kOutput, "--movie",
                "no program ffmpeg (" + std::string(std::strerror(error)) + ")",
                "it on the path (Debian: apt install ffmpeg)");
}

Movie::Bytes Movie::bytesOf(const Image& image) const {
    if (!isProRes_) return opaqueSrgb(image, dither_);
    Image opaque = image;
    compositeOver(opaque, glm::vec4(0, 0, 0, 1));
    const UnclearedVector<std::uint16_t> samples = straightSrgb<std::uint16_t>(opaque);
    Bytes bytes(2 * samples.size());
    std::memcpy(bytes.data(), samples.data(), bytes.size());
    return bytes;
}

void Movie::put(std::size_t i, const Image& image) {
    pass(i, bytesOf(image));
}

void Movie::skip(std::size_t i) {
    pass(i, {});
}

void Movie::pass(std::size_t i, Bytes bytes) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return i < next_ + kMostWaiting || isBroken_; });
    if (isBroken_ && !bytes.empty()) fail();
    if (isBroken_ || i < next_) return;
    waiting_.emplace(i, std::move(bytes));
    while (!waiting_.empty() && waiting_.begin()->first == next_) {
        const Bytes frame = std::move(waiting_.begin()->second);
        waiting_.erase(waiting_.begin());
        ++next_;
        changed_.notify_all();
        write(frame);
    }
}

void Movie::write(const Bytes& bytes) {
    for (std::size_t done = 0; done < bytes.size();) {
        const ssize_t count = ::write(frames_, bytes.data() + done, bytes.size() - done);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) {
            isBroken_ = true;
            changed_.notify_all();
            fail();
        }
        done += std::size_t(count);
    }
}

int Movie::wait() {
    int status = 0;
    while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    pid_ = -1;
    return status;
}

std::string Movie::said() const {
    std::string text;
    char part[4096];
    ssize_t count = 0;
    while ((count = pread(messages_, part, sizeof part, off_t(text.size()))) > 0)
        text.append(part, std::size_t(count));
    while (!text.empty() && text.back() == '\n') text.pop_back();
    const std::size_t end = text.find_last_of('\n');
    return end == std::string::npos ? text : text.substr(end + 1);
}

// Says the last line that ffmpeg has said.
void Movie::fail() {
    throwIfInterrupted();
    const std::string why = said();
    throw Error(ErrorCode::kOutput, file_.finalPath().string() + ": ffmpeg could not make it" +
                                        (why.empty() ? "" : ": " + why));
}

void Movie::finish() {
    closeIt(frames_);
    // It may end well all the same where the end of the file could not be written.
    if (wait() != 0 || isBroken_ || !said().empty()) fail();
    file_.close();
    file_.commit();
}

}  // namespace deltasplat
