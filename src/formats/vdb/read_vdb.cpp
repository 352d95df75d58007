// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <variant>

#include "base/parallel.h"
#include "base/progress.h"
#include "base/refuse.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "formats/delta/delta_format.h"
#include "formats/delta/read_delta_grid.h"
#include "formats/format.h"
#include "formats/input_files.h"
#include "formats/input_kind.h"
#include "formats/readers.h"
#include "formats/vdb/grid_metadata.h"
#include "formats/vdb/grid_volume.h"
#include "formats/vdb/vdb_file.h"
#include "formats/vdb/vdb_leaves.h"
#include "formats/vdb/vector_part.h"
#include "volume/tree_grid.h"
#include "volume/tree_types.h"
#include "volume/vdb_transform.h"

namespace deltasplat {
namespace {

constexpr const char* kScalarGrid =
    "a scalar grid (float, double, half, int32, int64, bool or mask)";

// A grid or one part of a vector grid.
struct ChosenGrid {
    const VdbGrid* grid;
    std::optional<int> part = {};

    std::string name() const {
        return part ? grid->name + "." + std::string(1, char('x' + *part)) : grid->name;
    }
};

// Share of the progress for reading and unpacking the file, by far the longer part.
constexpr double kReadShare = 0.8;

std::string listOf(const std::vector<VdbGrid>& grids) {
    std::vector<std::string> names;
    for (const VdbGrid& grid : grids) names.push_back(grid.describe());
    return nameList(names);
}

void requireScalar(const std::string& file, const VdbGrid& grid, const std::string& name) {
    if (grid.isScalar()) return;
    refuseInput(file, "grid \"" + name + "\" of type " + grid.type,
                isVector(grid)
                    ? kScalarGrid + std::string(", or a part of it such as ") + name + ".x"
                    : kScalarGrid);
}

const VdbGrid* findByName(const std::vector<VdbGrid>& grids, const std::string& name) {
    const auto find = [&](const auto& nameOf) {
        return std::find_if(grids.begin(), grids.end(),
                            [&](const VdbGrid& grid) { return nameOf(grid) == name; });
    };
    auto found = find([](const VdbGrid& grid) { return grid.name; });
    if (found == grids.end()) found = find([](const auto& grid) { return grid.numberedName(); });
    if (found == grids.end()) found = find([](const auto& grid) { return grid.plainName(); });
    return found == grids.end() ? nullptr : &*found;
}

// Finds "density[1]" by its unique name or as OpenVDB shows it, "density" as the first of the name,
// and "Cd.x" as a part of a vector grid.
ChosenGrid findGrid(const std::string& file, const std::vector<VdbGrid>& grids,
                    const std::string& name) {
    const VdbGrid* found = findByName(grids, name);
    if (found == nullptr) {
        if (const std::optional<VectorPart> part = vectorPartOf(name)) {
            const VdbGrid* whole = findByName(grids, part->grid);
            if (whole && isVector(*whole)) return {whole, part->axis};
        }
    }
    if (found == nullptr) {
        std::vector<std::string> names;
        for (const VdbGrid& grid : grids) names.push_back(grid.name);
        refuseInput(file, "no grid \"" + name + "\"",
                    grids.empty() ? "a file with grids"
                                  : "one of " + listOf(grids) + afterStop(suggestion(name, names)));
    }
    requireScalar(file, *found, name);
    return {found};
}

std::vector<ChosenGrid> chooseGrids(const std::string& where, const VdbFile& file,
                                    const std::optional<std::string>& name, bool all) {
    const std::vector<VdbGrid>& grids = file.grids();
    if (name) return {findGrid(where, grids, *name)};
    std::vector<ChosenGrid> chosen;
    for (const VdbGrid& grid : grids) {
        if (grid.isScalar()) chosen.push_back({&grid});
    }
    if (all && !chosen.empty()) return chosen;
    const VdbGrid* const preferred = defaultGrid(file);
    if (!preferred || (chosen.empty() && grids.size() > 1))
        refuseInput(where, grids.empty() ? "no grids" : "only " + listOf(grids), kScalarGrid);
    requireScalar(where, *preferred, preferred->name);
    return {{preferred}};
}

VolumeData readWholeGrid(const VdbFile& file, const ChosenGrid& chosen, const std::string& where,
                         const ReadOptions& options, const Listener& listener) {
    const VdbGrid& grid = *chosen.grid;
    Listener reading;
    reading.progress = [&](double share) { listener.report(kReadShare * share); };
    TreeGrid loaded = file.read(grid, reading);
    if (chosen.part) loaded = gridOfPart(loaded, *chosen.part);
    const GridCodesOptions coding{listener, where, grid.valueType(), options};
    VolumeData volume;
    if (isDeltaGrid(loaded)) {
        // Refuses a bad transform before the long decoding.
        worldFromIndexOf(*loaded.map, where);
        Listener decoding = listener;
        decoding.progress = [&](double share) {
            listener.report(kReadShare + (1 - kReadShare) * share);
        };
        volume = readDeltaGrid(loaded, file.metadata(), where, options, decoding);
        settleEmpty(volume, coding);
    } else {
        volume = volumeOfGrid(std::move(loaded), coding, file.metadata());
    }
    return volume;
}

bool isLevelSet(const VdbMetadata& metadata) {
    return gridClassOf(metadata) == kLevelSetClass;
}

// Whether a grid may be read leaf by leaf, because only its codes are wanted.
bool mayReadLeaves(const VdbFile& file, const VdbGrid& grid, const ReadOptions& options) {
    // Codes of halves are exact.
    const bool mayNeedSource = options.keepInexact && grid.valueType() != "half";
    if (options.keepSource || options.bits || mayNeedSource) return false;
    const VdbMetadata metadata = file.metadata(grid);
    const bool changes = options.levelSetToFog || options.levelSetSurface;
    return !(changes && isLevelSet(metadata)) && !isDeltaGrid(grid.type, metadata);
}

// Returns nothing if the grid must be read as a whole.
std::optional<VolumeData> readGridLeaves(const VdbFile& file, const VdbGrid& grid,
                                         const std::string& where, const ReadOptions& options,
                                         const Listener& listener) {
    constexpr double kFindShare = 0.2;  // for finding leaves
    for (const auto how : {VdbFile::Find::kByNotes, VdbFile::Find::kByWalking}) {
        std::optional<VdbValues> values;
        try {
            if (!mayReadLeaves(file, grid, options)) return std::nullopt;
            values = file.readValues(grid, how, partOf(listener, 0, kFindShare));
        } catch (const Error& error) {
            // Reading the grid as a whole reports the error.
            if (error.code() != ErrorCode::kInput) throw;
        }
        if (!values) return std::nullopt;
        try {
            const Listener unpacking = partOf(listener, kFindShare, 1);
            return volumeOfLeaves(*values, {unpacking, where, grid.valueType(), options});
        } catch (const DamagedLeaves&) {
            // The file's notes may be wrong instead.
            if (!values->byNotes) throw;
        }
    }
    return std::nullopt;
}

Volume readGrid(const VdbFile& file, const ChosenGrid& chosen, const std::string& where,
                const ReadOptions& options, const Listener& listener) {
    const VdbGrid& grid = *chosen.grid;
    double told = 0;
    Listener onward = listener;
    onward.progress = [&](double share) {
        told = std::max(told, share);
        listener.report(told);
    };
    std::optional<VolumeData> volume;
    if (!chosen.part) volume = readDeltaBlocks(file, grid, where, options, onward);
    if (volume) settleEmpty(*volume, {listener, where, grid.valueType(), options});
    if (!volume && !chosen.part) volume = readGridLeaves(file, grid, where, options, onward);
    if (!volume) volume = readWholeGrid(file, chosen, where, options, onward);
    volume->name = chosen.name();
    return volumeOfFile(where, std::move(*volume));
}

// Reads grids one after the other and hands them to a visitor.
class GridReader {
  public:
    GridReader(const VdbFile& file, const ReadOptions& options, const VolumeVisitor& visitor)
        : file_(file), options_(options), visitor_(visitor) {}

