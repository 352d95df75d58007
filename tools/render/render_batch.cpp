// SPDX-License-Identifier: Apache-2.0
#include "render/render_batch.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "base/text.h"
#include "batch/file_pattern.h"
#include "batch/memory_gate.h"
#include "batch/output_name.h"
#include "conversion/conversion_stats.h"
#include "deltasplat/atomic_file.h"
#include "deltasplat/ingest/list_grids.h"
#include "deltasplat/threads.h"
#include "flag_names.h"
#include "image/quantize.h"
#include "listener.h"
#include "output_files.h"
#include "process/interrupt.h"
#include "process/reuse_memory.h"
#include "process/terminate.h"
#include "render/render_input.h"
#include "render/render_modes.h"
#include "render/value_window.h"
#include "sequence/frame_name.h"
#include "sequence/frames_to_make.h"
#include "sequence/run_frames.h"
#include "volume/code_math.h"

namespace deltasplat {
namespace {

namespace fs = std::filesystem;

// Of the memory there is, what pictures that are made at the same time may take.
constexpr double kWorkShare = 0.5;
// What rendering takes of a voxel of the box, of a byte of a file that says nothing of boxes, and
// of a pixel.
constexpr double kBytesPerVoxel = 8;
constexpr double kBytesPerByte = 40;
constexpr double kBytesPerPixel = 200;

// What rendering takes at most; what cannot be told is told by who reads it.
double bytesFor(const RenderCommand& command) {
    const glm::dvec2 pixels(command.picture.render.camera.sizePixels);
    double bytes = kBytesPerByte * double(bytesOf({command.input}));
    try {
        std::uint64_t voxels = 0;
        for (const VolumeEntry& entry : listVolumes(command.input, command.picture.read))
            if (entry.box) voxels = std::max(voxels, voxelsOf(*entry.box));
        if (voxels > 0) bytes = std::min(bytes, kBytesPerVoxel * double(voxels));
    } catch (const Error&) {
        return bytes + kBytesPerPixel * pixels.x * pixels.y;
    }
    return bytes + kBytesPerPixel * pixels.x * pixels.y;
}

// What can be told of a picture that was there.
PictureFacts factsOf(const BatchItem& item, const RenderCommand& command) {
    try {
        for (const VolumeEntry& entry : listVolumes(item.input, command.picture.read)) {
            if (item.grid ? entry.name == item.grid : entry.preferred)
                return {entry.name,
                        entry.box ? entry.box->dims() : glm::ivec3(0),
                        {},
                        entry.box && entry.box->empty()};
        }
    } catch (const Error&) {
        return {item.grid.value_or(""), glm::ivec3(0), {}, false};
    }
    return {item.grid.value_or(""), glm::ivec3(0), {}, false};
}

// Values are shown as greys.
std::string thumbnailOfFile(const fs::path& file, bool holdsValues) {
    if (isOfNumbers(imageFormatOf(file))) return thumbnailOf(Image());
    Image image = readThumbnail(file, kThumbnailSide);
    if (holdsValues && !image.rgba.empty()) {
        for (std::size_t i = 3; i < image.rgba.size(); i += 4)
            image.rgba[i] = image.rgba[i] > 0 ? 1 : 0;
        showGreys(defaultWindow(Mode::kMip, middleValues(Mode::kMip, image)), image);
    }
    return thumbnailOf(std::move(image));
}

// What went wrong, without the name that it begins with, though with the line.
std::string withoutName(std::string what, const std::string& name) {
    if (what.starts_with(name + ": "))
        what.erase(0, name.size() + 2);
    else if (what.starts_with(name + ":"))
        what.replace(0, name.size() + 1, "line ");
    return printable(withFlagNames(what));
}

class BatchRun {
  public:
    // @param holdsValues  whether pictures hold values, not light
    BatchRun(const RenderCommand& command, const std::vector<BatchItem>& items,
             const BatchWork& work, bool holdsValues)
        : command_(command),
          items_(items),
          work_(work),
          holdsValues_(holdsValues),
          gate_(std::uint64_t(kWorkShare * double(availableMemory()))),
          threads_(threadCount()) {
        for (std::size_t i = 0; i < items.size(); ++i) {
            files_.push_back({int(i), items[i].input, items[i].output, nameOfItem(items[i])});
            entries_.push_back({items[i].input, items[i].folder, items[i].output, {}, {}, {}, {}});
        }
    }

