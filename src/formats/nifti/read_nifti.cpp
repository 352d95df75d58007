// SPDX-License-Identifier: Apache-2.0
// Based on: NIfTI-1 (nifti1.h, 2003) and NIfTI-2 (nifti2.h, 2011), NIfTI Data Format Working Group:
// one struct in the writer's byte order. ITK knows only NIfTI-1; see also docs/decisions.md.
#include "formats/nifti/read_nifti.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "base/portable_math.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "deltasplat/ingest/label_list.h"
#include "files/file_bytes.h"
#include "files/file_name.h"
#include "formats/dense/dense_source.h"
#include "formats/format.h"
#include "formats/input_files.h"
#include "formats/raw/raw_file.h"
#include "formats/raw/raw_format.h"
#include "volume/placement.h"
#include "volume/volume_checks.h"

namespace deltasplat {

namespace {

constexpr std::size_t kBytes1 = 348;
constexpr std::size_t kBytes2 = 540;

// Offsets of the used fields in one version's header.
struct Places {
    std::size_t magic, dataType, dims, pixelSizes, dataStart, slope, intercept, qformCode,
        sformCode, quaternion, sform, units, intentCode;
};
constexpr Places kPlaces1{344, 70, 40, 76, 108, 112, 116, 252, 254, 256, 280, 123, 68};
constexpr Places kPlaces2{4, 12, 16, 104, 168, 176, 184, 344, 348, 352, 400, 500, 504};

struct TypeInfo {
    int code;
    std::optional<RawType> type;
    const char* name;  // of types that cannot be read
};
constexpr std::array<TypeInfo, 17> kTypes{{{2, RawType::kUint8, ""},
                                           {4, RawType::kInt16, ""},
                                           {8, RawType::kInt32, ""},
                                           {16, RawType::kFloat32, ""},
                                           {64, RawType::kFloat64, ""},
                                           {256, RawType::kInt8, ""},
                                           {512, RawType::kUint16, ""},
                                           {768, RawType::kUint32, ""},
                                           {1024, RawType::kInt64, ""},
                                           {1280, RawType::kUint64, ""},
                                           {1, {}, "single bits"},
                                           {32, {}, "complex64"},
                                           {128, {}, "RGB"},
                                           {1536, {}, "float128"},
                                           {1792, {}, "complex128"},
                                           {2048, {}, "complex256"},
                                           {2304, {}, "RGBA"}}};

// Whether a file has an extension, with or without ".gz".
bool isExtension(const std::filesystem::path& file, const std::string& extension) {
    const std::string own = lowerExtension(file);
    return own == extension || own == extension + ".gz";
}

// Returns an existing file with the same name and another extension, or an empty path.
std::filesystem::path partnerOf(const std::filesystem::path& file, const std::string& extension) {
    const std::string stem = nameWithoutExtensions(file);
    std::string upper = extension;
    for (char& c : upper) c = c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c;
    for (const std::string& name :
         {extension, extension + ".gz", upper, upper + ".GZ", upper + ".gz"}) {
        const std::filesystem::path partner = file.parent_path() / (stem + name);
        std::error_code error;
        if (std::filesystem::exists(partner, error)) return partner;
    }
    return {};
}

class Fields {
  public:
    std::string where;
    std::array<std::byte, kBytes2> bytes{};
    bool second = false;
    bool bigEndian = false;
    bool pair = false;  // whether the values are in a separate file