    // @param amongOthers  whether the grid is one of several that were not named
    void read(const ChosenGrid& grid, const std::string& where, bool amongOthers,
              const Listener& listener) {
        std::optional<Volume> volume = tryRead(grid, where, amongOthers, listener);
        if (!volume) return;
        anyTold_ = true;
        if (visitor_.volume) visitor_.volume(std::move(*volume));
    }

    // Refuses a file all of whose grids were passed over.
    void finish() {
        if (!anyTold_ && passedOver_)
            std::visit([this](const auto& error) { refuse(error); }, *passedOver_);
    }

  private:
    std::optional<Volume> tryRead(const ChosenGrid& grid, const std::string& where,
                                  bool amongOthers, const Listener& listener) {
        try {
            return readGrid(file_, grid, where, options_, listener);
        } catch (const NotFinite& error) {
            // Solvers leave undefined distances in caches, which nobody else can use.
            if (!amongOthers || !visitor_.other || !isLevelSet(file_.metadata(*grid.grid))) {
                refuse(error);
            } else {
                passOver(error, grid, "level set with NaN or infinite values");
            }
        } catch (const UnreadableGrid& error) {
            if (!amongOthers || !visitor_.other || visitor_.invalid) {
                refuse(error);
            } else {
                passOver(error, grid, grid.grid->valueType() + ", " + error.obstacle);
            }
        } catch (const Error& error) {
            if (error.code() != ErrorCode::kInput) throw;
            refuse(error);
        }
        return {};
    }

    template <typename Refused>
    void passOver(const Refused& error, const ChosenGrid& grid, const std::string& why) {
        passedOver_ = error;
        visitor_.other(grid.name(), why);
    }

    template <typename Refused>
    void refuse(const Refused& error) {
        if (!visitor_.invalid) throw error;
        anyTold_ = true;
        visitor_.invalid(error);
    }

