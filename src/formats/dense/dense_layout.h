// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <string>

#include "deltasplat/convert/write_volume.h"
#include "formats/dense/value_facts.h"
#include "formats/raw/raw_format.h"

namespace deltasplat {

/// Collects the notes of a WriteReport.
class WriteNotes {
  public:
    WriteNotes(WriteReport& report, const std::filesystem::path& file)
        : report_(report), file_(file.string()) {}
    /// A detail that is there, but otherwise.
    void remark(const std::string& what) { report_.notes.push_back(file_ + ": " + what); }
    /// A detail that cannot be read back.
    void loss(const std::string& what) {
        remark(what);
        report_.lossless = false;
    }

  private:
    WriteReport& report_;
    std::string file_;
};

/// What a file of a dense format holds besides its values.
struct DenseLayout {
    glm::ivec3 dims{1};  ///< voxels along x, y, z
    RawType type = RawType::kUint8;
    bool bigEndian = false;                   ///< of values of several bytes
    glm::dmat4 worldFromIndex{1.0};           ///< maps the first voxel, (0, 0, 0), to its place
    std::string space;                        ///< as Volume::space
    std::string lengthUnit;                   ///< as Volume::lengthUnit
    std::shared_ptr<const LabelList> labels;  ///< as Volume::labels

    glm::dvec3 origin() const { return worldFromIndex[3]; }
    /// World lengths of one step along each axis.
    glm::dvec3 spacing() const;
    /// Unit vectors along x, y and z, as columns.
    glm::dmat3 directions() const;
    /// Whether the axes are at right angles, to a hundredth of a voxel in a thousand.
    bool isOrthogonal() const;
    /// Turns world space from the patient's RAS to LPS or back; what has no space keeps its
    /// numbers.
    void turnTo(const std::string& otherSpace);
    /// Says that names and colours of labels are lost, if there are any, or with `all` that values
    /// are labels.
    void noteLabels(const std::string& format, bool all, WriteNotes& notes) const;
    /// Turns known lengths into millimetres, which is what other programs take lengths for.
    void turnToMillimetres();
};

/// How files of one extension are written.
struct DenseFormat {
    const char* extension;      ///< ".nii.gz"
    const char* dataExtension;  ///< of the file that holds the values; "" if it is the same
    bool gzipHeader;
    bool gzipData;
    bool wideIntegers;  ///< it has integers of 64 bits
    /// Brings a layout into the format's terms, and says what the format does not hold.
    /// @throw Error(kFailed) if the format cannot hold it
    void (*settle)(DenseLayout& layout, const std::string& file, WriteNotes& notes);
    /// Returns the bytes before the values. `dataFile` is the name of the other file.
    std::string (*header)(const DenseLayout& layout, const std::string& dataFile);
};

/// Returns the type in which a dense format stores a volume: the type that it had before it was a
/// .vdb (kSourceTypeKey) or its own if that holds every value, otherwise float32 or, if that does
/// not hold every value, float64. Says so where the type is another one.
/// @param wide  whether the format has integers of 64 bits
RawType denseType(const Volume& volume, const ValueFacts& facts, bool wide, WriteNotes& notes);

}  // namespace deltasplat
