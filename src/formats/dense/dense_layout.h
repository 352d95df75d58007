// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openvdb/Types.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

#include "deltasplat/convert/write_volume.h"
#include "deltasplat/ingest/volume.h"
#include "formats/raw/raw_format.h"

namespace deltasplat {

/// Facts about a volume's finite values, which tell the types that hold all of them.
struct ValueFacts {
    double min = 0;
    double max = 0;
    bool any = false;
    bool whole = true;         ///< whole numbers, none of them -0
    bool floats = true;        ///< a float holds every value
    bool ints = true;          ///< an int64 holds every value
    bool unsignedInts = true;  ///< an uint64 holds every value
    double doubleError = 0;    ///< largest distance of a value from its nearest double

    template <typename T>
    void add(T value) {
        const auto number = double(value);
        if (!std::isfinite(number)) return;
        min = any ? std::min(min, number) : number;
        max = any ? std::max(max, number) : number;
        any = true;
        if constexpr (std::is_floating_point_v<T>) {
            whole = whole && number == std::floor(number) && (number != 0 || !std::signbit(number));
        }
        floats = floats && double(float(number)) == number;
        if constexpr (std::is_integral_v<T> && sizeof(T) == 8) {
            ints = ints && std::in_range<std::int64_t>(value);
            unsignedInts = unsignedInts && std::in_range<std::uint64_t>(value);
            const double error = errorOfDouble(value, number);
            floats = floats && error == 0;
            doubleError = std::max(doubleError, error);
        } else {
            ints = ints && whole && number >= -0x1p63 && number < 0x1p63;
            unsignedInts = unsignedInts && whole && number >= 0 && number < 0x1p64;
        }
    }
    void append(const ValueFacts& other);
    bool fit(RawType type) const;

  private:
    template <typename T>
    static double errorOfDouble(T value, double number) {
        // Doubles from 2^53 on are whole; the largest value may round to 2^64, which becomes 0.
        const std::uint64_t whole = number < 0        ? -std::uint64_t(-number)
                                    : number < 0x1p64 ? std::uint64_t(number)
                                                      : 0;
        const std::uint64_t difference = whole - std::uint64_t(value);
        return double(std::min(difference, -difference));
    }
};

/// Returns the facts of all values, inactive ones included; the same for any number of threads.
ValueFacts factsOf(const Volume& volume);

class WriteNotes {
  public:
    WriteNotes(WriteReport& report, const std::filesystem::path& file)
        : report_(report), file_(file.string()) {}
    /// Notes a detail that is stored differently.
    void remark(const std::string& what) { report_.notes.push_back(file_ + ": " + what); }
    /// Notes a detail that cannot be read back.
    void loss(const std::string& what) {
        remark(what);
        report_.lossless = false;
    }

  private:
    WriteReport& report_;
    std::string file_;
};

/// Contents of a dense file besides its values.
struct DenseLayout {
    glm::ivec3 dims{1};  ///< voxels along x, y, z
    RawType type = RawType::kUint8;
    bool bigEndian = false;                   ///< byte order of the values
    glm::dmat4 worldFromIndex{1.0};           ///< maps the first voxel, (0, 0, 0), to its place
    std::string space;                        ///< as Volume::space
    std::string lengthUnit;                   ///< as Volume::lengthUnit
    std::shared_ptr<const LabelList> labels;  ///< as Volume::labels

    glm::dvec3 origin() const { return worldFromIndex[3]; }
    /// Returns the world length of one step along each axis.
    glm::dvec3 spacing() const;
    /// Returns unit vectors along x, y and z, as columns.
    glm::dmat3 directions() const;
    /// Whether the axes are at right angles, within 0.01 voxels per 1000.
    bool isOrthogonal() const;
    /// Turns world space from the patient's RAS to LPS or back; without a space nothing changes.
    void turnTo(const std::string& otherSpace);
    /// Notes the loss of labels' names and colours, if any, and with `all` that values are labels.
    void noteLabels(const std::string& format, bool all, WriteNotes& notes) const;
    /// Converts known lengths to millimetres, the unit that other programs assume.
    void turnToMillimetres();
};

/// How files of one extension are written.
struct DenseFormat {
    const char* extension;      ///< ".nii.gz"
    const char* dataExtension;  ///< of a separate file for the values, or ""
    bool gzipHeader;
    bool gzipData;
    bool wideIntegers;  ///< has integers of 64 bits
    /// Adapts a layout to the format and notes all that the format does not hold.
    /// @throw Error(kFailed) if the format cannot hold the layout
    void (*settle)(DenseLayout& layout, const std::string& file, WriteNotes& notes);
    /// Returns the bytes before the values. `dataFile` is the name of the values' file.
    std::string (*header)(const DenseLayout& layout, const std::string& dataFile);
};

/// Returns the type in which a dense format stores a volume: the type before it was a .vdb
/// (kSourceTypeKey), else its own, if that holds every value. Otherwise int32 for int64, float32 or
/// float64, the first that holds every value. Notes a change of type.
/// @param wide  whether the format has integers of 64 bits
RawType denseType(const Volume& volume, const ValueFacts& facts, bool wide, WriteNotes& notes);

}  // namespace deltasplat