    const Places& places() const { return second ? kPlaces2 : kPlaces1; }
    template <typename T>
    T at(std::size_t place) const {
        std::array<std::byte, sizeof(T)> value;
        std::memcpy(value.data(), bytes.data() + place, sizeof(T));
        if (bigEndian != (std::endian::native == std::endian::big)) std::ranges::reverse(value);
        return std::bit_cast<T>(value);
    }
    std::int64_t dim(std::size_t i) const {
        const std::size_t place = places().dims;
        return second ? at<std::int64_t>(place + 8 * i) : at<std::int16_t>(place + 2 * i);
    }
    // Treats an axis of size 0 as unused.
    std::int64_t count(std::size_t axis) const { return dim(axis) == 0 ? 1 : dim(axis); }
    double real(std::size_t place, std::size_t i = 0) const {
        return second ? at<double>(place + 8 * i) : double(at<float>(place + 4 * i));
    }
    int code(std::size_t place) const {
        return second ? at<std::int32_t>(place) : at<std::int16_t>(place);
    }
    [[noreturn]] void refuse(const std::string& got, const std::string& expected) const {
        throw Error(ErrorCode::kInput, where, got, expected);
    }
};

// The first number, the header's size, reveals version and byte order.
Fields readFields(const std::filesystem::path& file) {
    Fields fields;
    fields.where = file.string();
    ByteSource source(file, packingOf(file));
    const std::size_t got = source.read(fields.bytes.data(), kBytes2);
    for (const std::size_t size : {kBytes1, kBytes2}) {
        for (const bool bigEndian : {false, true}) {
            fields.second = size == kBytes2;
            fields.bigEndian = bigEndian;
            if (fields.at<std::int32_t>(0) != std::int32_t(size)) continue;
            if (got < size) fields.refuse(std::to_string(got) + " bytes", "a whole NIfTI header");
            const auto* magic =
                reinterpret_cast<const char*>(fields.bytes.data()) + fields.places().magic;
            const char* const wanted = fields.second ? "n+2" : "n+1";
            if (std::memcmp(magic, wanted, 4) == 0) return fields;
            fields.pair = std::memcmp(magic, fields.second ? "ni2" : "ni1", 4) == 0;
            if (fields.pair && isExtension(file, ".hdr")) return fields;
            if (fields.pair)
                fields.refuse("the header of a pair, whose values are in another file",
                              "such a header in a file named .hdr");
            if (!fields.second && isExtension(file, ".hdr")) {
                fields.refuse("a header of Analyze 7.5, which does not say where the patient lies",
                              "a NIfTI-1 or NIfTI-2 file or pair");
            }
        }
    }
    fields.refuse("no NIfTI header", "a NIfTI-1 or NIfTI-2 file");
}

std::string dimsText(const Fields& fields, std::int64_t count) {
    std::string text;
    for (std::int64_t i = 1; i <= count; ++i) {
        text += (i == 1 ? "" : "x") + std::to_string(fields.count(std::size_t(i)));
    }
    return text;
}

glm::i64vec3 readDims(const Fields& fields) {
    constexpr std::int64_t kMost = std::int64_t{1} << 30;
    const std::int64_t count = fields.dim(0);
    if (count < 1 || count > 7) {
        fields.refuse(std::to_string(count) + " dimensions", "1 to 7 of them");
    }
    glm::i64vec3 dims(1);
    for (std::int64_t i = 1; i <= count; ++i) {
        const std::int64_t size = fields.count(std::size_t(i));
        if (size < 1 || size > kMost) {
            fields.refuse("dims " + dimsText(fields, count), "each 1.." + std::to_string(kMost));
        }
        if (i <= 3) dims[int(i - 1)] = size;
    }
    return dims;
}

// Axes beyond the third (time, vector components) count volumes.
double countVolumes(const Fields& fields) {
    double volumes = 1;
    for (std::int64_t i = 4; i <= fields.dim(0); ++i)
        volumes *= double(fields.count(std::size_t(i)));
    return volumes;
}

RawType readType(const Fields& fields) {
    const int code = fields.at<std::int16_t>(fields.places().dataType);
    for (const TypeInfo& info : kTypes) {
        if (info.code != code) continue;
        if (info.type) return *info.type;
        fields.refuse(std::string("values of type ") + info.name, "whole or real numbers");
    }
    fields.refuse("data type " + std::to_string(code), "one that NIfTI defines");
}

std::uint64_t readDataStart(const Fields& fields) {
    const std::size_t place = fields.places().dataStart;
    // Four bytes after the header announce extensions.
    const double least = double(fields.second ? kBytes2 : kBytes1) + 4;
    const double start =
        fields.second ? double(fields.at<std::int64_t>(place)) : fields.real(place);
    if (fields.pair && start >= 0 && start <= 0x1p62 && start == std::floor(start))
        return std::uint64_t(start);
    if (start == 0) return std::uint64_t(least);
    if (!(start >= least && start <= 0x1p62) || start != std::floor(start)) {
        fields.refuse("data at byte " + numberText(start), "at least " + numberText(least));
    }
    return std::uint64_t(start);
}

RawLayout readLayout(const Fields& fields) {
    RawLayout layout;
    layout.dims = readDims(fields);
    layout.type = readType(fields);
    layout.bigEndian = fields.bigEndian;
    layout.skipBytes = readDataStart(fields);
    const double bytes = double(layout.dims.x) * double(layout.dims.y) * double(layout.dims.z) *
                         rawTypeBytes(layout.type) * countVolumes(fields);
    if (bytes > 0x1p62) {
        fields.refuse("dims " + dimsText(fields, fields.dim(0)),
                      "at most 4611686018427387904 bytes");
    }
    return layout;
}

glm::dmat4 sform(const Fields& fields) {
    glm::dmat4 matrix(1);
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) {
            matrix[column][row] =
                fields.real(fields.places().sform, std::size_t(row) * 4 + std::size_t(column));
        }
    }
    return matrix;
}

