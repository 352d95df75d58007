// SPDX-License-Identifier: Apache-2.0
#include "render/batch_items.h"

#include <sys/stat.h>

#include <map>
#include <set>
#include <system_error>
#include <utility>

#include "batch/file_pattern.h"
#include "batch/output_name.h"
#include "deltasplat/ingest/list_grids.h"
#include "files/file_name.h"
#include "formats/input_files.h"
#include "render/preview_file.h"

namespace deltasplat {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> gridsOf(const fs::path& input, const RenderCommand& command) {
    if (const auto& chosen = command.picture.read.gridName) return {*chosen};
    std::vector<std::string> grids;
    // What is in the way of one that cannot be read is said in its picture's place.
    for (const VolumeEntry& entry : listVolumes(input, command.picture.read))
        if (entry.scalar || !entry.obstacle.empty()) grids.push_back(entry.name);
    return grids;
}

// Finds out what names are to say, and which pictures there are.
class Batch {
  public:
    explicit Batch(const RenderCommand& command) : command_(command) {
        if (!command.contactSheet) output_.emplace("--output", command.output);
        if (!command.stats.empty()) stats_.emplace("--stats", command.stats);
    }

    void add(const FoundFile& found) {
        for (const fs::path& file : filesOf(found.file))
            if (const auto place = placeOf(file)) inputs_.insert(*place);
        const InputParts parts = partsOfInput(found.file, found.folder);
        const bool hasGrids = isVdbName(found.file);
        if (!output_ || !output_->hasGrid() || !hasGrids) return add(found, parts, {});
        std::vector<std::string> grids;
        try {
            grids = gridsOf(found.file, command_);
        } catch (const Error& error) {
            return fail(found.file, error);
        }
        for (const std::string& grid : grids) add(found, parts, grid);
        // What is wrong is said by who reads it.
        if (grids.empty()) add(found, parts, {});
    }

    void fail(const fs::path& file, const Error& error) {
        items_.push_back({file, {}, {}, {}, {}, error});
    }

    std::vector<BatchItem> take() {
        requireOthers("--index", command_.index);
        for (const BatchItem& item : items_) {
            requireOthers("--output", item.output);
            requireOthers("--progressive", previewOf(item));
            requireOthers("--stats", item.stats);
        }
        return std::move(items_);
    }

  private:
    fs::path previewOf(const BatchItem& item) const {
        const bool hasOne = command_.progressive && output_ && !item.output.empty();
        return hasOne ? previewFile(item.output) : fs::path();
    }

    // Which file of which disk it is, whatever its names.
    using PlaceOfFile = std::pair<dev_t, ino_t>;

    static std::optional<PlaceOfFile> placeOf(const fs::path& file) {
        struct stat status {};
        if (::stat(file.c_str(), &status) != 0) return {};
        return PlaceOfFile{status.st_dev, status.st_ino};
    }

    // Names that differ may lead to one file.
    static fs::path resolved(const fs::path& file) {
        std::error_code error;
        const fs::path path = fs::weakly_canonical(fs::absolute(file), error);
        return error ? fs::absolute(file).lexically_normal() : path;
    }

    void add(const FoundFile& found, InputParts parts, const std::optional<std::string>& grid) {
        parts.grid = grid && !grid->empty() ? *grid : parts.name;
        BatchItem item{found.file, found.folder, command_.output, {}, grid, {}};
        if (output_) item.output = output_->of(parts, found.file);
        if (stats_) item.stats = stats_->of(parts, found.file);
        items_.push_back(item);
        if (output_) take("--output", *output_, item.output);
        if (output_) take("--progressive", *output_, previewOf(item));
        if (stats_) take("--stats", *stats_, item.stats);
    }

    // No two have one file. Where names of grids are the reason the command is not wrong, nor are
    // other volumes.
    void take(const std::string& option, const OutputName& name, const fs::path& file) {
        if (file.empty()) return;
        const std::size_t last = items_.size() - 1;
        const auto [known, isNew] = outputs_.emplace(resolved(file), last);
        if (isNew) return;
        const std::size_t before = known->second;
        const std::string got = file.string() + " for " + nameOfItem(items_[before]) + " and " +
                                nameOfItem(items_[last]);
        if (!differInGrids(name, items_[before], items_[last])) {
            throw Error(ErrorCode::kUsage, option, got,
                        "a file for each ({dir} tells folders apart, {grid} grids)");
        }
        for (const std::size_t i : {before, last}) {
            items_[i].output.clear();
            items_[i].stats.clear();
            items_[i].failure = Error(ErrorCode::kInput, items_[i].input.string(), got,
                                      "grids whose names make a file for each (or --grid NAME)");
        }
    }

    static bool differInGrids(const OutputName& name, const BatchItem& a, const BatchItem& b) {
        const auto withoutGrid = [&](const BatchItem& item) {
            return name.of(partsOfInput(item.input, item.folder), item.input);
        };
        const bool isOne = &a == &b;
        const bool areOfOne = a.input == b.input;
        return name.hasGrid() && !isOne && (areOfOne || withoutGrid(a) != withoutGrid(b));
    }

    void requireOthers(const std::string& option, const fs::path& file) const {
        if (file.empty()) return;
        const auto refuse = [&](const std::string& names) {
            throw Error(ErrorCode::kUsage, option, file.string(), "another file than " + names);
        };
        const auto place = placeOf(file);
        if (place && inputs_.contains(*place)) refuse("the inputs");
        if (option == "--index" && outputs_.contains(resolved(file))) refuse("the pictures");
    }

    const RenderCommand& command_;
    std::optional<OutputName> output_;  // of each; empty: all are in one
    std::optional<OutputName> stats_;
    std::vector<BatchItem> items_;
    std::set<PlaceOfFile> inputs_;
    std::map<fs::path, std::size_t> outputs_;  // of which item
};

}  // namespace

std::string nameOfItem(const BatchItem& item) {
    if (!item.grid) return item.input.string();
    return item.input.string() + ", " + (item.grid->empty() ? "\"\"" : *item.grid);
}

std::vector<BatchItem> findBatch(const RenderCommand& command, const Listener& listener) {
    Batch batch(command);
    const FoundFiles found = findFiles(command.input, listener);
    if (found.files.empty() && found.unread.empty()) {
        throw Error(ErrorCode::kInput, command.input.string(), "no file that fits", "at least one");
    }
    for (const FoundFile& one : found.files) {
        listener.report(0);
        try {
            requireFoundIn(found.base, one.file);
            batch.add(one);
        } catch (const Error& error) {
            if (error.code() != ErrorCode::kInput) throw;
            batch.fail(one.file, error);
        }
    }
    for (const auto& [folder, problem] : found.unread) {
        batch.fail(folder,
                   Error(ErrorCode::kInput, folder.string(), problem, "a folder that can be read"));
    }
    return batch.take();
}

}  // namespace deltasplat