    void run(const Listener& listener) {
        const std::vector<FrameFiles> frames = framesToMake(files_, command_.frames);
        noteThoseThere(frames);
        runFrames(
            frames, true, threads_,
            [&](std::size_t i, const Listener& part) { make(std::size_t(frames[i].frame), part); },
            listener);
    }

    const std::vector<IndexEntry>& entries() const { return entries_; }

  private:
    void noteThoseThere(const std::vector<FrameFiles>& frames) {
        if (command_.index.empty()) return;
        std::vector<std::size_t> there;
        auto next = frames.begin();
        for (std::size_t i = 0; i < items_.size(); ++i) {
            if (next != frames.end() && next->frame == int(i))
                ++next;
            else
                there.push_back(i);
        }
        parallelFor(there.size(), [&](std::size_t i) {
            IndexEntry& entry = entries_[there[i]];
            entry.facts = factsOf(items_[there[i]], command_);
            entry.thumbnail = thumbnailOfFile(entry.picture, holdsValues_);
        });
    }

    void make(std::size_t i, const Listener& listener) {
        IndexEntry& entry = entries_[i];
        const auto fail = [&](const std::string& what) {
            entry.failure = withoutName(what, items_[i].input.string());
        };
        try {
            makeOne(i, listener);
        } catch (const Error& error) {
            if (error.code() != ErrorCode::kInterrupted) fail(error.what());
            throw;
        } catch (const std::exception& problem) {
            fail(describe(problem));
            throw;
        }
    }

    void makeOne(std::size_t i, const Listener& listener) {
        const BatchItem& item = items_[i];
        IndexEntry& entry = entries_[i];
        if (item.failure) throw *item.failure;
        RenderCommand one = commandOf(command_, item);
        work_.open(one, listener);
        makeFolderOf(one.output);
        makeFolderOf(one.stats);
        work_.prepare(one, listener);
        // What takes much of the memory has as much of the threads.
        const double bytes = std::min(bytesFor(one), 0x1p62);
        const MemoryGate::Pass pass(gate_, std::uint64_t(bytes));
        // What is kept for the next picture is lacking where memory is limited.
        if (bytes > kWorkShare * double(availableMemory())) giveBackMemory();
        const int threads = int(std::lround(pass.share() * threads_));
        const Clock::time_point begin = Clock::now();
        const ThreadLimit limit(std::max(threads, threadCount()));
        entry.facts = work_.make(one, i, listener);
        entry.seconds = secondsSince(begin);
        if (!command_.index.empty()) entry.thumbnail = thumbnailOfFile(one.output, holdsValues_);
    }

