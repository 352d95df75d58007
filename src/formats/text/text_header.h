// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/mat4x4.hpp>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "deltasplat/ingest/label_list.h"
#include "deltasplat/progress.h"
#include "files/file_bytes.h"
#include "formats/dense/rescale.h"
#include "formats/raw/raw_format.h"

namespace deltasplat {

struct DenseLayout;
class WriteNotes;

/// The fields of a text header, NRRD or MetaImage. Misspelled and repeated fields are refused,
/// because programs disagree about them.
struct TextHeader {
    struct Field {
        std::string name;   ///< lower case, without blanks: "datafile", "dimsize"
        std::string value;  ///< without leading blanks
    };
    std::vector<Field> fields;  ///< the format's own, in file order
    /// NRRD: the file's "key:=value" pairs, in file order.
    std::vector<std::pair<std::string, std::string>> keyValues;
    std::uint64_t dataStart = 0;  ///< offset of the byte after the header, unpacked

    /// Returns a field's value by its name (as in Field), or nullptr.
    const std::string* find(const std::string& name) const;
    const std::string* findKey(const std::string& key) const;
};

/// Reads lines `name: value` and `key:=value` up to an empty line or the end of the file, which may
/// be gzipped. Skips comments. Blanks after a data file's name belong to the name.
/// @throw Error(kInput) if the file cannot be read, does not begin with "NRRD000" and 1 to 5, has a
///        line of more than 2^20 bytes or a header of more than 2^24
TextHeader readNrrdHeader(const std::filesystem::path& file);

/// Reads lines `name = value` up to ElementDataFile; keeps those about voxels or their placement.
/// @throw as readNrrdHeader; also if ElementDataFile is missing
TextHeader readMetaHeader(const std::filesystem::path& file);

/// Returns the integers from 1 to 2^30 in `text`, separated by blanks.
/// @throw Error(kInput) "<where>: got sizes 4 -3 2; expected whole numbers from 1 to 1073741824"
std::vector<std::int64_t> parseSizes(const std::string& where, const std::string& text);

/// Functions for DenseFormat.
void settleNrrd(DenseLayout& layout, const std::string& file, WriteNotes& notes);
std::string nrrdHeader(const DenseLayout& layout, const std::string& dataFile);
void settleMetaImage(DenseLayout& layout, const std::string& file, WriteNotes& notes);
std::string metaImageHeader(const DenseLayout& layout, const std::string& dataFile);

struct TextHeader;

/// A label in one layer of a layered segmentation.
struct Segment {
    std::int64_t layer = 0;
    std::int64_t stored = 0;  ///< value in the layer
    LabelEntry label;         ///< with the value in the merged volume
};

/// The checked header of a NRRD or MetaImage file: data location, value type and placement.
struct TextVolume {
    enum class Encoding { kBytes, kNumbers, kHex };

    std::filesystem::path header;
    std::filesystem::path dataFile;  ///< the header itself, or another file
    std::uint64_t dataStart = 0;  ///< offset in the data file, unpacked if that is gzip as a whole
    Encoding encoding = Encoding::kBytes;
    bool packed = false;               ///< whether the values alone are compressed
    Packing packing = Packing::kGzip;  ///< their compression, if so
    std::uint64_t skipBytes = 0;       ///< unpacked bytes before the first value
    bool atEnd = false;                ///< whether the values end the data file

    std::vector<std::int64_t> sizes;  ///< all axes, the fastest first
    RawLayout layout;                 ///< one volume; skipBytes is unused
    std::int64_t volumes = 1;         ///< in the file; one is read
    bool interleaved = false;         ///< whether each voxel's values of all volumes are adjacent

    glm::dmat4 worldFromIndex{1.0};
    std::string space;       ///< as Volume::space
    std::string lengthUnit;  ///< as Volume::lengthUnit
    Rescale rescale;
    std::shared_ptr<const LabelList> labels;  ///< as Volume::labels; null for layers
    std::vector<Segment> segments;            ///< of a layered file, bottom to top
    bool renumbered = false;  ///< whether segments get new values in the merged volume

    std::string sizesText() const;
};

/// Reads the header of a .nrrd or .nhdr file. Warns of converted spaces and unknown units.
/// @throw Error(kInput) if the header is unreadable or invalid, or its data file does not exist
TextVolume readNrrdVolume(const std::filesystem::path& file, const Listener& listener);

/// Does the same for a .mhd or .mha file.
TextVolume readMetaVolume(const std::filesystem::path& file, const Listener& listener);

/// Takes the segments of a .seg.nrrd as labels, the first at the bottom. A header without segments
/// may still declare its values to be labels, as NIfTI does.
void readSegments(const TextHeader& header, TextVolume& volume);

/// @throw Error(kInput) if the field is missing
const std::string& requireField(const TextHeader& header, const std::string& field,
                                const std::filesystem::path& file);

/// Returns a field's integer, or `missing`.
std::int64_t wholeField(const TextHeader& header, const std::string& field, std::int64_t missing,
                        const std::filesystem::path& file);

/// Returns the numbers in a text, separated by blanks; nothing if the text holds anything else.
std::optional<std::vector<double>> numbersIn(const std::string& text);

/// Sets a data file other than the header.
/// @throw Error(kInput) for lists and series of files, standard input, and missing files
void setDataFile(const std::string& name, TextVolume& volume);

/// Reduces `axes` to three, dropping axes of one voxel, the last first, and sets the volume's dims.
/// @throw Error(kInput) if more than three axes are longer
void takeThree(std::vector<std::size_t>& axes, TextVolume& volume);

/// Converts lengths along world axes to one unit: a patient's to millimetres, others if they
/// differ.
/// @param units  for world x, y and z, as spelled in the file
void setUnits(const std::vector<std::string>& units, const Listener& listener, TextVolume& volume);

}  // namespace deltasplat
