// SPDX-License-Identifier: Apache-2.0
// Based on: Definition of NRRD File Format (teem.sourceforge.net/nrrd/format.html), version 5.
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "base/text.h"
#include "files/file_name.h"
#include "formats/text/text_header.h"
#include "volume/placement.h"

namespace deltasplat {
namespace {

// A space of the format, the space it becomes, and the world axis mirrored on the way; -1: none.
struct Space {
    std::string_view name, shortName;
    int axes;
    const char* becomes;
    int mirrored;
};
constexpr std::array<Space, 12> kSpaces{{{"right-anterior-superior", "RAS", 3, "RAS", -1},
                                         {"left-anterior-superior", "LAS", 3, "LPS", 1},
                                         {"left-posterior-superior", "LPS", 3, "LPS", -1},
                                         {"right-anterior-superior-time", "RAST", 4, "RAS", -1},
                                         {"left-anterior-superior-time", "LAST", 4, "LPS", 1},
                                         {"left-posterior-superior-time", "LPST", 4, "LPS", -1},
                                         {"scanner-xyz", "", 3, "", -1},
                                         {"scanner-xyz-time", "", 4, "", -1},
                                         {"3D-right-handed", "", 3, "", -1},
                                         {"3D-left-handed", "", 3, "", 2},
                                         {"3D-right-handed-time", "", 4, "", -1},
                                         {"3D-left-handed-time", "", 4, "", 2}}};

struct Type {
    RawType type;
    std::string_view names;  // separated by commas
};
constexpr std::array<Type, 10> kTypes{
    {{RawType::kUint8, ",uchar,unsigned char,uint8,uint8_t,"},
     {RawType::kInt8, ",char,signed char,int8,int8_t,"},
     {RawType::kUint16, ",ushort,unsigned short,unsigned short int,uint16,uint16_t,"},
     {RawType::kInt16, ",short,short int,signed short,signed short int,int16,int16_t,"},
     {RawType::kUint32, ",uint,unsigned int,uint32,uint32_t,"},
     {RawType::kInt32, ",int,signed int,int32,int32_t,"},
     {RawType::kUint64, ",ulonglong,unsigned long long,unsigned long long int,uint64,uint64_t,"},
     {RawType::kInt64,
      ",longlong,long long,long long int,signed long long,signed long long int,int64,int64_t,"},
     {RawType::kFloat32, ",float,"},
     {RawType::kFloat64, ",double,"}}};

class NrrdReader {
  public:
    NrrdReader(const std::filesystem::path& file, const Listener& listener)
        : header_(readNrrdHeader(file)), listener_(listener) {
        volume_.header = file;
    }

    TextVolume read() {
        readSizes();
        readType();
        readEncoding();
        readData();
        const std::vector<std::size_t> axes = readAxes();
        place(axes);
        readSegments(header_, volume_);
        return std::move(volume_);
    }

  private:
    const std::string* find(const std::string& field) const { return header_.find(field); }
    [[noreturn]] void refuse(const std::string& got, const std::string& expected) const {
        refuseFile(volume_.header, got, expected);
    }

    void readSizes() {
        volume_.sizes =
            parseSizes(volume_.header.string(), requireField(header_, "sizes", volume_.header));
        const std::int64_t axes = wholeField(header_, "dimension", -1, volume_.header);
        if (axes != std::int64_t(volume_.sizes.size())) {
            refuse(std::to_string(volume_.sizes.size()) + " sizes of dimension " +
                       std::to_string(axes),
                   "as many sizes as dimensions");
        }
    }

    void readType() {
        const std::string text = requireField(header_, "type", volume_.header);
        const std::string name = "," + lowerCase(text) + ",";
        const auto* const found = std::ranges::find_if(kTypes, [&](const Type& type) {
            return type.names.find(name) != std::string_view::npos;
        });
        if (found == kTypes.end()) {
            refuse("values of type " + printable(text), "whole or real numbers");
        }
        volume_.layout.type = found->type;
    }

    void readEncoding() {
        const std::string text = requireField(header_, "encoding", volume_.header);
        const std::string name = lowerCase(text);
        if (name == "gzip" || name == "gz") {
            volume_.packed = true;
        } else if (name == "txt" || name == "text" || name == "ascii") {
            volume_.encoding = TextVolume::Encoding::kNumbers;
        } else if (name == "hex") {
            volume_.encoding = TextVolume::Encoding::kHex;
        } else if (name != "raw") {
            refuse("the encoding " + printable(text), "raw, gzip, ascii or hex");
        }
        const bool ordered = rawTypeBytes(volume_.layout.type) > 1 &&
                             volume_.encoding != TextVolume::Encoding::kNumbers;
        const std::string* const endian = find("endian");
        if (endian != nullptr && *endian != "little" && *endian != "big") {
            refuse("endian " + printable(*endian), "little or big");
        }
        if (endian == nullptr && ordered) refuse("a header without endian", "a whole one");
        volume_.layout.bigEndian = endian != nullptr && *endian == "big";
    }