// A size of 0 is unset and counts as 1. A negative one has no meaning: only forms mirror.
double voxelSize(const Fields& fields, int axis) {
    const double size = fields.real(fields.places().pixelSizes, std::size_t(axis) + 1);
    return size == 0 ? 1 : std::abs(size);
}

bool hasNegativeSize(const Fields& fields) {
    for (int axis = 0; axis < 3 && axis < fields.dim(0); ++axis)
        if (fields.real(fields.places().pixelSizes, std::size_t(axis) + 1) < 0) return true;
    return false;
}

// Method 2 of nifti1.h: a unit quaternion without real part, voxel sizes, third sign in pixdim[0].
glm::dmat4 qform(const Fields& fields) {
    const std::size_t place = fields.places().quaternion;
    double b = fields.real(place, 0), c = fields.real(place, 1), d = fields.real(place, 2);
    const double square = b * b + c * c + d * d;
    double a = 0;
    if (square > 1) {
        const double length = std::sqrt(square);
        b /= length, c /= length, d /= length;
    } else {
        a = std::sqrt(1 - square);
    }
    const double handed = fields.real(fields.places().pixelSizes, 0) < 0 ? -1 : 1;
    const glm::dvec3 x(a * a + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c));
    const glm::dvec3 y(2 * (b * c - a * d), a * a + c * c - b * b - d * d, 2 * (c * d + a * b));
    const glm::dvec3 z(2 * (b * d + a * c), 2 * (c * d - a * b), a * a + d * d - b * b - c * c);
    const glm::dvec3 origin(fields.real(place, 3), fields.real(place, 4), fields.real(place, 5));
    return {glm::dvec4(x * voxelSize(fields, 0), 0), glm::dvec4(y * voxelSize(fields, 1), 0),
            glm::dvec4(z * handed * voxelSize(fields, 2), 0), glm::dvec4(origin, 1)};
}

// Method 1: only sizes.
glm::dmat4 scaling(const Fields& fields) {
    glm::dmat4 matrix(1);
    for (int axis = 0; axis < 3; ++axis) {
        // In files of one or two dimensions the other sizes may be anything.
        if (axis < fields.dim(0) || std::isfinite(voxelSize(fields, axis)))
            matrix[axis][axis] = voxelSize(fields, axis);
    }
    return matrix;
}

// Returns the farthest movement of a corner between two matrices, in voxels.
double distance(const glm::dmat4& a, const glm::dmat4& b, const glm::i64vec3& dims) {
    double farthest = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec4 index((corner & 1) != 0 ? double(dims.x - 1) : 0.0,
                               (corner & 2) != 0 ? double(dims.y - 1) : 0.0,
                               (corner & 4) != 0 ? double(dims.z - 1) : 0.0, 1);
        farthest = std::max(farthest, glm::length(glm::dvec3(a * index - b * index)));
    }
    return farthest / portable::pow(std::abs(glm::determinant(glm::dmat3(a))), 1 / 3.0);
}

// Places voxels by the sform, else the qform, else sizes. Skips forms without distinct places.
void place(const Fields& fields, const Listener& listener, NiftiHeader& header) {
    const bool hasSform = fields.code(fields.places().sformCode) > 0;
    const bool hasQform = fields.code(fields.places().qformCode) > 0;
    const glm::i64vec3& dims = header.layout.dims;
    const glm::dmat4 bySform = withThickness(sform(fields), dims, voxelSize(fields, 2));
    const glm::dmat4 byQform = qform(fields);
    const bool sformPlaces = hasSform && givesPlaces(bySform);
    const bool qformPlaces = hasQform && givesPlaces(byQform);
    const std::string rest = qformPlaces ? "the qform is taken" : "the voxel size is taken";
    if (hasSform && !sformPlaces)
        listener.warn(fields.where + ": the sform gives voxels no place; " + rest);
    if (hasQform && !qformPlaces && !sformPlaces)
        listener.warn(fields.where + ": the qform gives voxels no place; " + rest);
    if (!sformPlaces && hasNegativeSize(fields))
        listener.warn(fields.where + ": a voxel size below 0 is taken as if it were positive");
    header.space = sformPlaces || qformPlaces ? "RAS" : "";
    if (sformPlaces) {
        header.worldFromIndex = bySform;
        if (hasQform && !(distance(bySform, byQform, dims) < 1))
            listener.warn(fields.where + ": sform and qform differ; the sform is taken");
    } else if (qformPlaces) {
        header.worldFromIndex = byQform;
    } else {
        header.worldFromIndex = scaling(fields);
        requirePlacement(fields.where, "a voxel size", header.worldFromIndex);
        listener.warn(fields.where +
                      ": neither sform nor qform: only the voxel size is known, not where the "
                      "volume lies or which side is left");
    }
}

