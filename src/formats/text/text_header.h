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

/// The lines of a header that is text, as NRRD and MetaImage have it. Fields that are not spelled
/// as their format spells them, or given twice, are refused: programs read them differently.
struct TextHeader {
    struct Field {
        std::string name;   ///< lower case, without blanks: "datafile", "dimsize"
        std::string value;  ///< without the blanks before it
    };
    std::vector<Field> fields;  ///< those of the format, in file order
    /// NRRD: what anybody may add as "key:=value", in file order.
    std::vector<std::pair<std::string, std::string>> keyValues;
    std::uint64_t dataStart = 0;  ///< place in the file, unpacked, of the byte after the header

    /// Returns the value of the field of this name (as in Field), or nullptr.
    const std::string* find(const std::string& name) const;
    /// Returns the value of a key, or nullptr.
    const std::string* findKey(const std::string& key) const;
};

/// Reads lines `name: value` and `key:=value` up to an empty line or the file's end, of a file that
/// may lie under gzip. Comments are passed over. Blanks behind the name of a data file belong to
/// it.
/// @throw Error(kInput) if the file cannot be read, does not begin with "NRRD000" and 1 to 5, or
/// has
///        a line of more than 2^20 bytes or a header of more than 2^24
TextHeader readNrrdHeader(const std::filesystem::path& file);

/// Reads lines `name = value` up to the one named ElementDataFile, of which those that say what
/// voxels are, or where, are kept.
/// @throw as readNrrdHeader, if there is no such line
TextHeader readMetaHeader(const std::filesystem::path& file);

/// Returns the whole numbers from 1 to 2^30 that `text` holds between blanks.
/// @throw Error(kInput) "<where>: got sizes 4 -3 2; expected whole numbers from 1 to 1073741824"
std::vector<std::int64_t> parseSizes(const std::string& where, const std::string& text);

/// As DenseFormat has them.
void settleNrrd(DenseLayout& layout, const std::string& file, WriteNotes& notes);
std::string nrrdHeader(const DenseLayout& layout, const std::string& dataFile);
void settleMetaImage(DenseLayout& layout, const std::string& file, WriteNotes& notes);
std::string metaImageHeader(const DenseLayout& layout, const std::string& dataFile);

struct TextHeader;

/// A label of a segmentation in layers.
struct Segment {
    std::int64_t layer = 0;
    std::int64_t stored = 0;  ///< its value there
    LabelEntry label;         ///< with its value where all layers are one
};

/// What a NRRD or MetaImage header says, checked: where the values lie, what they are, and where
/// the voxels are.
struct TextVolume {
    enum class Encoding { kBytes, kNumbers, kHex };

    std::filesystem::path header;
    std::filesystem::path dataFile;  ///< the header itself, or another file
    std::uint64_t dataStart = 0;  ///< place in the data file, unpacked if that is gzip as a whole
    Encoding encoding = Encoding::kBytes;
    bool packed = false;               ///< whether the values are packed there by themselves
    Packing packing = Packing::kGzip;  ///< how, if so
    std::uint64_t skipBytes = 0;       ///< of the values' bytes, unpacked, before the first
    bool atEnd = false;                ///< whether the values are the last bytes of the data file

    std::vector<std::int64_t> sizes;  ///< of all axes, the fastest first
    RawLayout layout;                 ///< of one volume; skipBytes is not used
    std::int64_t volumes = 1;         ///< of which one is read
    bool interleaved = false;         ///< whether the volumes' values are side by side

    glm::dmat4 worldFromIndex{1.0};
    std::string space;       ///< as Volume::space
    std::string lengthUnit;  ///< as Volume::lengthUnit
    Rescale rescale;
    std::shared_ptr<const LabelList> labels;  ///< as Volume::labels; of layers: null
    std::vector<Segment> segments;            ///< of layers: those that lie in them, lowest first
    bool renumbered = false;  ///< whether they have other values where all layers are one

    std::string sizesText() const;
};

/// Reads the header of a .nrrd or .nhdr file. Says what is turned and what unit is not known.
/// @throw Error(kInput) if it cannot be read or meant, or names no data file that is there
TextVolume readNrrdVolume(const std::filesystem::path& file, const Listener& listener);

/// Reads the header of a .mhd or .mha file; likewise.
TextVolume readMetaVolume(const std::filesystem::path& file, const Listener& listener);

/// Takes the segments of a .seg.nrrd as the labels of the file, the first lowest. A header without
/// them may say that its values are labels, as NIfTI does.
void readSegments(const TextHeader& header, TextVolume& volume);

/// Returns the value of a field.
/// @throw Error(kInput) if there is none
const std::string& requireField(const TextHeader& header, const std::string& field,
                                const std::filesystem::path& file);

/// Returns the whole number of a field, or `missing`.
std::int64_t wholeField(const TextHeader& header, const std::string& field, std::int64_t missing,
                        const std::filesystem::path& file);

/// Returns the numbers that a text holds between blanks; nothing if it holds anything else.
std::optional<std::vector<double>> numbersIn(const std::string& text);

/// Takes a data file beside the header.
/// @throw Error(kInput) for lists and series of files, standard input, and no such file
void setDataFile(const std::string& name, TextVolume& volume);

/// Leaves three of the axes, whose sizes are the volume's then: those of one voxel give way, the
/// last first.
/// @throw Error(kInput) if more than three are longer
void takeThree(std::vector<std::size_t>& axes, TextVolume& volume);

/// Turns lengths along each row of a place into those of one unit: of a patient's space into
/// millimetres, of others too where the units differ.
/// @param units  of x, y and z of the world, as files have them
void setUnits(const std::vector<std::string>& units, const Listener& listener, TextVolume& volume);

}  // namespace deltasplat