    void readData() {
        if (const std::string* const name = find("datafile")) {
            setDataFile(*name, volume_);
        } else {
            volume_.dataFile = volume_.header;
            volume_.dataStart = header_.dataStart;
        }
        const std::int64_t lines = wholeField(header_, "lineskip", 0, volume_.header);
        const std::int64_t bytes = wholeField(header_, "byteskip", 0, volume_.header);
        const bool fromEnd =
            bytes == -1 && !volume_.packed && volume_.encoding == TextVolume::Encoding::kBytes;
        if (lines < 0 || (bytes < 0 && !fromEnd)) {
            refuse("line skip " + std::to_string(lines) + " and byte skip " + std::to_string(bytes),
                   "whole numbers from 0 on (byte skip -1: raw values that end the file)");
        }
        passLines(lines);
        volume_.atEnd = fromEnd;
        volume_.skipBytes = fromEnd ? 0 : std::uint64_t(bytes);
    }

    // Lines are skipped before unpacking, bytes afterwards.
    void passLines(std::int64_t lines) {
        if (lines == 0) return;
        const bool whole = volume_.dataFile == volume_.header;
        ByteSource source(volume_.dataFile, whole ? packingOf(volume_.dataFile) : Packing::kNone);
        source.skip(volume_.dataStart, [] {});
        std::array<char, 1 << 16> block{};
        while (lines > 0) {
            const std::size_t held = source.read(block.data(), block.size());
            if (held == 0)
                refuseFile(volume_.dataFile, "fewer lines than are to be skipped", "all of them");
            std::size_t passed = 0;
            for (; passed < held && lines > 0; ++passed)
                if (block[passed] == '\n') --lines;
            volume_.dataStart += passed;
        }
    }

    // Returns the axes' kinds in lower case; empty if not given.
    std::vector<std::string> kinds() const {
        std::vector<std::string> kinds(volume_.sizes.size());
        const std::string* const text = find("kinds");
        if (text == nullptr) return kinds;
        std::istringstream words(lowerCase(*text));
        for (std::string& kind : kinds) words >> kind;
        return kinds;
    }

    // Returns the spatial axes. Another one counts volumes: a list, time, or one without a place.
    std::vector<std::size_t> readAxes() {
        const std::vector<std::string> kind = kinds();
        const std::vector<std::optional<std::vector<double>>> vectors = directions();
        std::vector<std::size_t> axes;
        for (std::size_t axis = 0; axis < volume_.sizes.size(); ++axis) {
            const std::int64_t size = volume_.sizes[axis];
            const bool several = volume_.sizes.size() > 3;
            const bool listed = kind[axis] == "list" || (kind[axis] == "time" && several);
            const bool isSpace = kind[axis].empty() || kind[axis] == "domain" ||
                                 kind[axis] == "space" || kind[axis] == "???" ||
                                 kind[axis] == "none";
            const bool placeless = !vectors.empty() && !vectors[axis];
            if (size > 1 && (listed || (isSpace && placeless && several)) && volume_.volumes == 1 &&
                (axis == 0 || axis + 1 == volume_.sizes.size())) {
                volume_.volumes = size;
                volume_.interleaved = axis == 0;
            } else if (size > 1 && !isSpace && !listed) {
                refuse(std::to_string(size) + " values a voxel (" + printable(kind[axis]) + ")",
                       "one");
            } else if (size > 1 || (isSpace && !placeless)) {
                axes.push_back(axis);
            }
        }
        takeThree(axes, volume_);
        return axes;
    }

    // Returns a vector per axis, or nothing for "none". Empty if the header has no directions.
    std::vector<std::optional<std::vector<double>>> directions() const {
        const std::string* const text = find("spacedirections");
        if (text == nullptr) return {};
        if (spaceAxes() == 0)
            refuse("space directions without a space", "a space or a space dimension");
        std::vector<std::optional<std::vector<double>>> vectors;
        for (std::size_t at = text->find_first_not_of(" \t"); at != std::string::npos;
             at = text->find_first_not_of(" \t", at)) {
            const std::size_t end =
                (*text)[at] == '(' ? text->find(')', at) + 1 : text->find_first_of(" \t", at);
            const std::string word = text->substr(at, std::min(end, text->size()) - at);
            vectors.push_back(lowerCase(word) == "none" ? std::nullopt
                                                        : std::optional(vectorIn(word)));
            // Some programs write NaN instead of "none".
            if (vectors.back() &&
                std::ranges::any_of(*vectors.back(), [](double x) { return std::isnan(x); }))
                vectors.back() = std::nullopt;
            at = std::min(end, text->size());
        }
        if (vectors.size() != volume_.sizes.size()) {
            refuse("space directions " + printable(text->substr(0, 80)),
                   std::to_string(volume_.sizes.size()) + " vectors or none");
        }
        return vectors;
    }