    const RenderCommand& command_;
    const std::vector<BatchItem>& items_;
    const BatchWork& work_;
    bool holdsValues_;
    MemoryGate gate_;
    int threads_;
    std::vector<FrameFiles> files_;
    std::vector<IndexEntry> entries_;
};

void writeIndex(const RenderCommand& command, glm::ivec2 shape, const std::string& commandLine,
                double seconds, const BatchRun& run) {
    if (command.index.empty()) return;
    const Index index{command.input.string(), commandLine, seconds, shape, run.entries()};
    writeFileAtomically(command.index, indexText(index, command.index));
}

// The command of an item, or nothing if that cannot be opened, which is said when it is its turn.
std::optional<RenderCommand> tryOpen(const RenderCommand& command, const BatchItem& item,
                                     const BatchWork& work) {
    if (item.failure) return {};
    RenderCommand one = commandOf(command, item);
    try {
        work.open(one, {});
    } catch (const Error& error) {
        if (error.code() == ErrorCode::kInput) return {};
        throw;
    }
    return one;
}

// Says what is wrong with all pictures before any is made. Returns the command of the first.
RenderCommand checkFirst(const RenderCommand& command, const std::vector<BatchItem>& items,
                         const BatchWork& work) {
    std::optional<RenderCommand> first;
    for (auto item = items.begin(); item != items.end() && !first; ++item)
        first = tryOpen(command, *item, work);
    if (!first) return command;
    // Made again for each picture.
    OutputFolders folders;
    folders.makeFor(first->output);
    folders.makeFor(first->stats);
    work.prepare(*first, {});
    work.begin(*first);
    readOptics(first->picture, {});
    return *first;
}

void checkIndex(const fs::path& index) {
    if (index.empty()) return;
    if (hasPlaceholder(index))
        throw Error(ErrorCode::kUsage, "--index", index.string(), "one file");
    const std::string extension = lowerCase(index.extension().string());
    if (extension != ".html" && extension != ".htm")
        throw Error(ErrorCode::kUsage, "--index", index.string(), ".html");
}

}  // namespace

void addBatchOptions(CLI::App& app, RenderCommand& command) {
    OptionGroup group(app, "Batch");
    group.addValue("--index", "FILE", command.index, anyText(),
                   "Page to write (.html) with a small copy of each picture of a batch,\n"
                   "what it shows, and what went wrong. A batch is a picture of each\n"
                   "file that fits INPUT, a pattern in quotes: * ? [a-z], ** for folders.\n"
                   "--output has {name}, {dir}, {frame} or {grid} where these stand");
}

bool isBatch(const CLI::App& app, const RenderCommand& command) {
    const auto refuse = [](const std::string& option, const std::string& got,
                           const std::string& expected) {
        throw Error(ErrorCode::kUsage, option, got, expected);
    };
    const bool hasFrames = command.frames.asked() && FrameName::findInput(command.input);
    if (!hasFrames && isPattern(command.input)) {
        if (command.frames.asked())
            refuse("--frames", "it with a pattern of inputs", "one or the other");
        for (const char* option : {"--turntable", "--poses", "--first-pass", "--missing", "--movie",
                                   "--fps", "--slab-range"})
            if (isGiven(app, option))
                refuse(option, "it with a pattern of inputs", "a sequence or one volume");
        if (command.output.empty())
            refuse("--output", "nothing", "FILE (see 'deltasplat render --help')");
        if (command.contactSheet && hasPlaceholder(command.output))
            refuse("--output", command.output.string() + " with --contact-sheet", "one file");
        if (command.contactSheet && !command.index.empty())
            refuse("--index", "--contact-sheet besides", "one of them");
        checkIndex(command.index);
        return true;
    }
    const std::string expected = "a pattern of inputs in quotes, such as '*.vdb'";
    if (!command.index.empty()) refuse("--index", "it with " + command.input.string(), expected);
    if (hasPlaceholder(command.output))
        refuse("--output", command.output.string() + " with " + command.input.string(), expected);
    return false;
}

RenderCommand commandOf(const RenderCommand& command, const BatchItem& item) {
    RenderCommand one = command;
    one.input = item.input;
    one.output = item.output;
    one.stats = item.stats;
    if (item.grid) one.picture.read.gridName = item.grid;
    if (command.slate) {
        std::vector<std::string>& lines = one.annotations.lines;
        lines.insert(lines.begin(), item.input.filename().string());
        if (item.grid) lines.front() += ", " + *item.grid;
    }
    return one;
}

void renderBatch(const RenderCommand& command, const std::vector<BatchItem>& items,
                 const std::string& commandLine, const BatchWork& work, const Listener& listener) {
    interruptBetweenFiles();
    const Clock::time_point begin = Clock::now();
    const RenderCommand first = checkFirst(command, items, work);
    if (!command.index.empty()) {
        makeFolderOf(command.index);
        checkOutput("--index", command.index, {}, "");
    }
    BatchRun run(command, items, work, storesValues(first));
    const auto finish = [&] {
        work.end();
        writeIndex(command, first.picture.render.camera.sizePixels, commandLine,
                   secondsSince(begin), run);
    };
    try {
        run.run(listener);
    } catch (const Error& error) {
        if (error.code() == ErrorCode::kInterrupted) throw;
        // What is wrong with the pictures has the last word.
        try {
            finish();
        } catch (const Error& problem) {
            showError(problem.what());
        }
        throw;
    }
    finish();
}

}  // namespace deltasplat
