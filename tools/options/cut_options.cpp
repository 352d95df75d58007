// SPDX-License-Identifier: Apache-2.0
#include "options/cut_options.h"

#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/text.h"
#include "deltasplat/error.h"
#include "formats/format.h"
#include "formats/input_kind.h"
#include "formats/raw/raw_format.h"
#include "options/command_line.h"
#include "options/file_and_name.h"
#include "options/parse.h"

namespace deltasplat {
namespace {

constexpr std::int64_t kMostIndex = 1 << 30;
constexpr double kMostPlace = 1e30;
constexpr std::int64_t kMostLabel = 1000000000;  // as tables have them

// Reads the whole text, or says what was expected of it.
template <typename Read>
auto readOr(const std::string& option, const std::string& text, const std::string& expected,
            const Read& read) {
    try {
        return read();
    } catch (const Error&) {
        throw Error(ErrorCode::kUsage, option, text.empty() ? "nothing" : text, expected);
    }
}

[[noreturn]] void fail() {
    throw Error(ErrorCode::kUsage, "");
}

double parseEnd(const std::string& text, double none, const Parser<double>& parse) {
    return text.empty() ? none : parse("", text);
}

// `A:B`, either of which may be left out and then is `none`.
glm::dvec2 parseRange(const std::string& text, const glm::dvec2& none,
                      const Parser<double>& parse) {
    const std::vector<std::string> ends = splitAt(text, ':');
    if (ends.size() != 2) fail();
    const glm::dvec2 range(parseEnd(ends[0], none.x, parse), parseEnd(ends[1], none.y, parse));
    if (!(range.x <= range.y)) fail();
    return range;
}

double parseIndex(const std::string& option, const std::string& text) {
    return double(wholeNumber(-kMostIndex, kMostIndex)(option, text));
}

glm::dvec2 parseIndexRange(const std::string& text) {
    using Limits = std::numeric_limits<int>;
    return parseRange(text, {Limits::min(), Limits::max()}, parseIndex);
}

glm::dvec2 parsePlaceRange(const std::string& text) {
    constexpr double kNoEnd = std::numeric_limits<double>::infinity();
    return parseRange(text, {-kNoEnd, kNoEnd}, number(-kMostPlace, kMostPlace));
}

template <typename Box, typename ParseRange>
Box parseBox(const std::string& text, const ParseRange& parse) {
    const std::vector<std::string> ranges = splitAt(text, ',');
    if (ranges.size() != 3) fail();
    Box box;
    using Number = decltype(box.min.x);
    for (int axis = 0; axis < 3; ++axis) {
        const glm::dvec2 range = parse(ranges[std::size_t(axis)]);
        box.min[axis] = Number(range.x);
        box.max[axis] = Number(range.y);
    }
    return box;
}

// Of several boxes the last counts.
Cut parseCrop(const std::string& option, const std::string& text, Cut cut) {
    const std::string world = "world:";
    cut.cropIndex.reset();
    cut.cropWorld.reset();
    readOr(option, text,
           "I0:I1,J0:J1,K0:K1, first and last voxel along each axis, or world:X0:X1,Y0:Y1,Z0:Z1, "
           "as in 10:90,:,20:",
           [&] {
               if (text.starts_with(world)) {
                   cut.cropWorld = parseBox<WorldBox>(text.substr(world.size()), parsePlaceRange);
               } else {
                   cut.cropIndex = parseBox<IndexBox>(text, parseIndexRange);
               }
           });
    return cut;
}

AxisSlices parseSlices(const std::string& option, const std::string& text) {
    return readOr(option, text, "A:B, first and last slice along z, or x:A:B, y:A:B or z:A:B", [&] {
        const bool named = text.size() > 1 && text[1] == ':' && text[0] >= 'x' && text[0] <= 'z';
        return AxisSlices{named ? std::size_t(text[0] - 'x') : 2,
                          glm::ivec2(parseIndexRange(named ? text.substr(2) : text))};
    });
}

ClipPlane parsePlane(const std::string& option, const std::string& text) {
    return readOr(option, text,
                  "X,Y,Z,NX,NY,NZ, a point and a direction other than 0,0,0, numbers from -1e+30 "
                  "to 1e+30",
                  [&] {
                      const std::vector<std::string> parts = splitAt(text, ',');
                      if (parts.size() != 6) fail();
                      ClipPlane plane;
                      for (int axis = 0; axis < 3; ++axis) {
                          const auto parse = number(-kMostPlace, kMostPlace);
                          plane.pointWorld[axis] = parse(option, parts[std::size_t(axis)]);
                          plane.normalWorld[axis] = parse(option, parts[std::size_t(axis) + 3]);
                      }
                      if (plane.normalWorld == glm::dvec3(0)) fail();
                      return plane;
                  });
}

int parseLabel(const std::string& text) {
    return int(wholeNumber(-kMostLabel, kMostLabel)("", text));
}

std::set<int> parseLabels(const std::string& option, const std::string& text) {
    return readOr(option, text, "L,L,..., whole numbers from -1000000000 to 1000000000", [&] {
        std::set<int> labels;
        for (const std::string& part : splitAt(text, ',')) labels.insert(parseLabel(part));
        return labels;
    });
}

std::map<int, double> parseOpacities(const std::string& option, const std::string& text) {
    const std::string expected = "L=O,L=O,..., each label once, and opacities from 0 to 1";
    return readOr(option, text, expected, [&] {
        std::map<int, double> opacities;
        for (const std::string& part : splitAt(text, ',')) {
            const std::vector<std::string> pair = splitAt(part, '=');
            if (pair.size() != 2) fail();
            // Of two for one label neither can be what is meant.
            const double opacity = number(0, 1)(option, pair[1]);
            if (!opacities.emplace(parseLabel(pair[0]), opacity).second) fail();
        }
        return opacities;
    });
}

// What neither names a place in the world nor directions.
bool saysNoPlace(const std::filesystem::path& input) {
    return !findInput(input, {}).format->saysPlace;
}

FileAndName fileAndGrid(const std::filesystem::path& mask) {
    return findFileAndName("--mask", mask).value_or(FileAndName{mask, ""});
}

// What the volume was read with is not all meant for its mask.
ReadOptions maskOptions(const FileAndName& mask, const ReadOptions& read) {
    ReadOptions options;
    if (!mask.name.empty()) options.gridName = mask.name;
    options.nanValue = read.nanValue;
    options.raw = read.raw;
    RawFormat named;
    named.spacing = read.raw.spacing;
    named.origin = read.raw.origin;
    try {
        resolveRawLayout(mask.file, named);
        options.raw = named;
    } catch (const Error&) {
        // Its name says nothing: then what is said of the volume goes for both.
    }
    return options;
}

// Where either file says nothing of a place, voxels belong together by their numbers.
void placeMask(const std::filesystem::path& input, const Volume& volume,
               const std::filesystem::path& file, Volume& mask) {
    const bool isDense = !volume.hasBackground() && !mask.hasBackground();
    if (!isDense || !(saysNoPlace(input) || saysNoPlace(file))) return;
    if (mask.box() != volume.box()) {
        throw Error(ErrorCode::kInput, "--mask",
                    file.string() + " of " + dimsText(mask.box().dims()) + " voxels",
                    dimsText(volume.box().dims()) +
                        ", as the volume has, for the files do not say "
                        "where both lie");
    }
    mask = mask.withPlace(volume.worldFromIndex(), volume.space(), volume.lengthUnit());
}

Volume readMask(const std::filesystem::path& input, const Volume& volume, const CutChoice& choice,
                const ReadOptions& read, const Listener& listener) {
    const FileAndName named = fileAndGrid(choice.mask);
    // The volume's progress was all of it; what remains is to be stopped.
    Listener reading;
    reading.warning = listener.warning;
    reading.progress = [&](double) { listener.report(1); };
    Volume mask = readVolume(named.file, maskOptions(named, read), reading);
    placeMask(input, volume, named.file, mask);
    return mask;
}

}  // namespace

bool CutChoice::cuts() const {
    return !cut.empty() || !slices.empty() || !mask.empty();
}

void addCutOptions(CLI::App& app, CutChoice& choice) {
    OptionGroup group(app, "Parts");
    Cut& cut = choice.cut;
    const Parser<Cut> crop = [&cut](const std::string& option, const std::string& text) {
        return parseCrop(option, text, cut);
    };
    group.addValue("--crop", "BOX", cut, crop,
                   "Leave the voxels of a box: I0:I1,J0:J1,K0:K1, the first and the\n"
                   "last index along each axis as info tells them, or\n"
                   "world:X0:X1,Y0:Y1,Z0:Z1, voxels whose centres lie in it. An end\n"
                   "that is left out is the volume's. The camera frames what is left");
    group.addEach("--slices", "A:B", choice.slices, Parser<AxisSlices>(parseSlices),
                  "Leave slices A to B of the file's third axis, or with x:A:B and\n"
                  "y:A:B of its first and second. Can be given several times");
    group.addEach("--clip", "X,Y,Z,NX,NY,NZ", cut.clipPlanes, Parser<ClipPlane>(parsePlane),
                  "Leave what lies on the side of a plane through the world point\n"
                  "X,Y,Z that the normal NX,NY,NZ points to. Can be given several\n"
                  "times; the camera stays where it is");
    group.addValue("--mask", "FILE[:GRID]", choice.mask, anyText(),
                   "Leave voxels where this volume is active and not 0. Its voxels\n"
                   "may lie elsewhere in the world: the nearest one counts. GRID: of\n"
                   "a .vdb (default: as for --grid)");
}

void addLabelOptions(CLI::App& app, LabelChanges& changes) {
    OptionGroup group(app, "Parts");
    group.addValue("--hide-labels", "L,L,...", changes.hidden, Parser<std::set<int>>(parseLabels),
                   "Make labels clear, with a table of labels or preset labels as --tf");
    group.addValue("--show-labels", "L,L,...", changes.shown, Parser<std::set<int>>(parseLabels),
                   "Make all other labels clear");
    group.addValue("--label-opacity", "L=O,...", changes.opacities,
                   Parser<std::map<int, double>>(parseOpacities),
                   "Opacities 0 to 1 of labels, in place of the table's");
}

std::vector<std::filesystem::path> filesOfMask(const CutChoice& choice) {
    if (choice.mask.empty()) return {};
    const FileAndName named = fileAndGrid(choice.mask);
    if (named.name.empty() || findInput(named.file, {}).is(vdbFormat())) return {named.file};
    throw Error(ErrorCode::kUsage, "--mask", choice.mask.string(),
                "a .vdb before the colon, or no colon");
}

Volume cutAsChosen(const Volume& volume, const std::filesystem::path& input,
                   const CutChoice& choice, const ReadOptions& read, const Listener& listener) {
    Cut cut = choice.cut;
    for (const AxisSlices& one : choice.slices) cut.slices[one.axis] = one.range;
    if (!choice.mask.empty()) {
        cut.mask = std::make_shared<const Volume>(readMask(input, volume, choice, read, listener));
    }
    return cutVolume(volume, cut, listener);
}

}  // namespace deltasplat