    std::vector<double> vectorIn(const std::string& text) const {
        const auto bad = [&] {
            refuse("the vector " + printable(text.substr(0, 80)),
                   std::to_string(spaceAxes()) + " numbers in brackets");
        };
        if (text.size() < 3 || text.front() != '(' || text.back() != ')') bad();
        std::string inner = text.substr(1, text.size() - 2);
        std::ranges::replace(inner, ',', ' ');
        std::optional<std::vector<double>> numbers = numbersIn(inner);
        if (!numbers || numbers->size() != std::size_t(spaceAxes())) bad();
        return *numbers;
    }

    const Space* space() const {
        const std::string* const text = find("space");
        if (text == nullptr) return nullptr;
        const auto letters = [](std::string_view name) {
            std::string result;
            for (const char c : lowerCase(std::string(name))) {
                if (c != ' ' && c != '-' && c != '_') result += c;
            }
            return result;
        };
        const std::string name = letters(*text);
        for (const Space& space : kSpaces) {
            if (name == letters(space.name) ||
                (!space.shortName.empty() && name == letters(space.shortName)))
                return &space;
        }
        refuse("the space " + printable(*text),
               "one that NRRD defines, such as left-posterior-superior or 3D-right-handed");
    }

    int spaceAxes() const {
        const Space* const named = space();
        if (named != nullptr) return named->axes;
        const std::int64_t axes = wholeField(header_, "spacedimension", 0, volume_.header);
        constexpr std::int64_t kMost = 8;
        if (axes < 0 || axes > kMost) refuse("space dimension " + std::to_string(axes), "1 to 8");
        return int(axes);
    }

    void place(const std::vector<std::size_t>& axes) {
        const Space* const named = space();
        const auto vectors = directions();
        if (vectors.empty()) {
            placeByAxes(axes);
        } else {
            placeByVectors(axes, vectors);
        }
        volume_.worldFromIndex = withThickness(volume_.worldFromIndex, volume_.layout.dims, 1);
        if (named != nullptr) volume_.space = named->becomes;
        if (named != nullptr && named->mirrored >= 0) mirror(*named);
        const bool bySpace = !vectors.empty() || find("units") == nullptr;
        readUnits(axes, bySpace ? "spaceunits" : "units", bySpace);
        requirePlacement(volume_.header.string(), "spacing and directions", volume_.worldFromIndex);
    }

    void mirror(const Space& space) {
        for (int column = 0; column < 4; ++column) {
            // Adding 0 turns -0 into 0 for messages.
            double& number = volume_.worldFromIndex[column][space.mirrored];
            number = -number + 0.0;
        }
        const std::string becomes = *space.becomes == '\0' ? "a right-handed space" : space.becomes;
        listener_.warn(volume_.header.string() + ": the space " + std::string(space.name) +
                       " is turned into " + becomes + ": " + "xyz"[space.mirrored] +
                       " changes its sign");
    }

    // World directions without an axis get one of length 1.
    void placeByVectors(const std::vector<std::size_t>& axes,
                        const std::vector<std::optional<std::vector<double>>>& vectors) {
        const int rows = std::min(spaceAxes(), 3);
        glm::dmat4& matrix = volume_.worldFromIndex;
        matrix = glm::dmat4(0);
        matrix[3][3] = 1;
        for (std::size_t i = 0; i < axes.size(); ++i) {
            const auto& vector = vectors[axes[i]];
            if (!vector) refuse("an axis without a direction", "a direction of each");
            for (int row = 0; row < rows; ++row) matrix[int(i)][row] = (*vector)[std::size_t(row)];
        }
        completeAxes(int(axes.size()), matrix);
        placeOrigin();
    }

    void placeOrigin() {
        const std::string* const origin = find("spaceorigin");
        if (origin == nullptr) return;
        if (spaceAxes() == 0)
            refuse("a space origin without a space", "a space or a space dimension");
        const std::vector<double> place = vectorIn(*origin);
        for (int row = 0; row < std::min(spaceAxes(), 3); ++row) {
            const double number = place[std::size_t(row)];
            volume_.worldFromIndex[3][row] = std::isnan(number) ? 0 : number;
        }
    }

