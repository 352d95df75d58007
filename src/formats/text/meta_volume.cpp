// SPDX-License-Identifier: Apache-2.0
// Based on: MetaIO's "MetaImage" tag reference (itk.org/Wiki/ITK/MetaIO/Documentation).
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "base/text.h"
#include "files/file_name.h"
#include "formats/dense/dense_layout.h"
#include "formats/text/text_header.h"
#include "volume/placement.h"

namespace deltasplat {

namespace {

struct Type {
    std::string_view name;
    RawType type;
};
// MET_LONG has 4 bytes on every system.
constexpr std::array<Type, 12> kTypes{{{"MET_UCHAR", RawType::kUint8},
                                       {"MET_CHAR", RawType::kInt8},
                                       {"MET_USHORT", RawType::kUint16},
                                       {"MET_SHORT", RawType::kInt16},
                                       {"MET_UINT", RawType::kUint32},
                                       {"MET_INT", RawType::kInt32},
                                       {"MET_ULONG", RawType::kUint32},
                                       {"MET_LONG", RawType::kInt32},
                                       {"MET_ULONG_LONG", RawType::kUint64},
                                       {"MET_LONG_LONG", RawType::kInt64},
                                       {"MET_FLOAT", RawType::kFloat32},
                                       {"MET_DOUBLE", RawType::kFloat64}}};

class MetaReader {
  public:
    MetaReader(const std::filesystem::path& file, const Listener& listener)
        : header_(readMetaHeader(file)), listener_(listener) {
        volume_.header = file;
    }

    TextVolume read() {
        readSizes();
        readValues();
        readData();
        std::vector<std::size_t> axes(volume_.sizes.size());
        for (std::size_t i = 0; i < axes.size(); ++i) axes[i] = i;
        takeVolumes(axes);
        takeThree(axes, volume_);
        place(axes);
        readRescale();
        const std::string* const intent = find("intent_code");
        if (intent != nullptr && *intent == "1002")
            volume_.labels = std::make_shared<const LabelList>();
        return std::move(volume_);
    }

  private:
    const std::string* find(const std::string& field) const { return header_.find(field); }
    [[noreturn]] void refuse(const std::string& got, const std::string& expected) const {
        refuseFile(volume_.header, got, expected);
    }
    std::int64_t whole(const std::string& field, std::int64_t missing) const {
        return wholeField(header_, field, missing, volume_.header);
    }

    // Returns the first of several synonymous fields.
    const std::string* findOne(std::initializer_list<const char*> fields) const {
        for (const char* const field : fields) {
            if (const std::string* const value = find(field)) return value;
        }
        return nullptr;
    }

    bool isTrue(const std::string& field) const {
        const std::string* const value = find(field);
        return value != nullptr && !value->empty() &&
               std::string_view("Tt1").find((*value)[0]) != std::string_view::npos;
    }

    void readSizes() {
        volume_.sizes =
            parseSizes(volume_.header.string(), requireField(header_, "dimsize", volume_.header));
        const std::int64_t axes = whole("ndims", 0);
        if (axes != std::int64_t(volume_.sizes.size())) {
            refuse("NDims = " + std::to_string(axes),
                   std::to_string(volume_.sizes.size()) + ", as many as there are sizes");
        }
    }

    // The first three axes longer than one voxel are spatial; the others count volumes.
    void takeVolumes(std::vector<std::size_t>& axes) {
        const auto isLong = [&](std::size_t axis) { return volume_.sizes[axis] > 1; };
        if (std::ranges::count_if(axes, isLong) <= 3) return;
        std::erase_if(axes, [&](std::size_t axis) { return !isLong(axis); });
        double volumes = 1;
        for (std::size_t i = 3; i < axes.size(); ++i) volumes *= double(volume_.sizes[axes[i]]);
        constexpr double kMost = 0x1p30;
        if (volumes > kMost) {
            refuse("sizes " + volume_.sizesText(), "at most " + numberText(kMost) + " volumes");
        }
        volume_.volumes = std::int64_t(volumes);
        axes.resize(3);
    }

    void readValues() {
        const std::string& text = requireField(header_, "elementtype", volume_.header);
        const auto* const found =
            std::ranges::find_if(kTypes, [&](const Type& type) { return type.name == text; });
        if (found == kTypes.end()) {
            refuse("values of type " + printable(text), "whole or real numbers");
        }
        volume_.layout.type = found->type;
        volume_.layout.bigEndian =
            isTrue("elementbyteordermsb") || isTrue("binarydatabyteordermsb");
        const std::int64_t channels = whole("elementnumberofchannels", 1);
        if (channels != 1) refuse(std::to_string(channels) + " values a voxel (vector)", "one");
    }