// Converts a patient's space to millimetres.
void readUnit(const Fields& fields, const Listener& listener, NiftiHeader& header) {
    constexpr std::array<const char*, 4> kUnits{"", "m", "mm", "um"};
    const auto code = std::size_t(
        fields.bytes[fields.places().units + (fields.second && fields.bigEndian ? 3 : 0)] &
        std::byte{7});
    header.lengthUnit = code < kUnits.size() ? kUnits[code] : "";
    if (header.space.empty() || header.lengthUnit.empty() || header.lengthUnit == "mm") return;
    listener.warn(fields.where + ": lengths are in " + (code == 1 ? "metres" : "micrometres") +
                  ", and are turned into millimetres");
    scaleLengths(header.worldFromIndex, millimetresIn(header.lengthUnit));
    header.lengthUnit = "mm";
    requirePlacement(fields.where, "lengths in millimetres", header.worldFromIndex);
}

// A slope of 0 means no rescale; so do NaN and infinity, which some programs write.
void readRescale(const Fields& fields, NiftiHeader& header) {
    const double slope = fields.real(fields.places().slope);
    const double intercept = fields.real(fields.places().intercept);
    if (slope == 0 || !std::isfinite(slope) || !std::isfinite(intercept)) return;
    header.rescale = {slope, intercept};
}

}  // namespace

std::vector<std::filesystem::path> niftiFiles(const std::filesystem::path& file) {
    if (!isExtension(file, ".hdr") && !isExtension(file, ".img")) return {file};
    std::vector<std::filesystem::path> files;
    for (const char* const extension : {".hdr", ".img"}) {
        const std::filesystem::path one =
            isExtension(file, extension) ? file : partnerOf(file, extension);
        if (!one.empty()) files.push_back(one);
    }
    return files;
}

NiftiHeader readNiftiHeader(const std::filesystem::path& file, const Listener& listener) {
    requireRegularFile(file);
    const std::vector<std::filesystem::path> files = niftiFiles(file);
    const std::filesystem::path& head = files.front();
    if (head == file && isExtension(file, ".img"))
        refuseFile(file, "no .hdr file beside it", "both files of a NIfTI pair");
    const Fields fields = readFields(head);
    NiftiHeader header;
    header.dataFile = fields.pair ? files.back() : head;
    if (fields.pair && files.size() < 2)
        refuseFile(head, "no .img file beside it", "both files of a NIfTI pair");
    header.layout = readLayout(fields);
    header.volumes = std::int64_t(countVolumes(fields));
    header.dims = dimsText(fields, fields.dim(0));
    place(fields, listener, header);
    header.placeDigits =
        fields.second ? std::numeric_limits<double>::digits : std::numeric_limits<float>::digits;
    readUnit(fields, listener, header);
    readRescale(fields, header);
    constexpr int kLabelIntent = 1002;
    header.isLabels = fields.code(fields.places().intentCode) == kLabelIntent;
    return header;
}

namespace {

DenseSource openNifti(const std::filesystem::path& path, const InputKind&,
                      const ReadOptions& options, const Listener& listener) {
    const NiftiHeader header = readNiftiHeader(path, listener);
    RawFile file{header.dataFile, header.layout, packingOf(header.dataFile)};
    file.mayGoOn = true;
    file.volumes = header.volumes;
    requireRawSize(file);
    file.volume =
        chooseVolume(path.string(), "dims " + header.dims, header.volumes, options.volume);
    DenseSource source = denseSourceOf(file);
    source.worldFromIndex = header.worldFromIndex;
    source.where = path.string();
    source.name = nameWithoutExtensions(path);
    source.space = header.space;
    source.lengthUnit = header.lengthUnit;
    if (header.isLabels) source.labels = std::make_shared<const LabelList>();
    return rescaled(std::move(source), header.rescale);
}

// Returns the files of a NIfTI pair, `input` first.
std::vector<std::filesystem::path> withPartner(const std::filesystem::path& input) {
    std::vector<std::filesystem::path> files{input};
    for (const std::filesystem::path& file : niftiFiles(input))
        if (file != input) files.push_back(file);
    return files;
}

}  // namespace

const Format& niftiFormat() {
    static const Format format{
        .extensions = {".nii", ".hdr", ".img"},
        .mayHoldSeveral = true,
        .open = openNifti,
        .files = withPartner,
        .written = {{".nii", "", false, false, true, settleNifti, niftiHeader},
                    {".nii.gz", "", true, true, true, settleNifti, niftiHeader}}};
    return format;
}

}  // namespace deltasplat