    static void completeAxes(int known, glm::dmat4& matrix) {
        if (known == 2) {
            const glm::dvec3 normal = glm::cross(glm::dvec3(matrix[0]), glm::dvec3(matrix[1]));
            matrix[2] = glm::dvec4(glm::length(normal) > 0 ? glm::normalize(normal) : normal, 0);
        } else if (known == 1) {
            // World axes, starting with the one least aligned to x.
            const glm::dvec3 x = glm::normalize(glm::dvec3(matrix[0]));
            int least = 1;
            for (const int axis : {2, 0})
                if (std::abs(x[axis]) < std::abs(x[least])) least = axis;
            glm::dvec3 other(0);
            other[least] = 1;
            const glm::dvec3 z = glm::normalize(glm::cross(x, other));
            matrix[1] = glm::dvec4(glm::cross(z, x), 0);
            matrix[2] = glm::dvec4(z, 0);
        } else if (known == 0) {
            matrix[0].x = matrix[1].y = matrix[2].z = 1;
        }
    }

    std::vector<double> perAxis(const std::string& field) const {
        const std::string* const text = find(field);
        if (text == nullptr) return {};
        const auto numbers = numbersIn(*text);
        if (!numbers || numbers->size() != volume_.sizes.size()) {
            refuse(field + " " + printable(text->substr(0, 80)),
                   std::to_string(volume_.sizes.size()) + " numbers");
        }
        return *numbers;
    }

    bool isNode(std::size_t axis) const {
        const std::string* text = find("centers");
        if (text == nullptr) text = find("centerings");
        if (text == nullptr) return false;
        std::istringstream words(lowerCase(*text));
        std::string word;
        for (std::size_t i = 0; i <= axis; ++i) words >> word;
        return word == "node";
    }

    void placeByAxes(const std::vector<std::size_t>& axes) {
        const std::vector<double> spacings = perAxis("spacings");
        const std::vector<double> mins = perAxis("axismins"), maxs = perAxis("axismaxs");
        const auto known = [](const std::vector<double>& numbers, std::size_t axis) {
            return !numbers.empty() && std::isfinite(numbers[axis]);
        };
        for (std::size_t i = 0; i < axes.size(); ++i) {
            const std::size_t axis = axes[i];
            const auto column = int(i);
            const double steps = double(volume_.sizes[axis]) - (isNode(axis) ? 1 : 0);
            double step = 1;
            if (known(spacings, axis)) {
                step = spacings[axis];
            } else if (known(mins, axis) && known(maxs, axis) && steps > 0) {
                step = (maxs[axis] - mins[axis]) / steps;
            }
            volume_.worldFromIndex[column][column] = step;
            if (known(mins, axis))
                volume_.worldFromIndex[3][column] = mins[axis] + (isNode(axis) ? 0 : 0.5 * step);
        }
        placeOrigin();
    }

    // @param bySpace  whether units are listed per spatial axis or per axis of the file
    void readUnits(const std::vector<std::size_t>& axes, const std::string& field, bool bySpace) {
        const std::string* const text = find(field);
        if (text == nullptr) return;
        const std::vector<std::string> all = wordsIn(*text);
        std::vector<std::string> units;
        const std::size_t count = bySpace ? std::size_t(std::min(spaceAxes(), 3)) : axes.size();
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t place = bySpace ? i : axes[i];
            units.push_back(place < all.size() ? all[place] : "");
        }
        if (!units.empty()) setUnits(units, listener_, volume_);
    }

    // Splits quoted words; some programs leave the quotes out.
    static std::vector<std::string> wordsIn(const std::string& text) {
        std::vector<std::string> words;
        constexpr const char* kBlanks = " \t";
        for (std::size_t at = text.find_first_not_of(kBlanks); at != std::string::npos;
             at = text.find_first_not_of(kBlanks, at)) {
            const bool quoted = text[at] == '"';
            const std::size_t begin = at + (quoted ? 1 : 0);
            const std::size_t end = std::min(
                quoted ? text.find('"', begin) : text.find_first_of(kBlanks, at), text.size());
            words.push_back(text.substr(begin, end - begin));
            at = std::min(end + (quoted ? 1 : 0), text.size());
        }
        return words;
    }

    const TextHeader header_;
    const Listener& listener_;
    TextVolume volume_;
};

}  // namespace

TextVolume readNrrdVolume(const std::filesystem::path& file, const Listener& listener) {
    return NrrdReader(file, listener).read();
}

}  // namespace deltasplat