    const VdbFile& file_;
    const ReadOptions& options_;
    const VolumeVisitor& visitor_;
    bool anyTold_ = false;
    std::optional<std::variant<NotFinite, UnreadableGrid>> passedOver_;
};

std::string whereOf(const std::filesystem::path& path, const ChosenGrid& grid) {
    return path.string() + ": grid \"" + grid.name() + "\"";
}

// Warns of grids of unknown type that might have been meant.
void warnOfUnknown(const std::filesystem::path& path, const VdbFile& file, const ChosenGrid& chosen,
                   const Listener& listener) {
    if (chosen.grid->plainName() == "density") return;
    std::vector<std::string> unknown;
    for (const VdbGrid& grid : file.grids())
        if (!grid.numeric && !grid.vector) unknown.push_back(grid.describe());
    if (unknown.empty()) return;
    listener.warn(path.string() + ": passed over " + nameList(unknown) +
                  ", of types that are not known");
}

// Warns which of several grids is read, unless the caller named it.
void warnOfOthers(const std::filesystem::path& path, const VdbFile& file, const ChosenGrid& chosen,
                  const ReadOptions& options, const Listener& listener) {
    if (options.gridName) return;
    warnOfUnknown(path, file, chosen, listener);
    const auto scalars = std::count_if(file.grids().begin(), file.grids().end(),
                                       [](const VdbGrid& grid) { return grid.isScalar(); });
    if (scalars <= 1) return;
    listener.warn(path.string() + ": reading grid \"" + chosen.name() + "\" of " +
                  std::to_string(scalars) + " scalar grids (`gridName` chooses another)");
}

// Returns nothing if the grid must be read as a whole.
std::optional<Volume> packedVolume(const VdbFile& file, const ChosenGrid& chosen,
                                   const std::string& where, const ReadOptions& options,
                                   const Listener& listener) {
    const VdbGrid& grid = *chosen.grid;
    if (chosen.part || options.nanValue || options.levelSetToFog) return std::nullopt;
    if (isDeltaGrid(grid.type, file.metadata(grid))) return std::nullopt;
    std::optional<VdbFile::Packed> packed = file.readPacked(grid);
    if (!packed) return std::nullopt;
    const GridCodesOptions coding{listener, where, grid.valueType(), options};
    VolumeData volume = placedVolume(packed->grid.leaves.transform(), packed->metadata, coding);
    const auto background = std::visit(
        [](const auto& nodes) { return double(nodes->background()); }, packed->grid.nodes);
    describeGrid(background, packed->metadata, coding, volume);
    volume.activeCount = packed->activeVoxels;
    if (volume.activeCount > 0) volume.box = boxOfVoxels(packed->activeBox, where);
    volume.source = std::make_shared<const SourceGrid>(
        SourceGrid{{}, {}, std::make_shared<const PackedGrid>(std::move(packed->grid))});
    settleEmpty(volume, coding);
    volume.name = chosen.name();
    return volumeOfFile(where, std::move(volume));
}

}  // namespace

std::optional<Volume> readPackedVolume(const std::filesystem::path& path,
                                       const ReadOptions& options, const Listener& listener) {
    const DefaultFloats floats;
    try {
        const InputKind kind = findInput(path, {});
        if (!kind.is(vdbFormat())) return std::nullopt;
        if (inputsAreConfined()) requireConfined(path);
        const VdbFile file(path);
        const ChosenGrid chosen = chooseGrids(path.string(), file, options.gridName, false).front();
        std::vector<std::string> warnings;
        const Listener noting{{}, [&](const std::string& text) { warnings.push_back(text); }};
        warnOfOthers(path, file, chosen, options, noting);
        auto volume = packedVolume(file, chosen, whereOf(path, chosen), options, noting);
        // Reading as a whole repeats the warnings.
        for (const std::string& text : warnings)
            if (volume) listener.warn(text);
        return volume;
    } catch (const Error& error) {
        // Reading the grid as a whole reports the error.
        if (error.code() != ErrorCode::kInput) throw;
        return std::nullopt;
    }
}

void readVdb(const std::filesystem::path& path, const ReadOptions& options, bool all,
             const VolumeVisitor& visitor, const Listener& listener) {
    const VdbFile file(path);
    const auto chosen = chooseGrids(path.string(), file, options.gridName, all);
    if (!all) warnOfOthers(path, file, chosen[0], options, listener);
    GridReader reader(file, options, visitor);
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        Listener part = listener;
        part.progress = [&, i](double share) {
            listener.report((double(i) + share) / double(chosen.size()));
        };
        reader.read(chosen[i], whereOf(path, chosen[i]), chosen.size() > 1, part);
    }
    reader.finish();
    if (!all || options.gridName || !visitor.other) return;
    for (const VdbGrid& grid : file.grids()) {
        if (!grid.isScalar()) visitor.other(grid.name, grid.type);
    }
}

const Format& vdbFormat() {
    static const Format format{.extensions = {".vdb"}};
    return format;
}

}  // namespace deltasplat