    void readData() {
        const std::string name = header_.fields.back().value;
        const bool local = name == "LOCAL" || name == "Local" || name == "local";
        if (local) {
            volume_.dataFile = volume_.header;
            volume_.dataStart = header_.dataStart;
        } else if (lowerCase(name) == "local") {
            refuse("data in \"" + printable(name) + "\"", "LOCAL or the name of one data file");
        } else {
            setDataFile(name, volume_);
        }
        const bool binary = find("binarydata") == nullptr || isTrue("binarydata");
        volume_.packed = isTrue("compresseddata");
        volume_.packing = Packing::kZlib;
        if (!binary && !volume_.packed) volume_.encoding = TextVolume::Encoding::kNumbers;
        const std::int64_t skipped = whole("headersize", 0);
        if (skipped < -1) refuse("HeaderSize " + std::to_string(skipped), "a number from -1 on");
        if (skipped > 0 && local) {
            refuse("HeaderSize " + std::to_string(skipped) + " for data in the same file", "0");
        }
        volume_.atEnd = skipped == -1;
        if (volume_.atEnd && (volume_.packed || !binary))
            refuse("HeaderSize -1 for values that are packed or text", "a number from 0 on");
        if (skipped > 0) volume_.dataStart += std::uint64_t(skipped);
    }

    // Returns a field's `count` numbers; none if no such field exists.
    std::vector<double> numbersOf(std::initializer_list<const char*> fields, std::size_t count) {
        const std::string* const text = findOne(fields);
        if (text == nullptr) return {};
        const auto numbers = numbersIn(*text);
        if (numbers && numbers->size() == count) return *numbers;
        refuse(std::string(*fields.begin()) + " " + printable(text->substr(0, 80)),
               std::to_string(count) + " numbers");
    }

    void place(const std::vector<std::size_t>& axes) {
        const std::size_t count = volume_.sizes.size();
        const auto spacing = numbersOf({"elementspacing", "elementsize"}, count);
        const auto origin = numbersOf({"offset", "position", "origin"}, count);
        const auto turn = numbersOf({"transformmatrix", "rotation", "orientation"}, count * count);
        for (std::size_t i = 0; i < axes.size(); ++i) {
            const auto column = int(i);
            for (std::size_t j = 0; j < axes.size(); ++j) {
                const double step = spacing.empty() ? 1 : spacing[axes[i]];
                const double way = turn.empty() ? double(i == j) : turn[axes[i] * count + axes[j]];
                volume_.worldFromIndex[column][int(j)] = step * way;
            }
            if (!origin.empty()) volume_.worldFromIndex[3][column] = origin[axes[i]];
        }
        volume_.worldFromIndex = withThickness(volume_.worldFromIndex, volume_.layout.dims, 1);
        requirePlacement(volume_.header.string(), "spacing and directions", volume_.worldFromIndex);
        readSpace();
        const std::string* const unit = find("distanceunits");
        if (unit != nullptr && *unit != "?" && *unit != "???")
            setUnits({*unit}, listener_, volume_);
    }

    // AnatomicalOrientation, such as "RAI", names the sides where axes start. Programs write it if
    // world space is a patient's (LPS), but ignore it. The matrix wins over it, with a warning.
    void readSpace() {
        const std::string* const text = find("anatomicalorientation");
        if (text == nullptr || text->size() != 3) return;
        constexpr std::array<std::string_view, 3> kSides{"RL", "AP", "IS"};
        bool agrees = true;
        unsigned seen = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const char letter = lowerCase(text->substr(std::size_t(axis), 1))[0];
            for (int world = 0; world < 3; ++world) {
                const std::string sides = lowerCase(std::string(kSides[std::size_t(world)]));
                const std::size_t side = sides.find(letter);
                if (side == std::string::npos) continue;
                seen |= 1U << world;
                const double way = volume_.worldFromIndex[axis][world];
                agrees = agrees && (side == 0 ? way > 0 : way < 0);
            }
        }
        if (seen != 7) return;
        volume_.space = "LPS";
        if (agrees) return;
        listener_.warn(volume_.header.string() + ": AnatomicalOrientation = " + printable(*text) +
                       " is not what the axes' directions are in LPS, where ITK has them; the "
                       "directions are believed");
    }

    void readRescale() {
        const auto number = [&](std::initializer_list<const char*> fields, double missing) {
            const std::vector<double> numbers = numbersOf(fields, 1);
            return numbers.empty() ? missing : numbers.front();
        };
        const double slope = number({"elementtointensityfunctionslope", "rescaleslope"}, 1);
        const double offset =
            number({"elementtointensityfunctionoffset", "rescaleintercept", "rescaleoffset"}, 0);
        // A slope of 0 means no rescale, as in NIfTI.
        if (slope == 0 || !std::isfinite(slope) || !std::isfinite(offset)) return;
        volume_.rescale = {slope, offset};
    }

    const TextHeader header_;
    const Listener& listener_;
    TextVolume volume_;
};

}  // namespace

TextVolume readMetaVolume(const std::filesystem::path& file, const Listener& listener) {
    return MetaReader(file, listener).read();
}

// Based on: MetaIO's "MetaImage" tag reference, as above. World space is LPS, as in ITK and
// programs based on it. AnatomicalOrientation, which ITK always writes, marks a patient's space.
namespace {

std::string typeText(RawType type) {
    switch (type) {
        case RawType::kUint8:
            return "MET_UCHAR";
        case RawType::kInt8:
            return "MET_CHAR";
        case RawType::kUint16:
            return "MET_USHORT";
        case RawType::kInt16:
            return "MET_SHORT";
        case RawType::kUint32:
            return "MET_UINT";
        case RawType::kInt32:
            return "MET_INT";
        case RawType::kUint64:
            return "MET_ULONG_LONG";
        case RawType::kInt64:
            return "MET_LONG_LONG";
        case RawType::kFloat32:
            return "MET_FLOAT";
        case RawType::kFloat64:
            break;
    }
    return "MET_DOUBLE";
}

// Returns the sides where axes start, as ITK spells them: "RAI" along x, y and z of LPS.
std::string orientationText(const glm::dmat3& directions) {
    constexpr const char* kFrom[3] = {"RL", "AP", "IS"};
    std::string text = "???";
    glm::dmat3 left = directions;
    for (int step = 0; step < 3; ++step) {
        // Names the remaining axis that is closest to a world axis first.
        int axis = 0, world = 0;
        for (int i = 0; i < 9; ++i) {
            if (std::abs(left[i / 3][i % 3]) > std::abs(left[axis][world])) {
                axis = i / 3, world = i % 3;
            }
        }
        text[std::size_t(axis)] = kFrom[world][directions[axis][world] < 0 ? 1 : 0];
        left[axis] = glm::dvec3(0);
        for (int other = 0; other < 3; ++other) left[other][world] = 0;
    }
    return text;
}

std::string vectorText(const glm::dvec3& v) {
    return " " + numberText(v.x) + " " + numberText(v.y) + " " + numberText(v.z);
}

}  // namespace

void settleMetaImage(DenseLayout& layout, const std::string&, WriteNotes& notes) {
    layout.turnTo("LPS");
    // ITK takes positions for millimetres, and scales only sizes if the header has another unit.
    layout.turnToMillimetres();
    layout.noteLabels("MetaImage", false, notes);
    if (!layout.isOrthogonal()) {
        notes.loss(
            "axes that are not at right angles: MetaImage has only rotations, and programs "
            "that rely on it misplace the voxels");
    }
}

std::string metaImageHeader(const DenseLayout& layout, const std::string& dataFile) {
    const glm::dmat3 directions = layout.directions();
    std::string text = "ObjectType = Image\nNDims = 3\nBinaryData = True\n";
    text += "BinaryDataByteOrderMSB = False\nCompressedData = False\n";
    text += "TransformMatrix =" + vectorText(directions[0]) + vectorText(directions[1]) +
            vectorText(directions[2]) + "\n";
    text += "Offset =" + vectorText(layout.origin()) + "\n";
    text += "CenterOfRotation = 0 0 0\n";
    if (!layout.space.empty()) {
        text += "AnatomicalOrientation = " + orientationText(directions) + "\n";
    }
    if (!layout.lengthUnit.empty()) text += "DistanceUnits = mm\n";
    text += "ElementSpacing =" + vectorText(layout.spacing()) + "\n";
    text += "DimSize = " + std::to_string(layout.dims.x) + " " + std::to_string(layout.dims.y) +
            " " + std::to_string(layout.dims.z) + "\n";
    text += "ElementType = " + typeText(layout.type) + "\n";
    // ITK's key for the intent of a NIfTI file.
    if (layout.labels) text += "intent_code = 1002\n";
    return text + "ElementDataFile = " + (dataFile.empty() ? "LOCAL" : dataFile) + "\n";
}

}  // namespace deltasplat
