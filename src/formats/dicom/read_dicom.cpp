// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "base/memory.h"
#include "base/text.h"
#include "deltasplat/error.h"
#include "files/file_name.h"
#include "formats/dense/dense_source.h"
#include "formats/dicom/dicom_pixels.h"
#include "formats/dicom/dicom_slices.h"
#include "formats/dicom/dicom_sniff.h"
#include "formats/dicom/dicom_walk.h"
#include "volume/placement.h"

namespace deltasplat {
namespace {

constexpr std::uint32_t kModality = 0x00080060;
constexpr std::uint32_t kSeriesDescription = 0x0008103e;
constexpr std::uint32_t kSliceThickness = 0x00180050;
constexpr std::uint32_t kSpacingBetweenSlices = 0x00180088;
constexpr std::uint32_t kSeries = 0x0020000e;
constexpr std::uint32_t kPosition = 0x00200032;
constexpr std::uint32_t kOrientation = 0x00200037;
constexpr std::uint32_t kSamples = 0x00280002;
constexpr std::uint32_t kPhotometric = 0x00280004;
constexpr std::uint32_t kFrames = 0x00280008;
constexpr std::uint32_t kRows = 0x00280010;
constexpr std::uint32_t kColumns = 0x00280011;
constexpr std::uint32_t kPixelSpacing = 0x00280030;
constexpr std::uint32_t kBitsAllocated = 0x00280100;
constexpr std::uint32_t kBitsStored = 0x00280101;
constexpr std::uint32_t kHighBit = 0x00280102;
constexpr std::uint32_t kSign = 0x00280103;
constexpr std::uint32_t kPlanePosition = 0x00209113;
constexpr std::uint32_t kPlaneOrientation = 0x00209116;
constexpr std::uint32_t kPixelMeasures = 0x00289110;
constexpr std::uint32_t kFrameOffsets = 0x3004000c;
constexpr std::uint32_t kShared = 0x52009229;
constexpr std::uint32_t kPerFrame = 0x52009230;

// Of the memory that a frame takes while files are opened: a slice, twice while more are added, and
// where its pixels lie.
constexpr double kFrameBytes = 2.0 * sizeof(DicomSlice) + 256;

constexpr bool kBigEndian = std::endian::native == std::endian::big;

std::vector<double> placeOf(const std::filesystem::path& path, const DicomItem& item,
                            std::uint32_t tag, const char* name, std::size_t count) {
    constexpr double kFarthest = 1e9;
    std::vector<double> numbers = item.decimals(tag, kFarthest);
    if (numbers.size() == count) return numbers;
    refuseFile(path, std::string("no usable ") + name,
               std::to_string(count) + " numbers that say where the slice lies");
}

void setPlace(const DicomFrame& frame, DicomSlice& slice) {
    const DicomItem& measures = frame.group(kPixelMeasures);
    const auto at =
        placeOf(slice.file, frame.group(kPlanePosition), kPosition, "ImagePositionPatient", 3);
    const auto axes = placeOf(slice.file, frame.group(kPlaneOrientation), kOrientation,
                              "ImageOrientationPatient", 6);
    const auto pixel = placeOf(slice.file, measures, kPixelSpacing, "PixelSpacing", 2);
    const glm::dvec3 row(axes[0], axes[1], axes[2]);
    const glm::dvec3 column(axes[3], axes[4], axes[5]);
    const bool square = std::abs(glm::length(row) - 1) < 1e-2 &&
                        std::abs(glm::length(column) - 1) < 1e-2 &&
                        std::abs(glm::dot(row, column)) < 1e-2;
    if (!square || !(pixel[0] > 0) || !(pixel[1] > 0)) {
        refuseFile(slice.file, "directions or spacing that are impossible",
                   "unit vectors at a right angle and spacing above 0");
    }
    slice.position = {at[0], at[1], at[2]};
    // The spacing's first number is from row to row.
    slice.alongRow = glm::normalize(row) * pixel[1];
    slice.alongColumn = glm::normalize(column) * pixel[0];
    for (const std::uint32_t tag : {kSpacingBetweenSlices, kSliceThickness}) {
        const std::vector<double> sizes = measures.decimals(tag, 1e9);
        if (sizes.empty() || !(sizes[0] > 0)) continue;
        slice.thickness = sizes[0];
        break;
    }
}

void setSize(const DicomElements& elements, DicomSlice& slice) {
    slice.pixels.columns = slice.columns = elements.number(kColumns, 0);
    slice.pixels.rows = slice.rows = elements.number(kRows, 0);
    if (slice.columns < 1 || slice.rows < 1) {
        refuseFile(slice.file, "no image", "a DICOM slice with rows and columns");
    }
    const std::string colors = elements.text(kPhotometric);
    if (elements.number(kSamples, 1) != 1 || (colors != "MONOCHROME1" && colors != "MONOCHROME2")) {
        refuseFile(slice.file, "pixels of kind " + (colors.empty() ? "unknown" : printable(colors)),
                   "one grey value a pixel");
    }
}

void setBits(const DicomElements& elements, DicomSlice& slice) {
    DicomBits& bits = slice.pixels.bits;
    bits.allocated = elements.number(kBitsAllocated, 0);
    bits.stored = elements.number(kBitsStored, 0);
    bits.high = elements.number(kHighBit, bits.stored - 1);
    const int sign = elements.number(kSign, 0);
    const int cell = bits.allocated;
    if ((cell != 8 && cell != 16 && cell != 32) || bits.stored < 1 || bits.stored > cell ||
        bits.high < bits.stored - 1 || bits.high >= cell || sign > 1) {
        refuseFile(slice.file,
                   "pixels of " + std::to_string(bits.stored) + " bits up to bit " +
                       std::to_string(bits.high) + " in " + std::to_string(cell),
                   "whole numbers of 8, 16 or 32 bits");
    }
    bits.isSigned = sign == 1;
}

void requirePixels(const DicomElements& elements, const DicomSlice& slice, double pictures) {
    const double bytes =
        double(slice.columns) * slice.rows * slice.pixels.bits.allocated / 8 * pictures;
    // Lossless JPEG 2000 of one grey packs best; this much is beyond anything an image is.
    const double most = double(elements.pixelBytes()) * (elements.packed ? 65536 : 1);
    if (bytes <= most) return;
    refuseFile(slice.file, std::to_string(elements.pixelBytes()) + " bytes of pixels",
               "enough for " + (pictures > 1 ? std::to_string(int(pictures)) + " frames of " : "") +
                   std::to_string(slice.columns) + "x" + std::to_string(slice.rows));
}

using Piece = DicomElements::Piece;

std::string readAt(const std::filesystem::path& file, std::uint64_t start, std::uint64_t length) {
    std::string bytes(std::size_t(length), '\0');
    std::ifstream in(file, std::ios::binary);
    in.seekg(std::streamoff(start));
    if (!in.read(bytes.data(), std::streamsize(length)))
        refuseFile(file, "a read error", "a readable file");
    return bytes;
}

// Returns where the pieces of packed pictures begin, by the table of offsets: a place is that of a
// piece's own head, behind the table.
std::set<std::uint64_t> tableOfOffsets(const std::filesystem::path& file,
                                       const std::vector<Piece>& pieces) {
    constexpr std::uint64_t kHead = 8;
    const std::string table = readAt(file, pieces[0].start, pieces[0].length / 4 * 4);
    std::set<std::uint64_t> places;
    for (std::size_t i = 0; i < table.size(); i += 4) {
        std::uint64_t offset = 0;
        for (std::size_t b = 4; b-- > 0;)
            offset = offset << 8 | static_cast<unsigned char>(table[i + b]);
        places.insert(pieces[0].start + pieces[0].length + offset + kHead);
    }
    return places;
}

// Returns the pieces of each packed picture. A picture is a piece, if they are as many; else one
// begins where the table says, or where a piece begins as pictures do.
std::vector<std::vector<Piece>> packedPictures(const DicomElements& elements,
                                               const DicomSlice& slice, std::size_t wanted) {
    std::vector<std::vector<Piece>> pictures;
    if (elements.pixels.empty()) return pictures;
    const std::vector<Piece> pieces(elements.pixels.begin() + 1, elements.pixels.end());
    const std::set<std::uint64_t> places = tableOfOffsets(slice.file, elements.pixels);
    const bool isPieceEach = pieces.size() == wanted;
    const bool isRunLengths = slice.pixels.syntax == "1.2.840.10008.1.2.5";
    for (const Piece& piece : pieces) {
        const auto begins = [&] {
            return beginsPicture(
                readAt(slice.file, piece.start, std::min<std::uint64_t>(piece.length, 8)));
        };
        const bool isNew =
            pictures.empty() || isPieceEach ||
            (places.size() > 1 ? places.contains(piece.start) : isRunLengths || begins());
        if (isNew) pictures.emplace_back();
        pictures.back().push_back(piece);
    }
    return pictures;
}

std::size_t frameCount(const DicomElements& elements, const DicomSlice& slice) {
    if (elements.text(kFrames).empty()) return 1;
    const std::vector<double> frames = elements.decimals(kFrames, 1e6);
    if (frames.size() == 1 && frames[0] >= 1 && frames[0] == std::floor(frames[0]))
        return std::size_t(frames[0]);
    refuseFile(slice.file, printable(elements.text(kFrames)) + " frames", "a whole number");
}

std::uint64_t pictureBytes(const DicomSlice& slice) {
    return std::uint64_t(slice.columns) * std::uint64_t(slice.rows) *
           std::uint64_t(slice.pixels.bits.allocated / 8);
}

std::vector<std::vector<Piece>> plainPictures(const DicomElements& elements,
                                              const DicomSlice& slice, std::size_t frames) {
    const std::uint64_t bytes = pictureBytes(slice);
    std::vector<std::vector<Piece>> pictures;
    for (std::size_t i = 0; i < frames; ++i)
        pictures.push_back({{elements.pixels.at(0).start + i * bytes, bytes}});
    return pictures;
}

// The byte that makes a length even is no picture.
std::uint64_t plainCount(const DicomElements& elements, const DicomSlice& slice,
                         std::size_t frames) {
    const std::uint64_t needed = frames * pictureBytes(slice);
    const std::uint64_t surplus = elements.pixelBytes() - needed;
    return frames + (surplus == needed % 2 ? 0 : surplus / pictureBytes(slice));
}

// Returns the pieces of each frame. More pictures than the header has would be lost without a word.
std::vector<std::vector<Piece>> picturesOf(const DicomElements& elements, const DicomSlice& slice,
                                           std::size_t frames) {
    std::vector<std::vector<Piece>> pictures;
    if (elements.packed) pictures = packedPictures(elements, slice, frames);
    const std::uint64_t count =
        elements.packed ? pictures.size() : plainCount(elements, slice, frames);
    if (count != frames) {
        refuseFile(
            slice.file,
            std::to_string(count) + " pictures of " + std::to_string(slice.columns) + "x" +
                std::to_string(slice.rows),
            std::to_string(frames) + " by the header, which does not say what the others are");
    }
    return elements.packed ? pictures : plainPictures(elements, slice, frames);
}

// Where the frames of a dose lie, of which only the first has a place.
std::vector<double> frameOffsets(const DicomElements& elements, std::size_t frames) {
    std::vector<double> offsets = elements.decimals(kFrameOffsets, 1e9);
    return offsets.size() == frames ? offsets : std::vector<double>();
}

// Returns the way from the first frame. Offsets are along the normal, but are z of the patient
// where the first is that of the first frame.
glm::dvec3 wayToFrame(const DicomSlice& first, const std::vector<double>& offsets, std::size_t i) {
    constexpr double kSame = 1e-3;
    const glm::dvec3 normal = first.normal();
    const bool isPlace = offsets[0] != 0 && std::abs(offsets[0] - first.position.z) < kSame &&
                         std::abs(normal.z) > 1 - kSame;
    return (isPlace ? glm::dvec3(0, 0, 1) : normal) * (offsets[i] - offsets[0]);
}

// Checks what a header says of its frames, of which there is one in most files. Their pixels are
// not read.
std::vector<DicomSlice> slicesOf(const std::filesystem::path& path, const DicomElements& elements,
                                 DicomNotes& notes) {
    DicomSlice first;
    first.file = path;
    setSize(elements, first);
    setBits(elements, first);
    first.pixels.syntax = elements.syntax;
    first.pixels.bigEndian = elements.bigEndian;
    first.pixels.packed = elements.packed;
    first.pixels.words = elements.pixelWords;
    if (!elements.packed && !elements.pixels.empty()) first.pixels.element = elements.pixels[0];
    if (elements.text(kPhotometric) == "MONOCHROME1")
        notes.add("MONOCHROME1, low values meant to be bright: values stay as they are");
    if (first.pixels.bigEndian && first.pixels.words && first.pixels.bits.allocated == 32)
        notes.add("big endian numbers of 32 bits have the lower word first, as DICOM says");

    const std::size_t frames = frameCount(elements, first);
    const auto own = elements.sequences.find(kPerFrame);
    const bool hasOwn = own != elements.sequences.end() && own->second.size() == frames;
    const std::vector<double> offsets = frameOffsets(elements, frames);
    if (frames > 1 && !hasOwn && offsets.empty()) {
        refuseFile(path, std::to_string(frames) + " frames in one file",
                   "one slice in each file, or frames that say where each lies");
    }
    requirePixels(elements, first, double(frames));
    requireMemory(path.string(), double(frames) * kFrameBytes);
    std::vector<std::vector<Piece>> pictures = picturesOf(elements, first, frames);
    std::vector<DicomSlice> slices;
    slices.reserve(frames);
    DicomLastTable table;
    for (std::size_t i = 0; i < frames; ++i) {
        const DicomFrame frame{&elements, elements.first(kShared),
                               hasOwn ? &own->second[i] : nullptr};
        DicomSlice slice = first;
        slice.frame = frames > 1 ? int(i) + 1 : 0;
        slice.pixels.pieces = std::move(pictures[i]);
        slice.meaning = meaningOf(path.string(), frame, slice.pixels.bits, table, notes);
        setPlace(frame, slice);
        if (!hasOwn && !offsets.empty()) slice.position += wayToFrame(slice, offsets, i);
        slices.push_back(std::move(slice));
    }
    return isMosaic(elements) && frames == 1 ? slicesOfMosaic(elements, slices[0], notes) : slices;
}

// What values become.
struct DicomValues {
    RawType type = RawType::kUint8;  // of values
    DicomTarget target;              // as which they are read
    bool mayBeNothing = false;
};

// The slices, in values of one type.
struct DicomFiles {
    DicomVolume volume;
    DicomTarget target;

    std::size_t slicePixels() const {
        return std::size_t(volume.slices[0].columns) * std::size_t(volume.slices[0].rows);
    }
};

void readLayers(const DicomFiles& files, const DenseSource::LayerUse& use,
                const Listener& listener) {
    const int slices = int(files.volume.slices.size());
    const std::size_t sliceBytes =
        files.slicePixels() * std::size_t(rawTypeBytes(files.target.type));
    const int most = std::min(slices, DenseSource::kLayerSlices);
    requireMemory(files.volume.slices[0].file.string(), double(sliceBytes) * most);
    const auto bytes = std::make_unique<std::byte[]>(sliceBytes * std::size_t(most));
    DicomReader reader;
    for (int first = 0; first < slices; first += DenseSource::kLayerSlices) {
        const int count = std::min(DenseSource::kLayerSlices, slices - first);
        for (int i = 0; i < count; ++i) {
            reader.read(files.volume.slices[std::size_t(first) + std::size_t(i)], files.target,
                        bytes.get() + sliceBytes * std::size_t(i));
        }
        use(first, count, bytes.get());
        listener.report(double(first + count) / slices);
    }
}

RawType storedType(const DicomBits& bits) {
    if (bits.allocated == 8) return bits.isSigned ? RawType::kInt8 : RawType::kUint8;
    if (bits.allocated == 16) return bits.isSigned ? RawType::kInt16 : RawType::kUint16;
    return bits.isSigned ? RawType::kInt32 : RawType::kUint32;
}

RawType wholeType(const DicomRange& range) {
    return rescaledWholeType(range.low, range.high, {}).value_or(RawType::kFloat64);
}

// Slices of different types, as when each has a slope of its own, meet in one that holds all
// values.
DicomValues valuesOf(const std::vector<DicomSlice>& slices) {
    DicomValues values;
    DicomRange all = rangeOf(slices[0].pixels.bits, slices[0].meaning);
    bool isSame = true;
    const auto typeOf = [](const DicomSlice& slice, const DicomRange& range) {
        const bool asStored = !slice.meaning.table && slice.meaning.rescale.isIdentity();
        if (asStored) return storedType(slice.pixels.bits);
        return range.isWhole ? wholeType(range) : RawType::kFloat64;
    };
    values.type = typeOf(slices[0], all);
    for (const DicomSlice& slice : slices) {
        const DicomRange range = rangeOf(slice.pixels.bits, slice.meaning);
        isSame = isSame && typeOf(slice, range) == values.type;
        all = {std::min(all.low, range.low), std::max(all.high, range.high),
               all.isWhole && range.isWhole};
        values.mayBeNothing = values.mayBeNothing || slice.meaning.mayBeNothing();
    }
    if (!isSame) values.type = all.isWhole ? wholeType(all) : RawType::kFloat64;
    values.target.type = values.type;
    if (!values.mayBeNothing) return values;
    // Nothing is a number that no value is.
    constexpr double kLeast = std::numeric_limits<std::int32_t>::min();
    const bool fits = all.isWhole && all.low > kLeast && all.high <= -(kLeast + 1);
    values.target = fits ? DicomTarget{RawType::kInt32, kLeast}
                         : DicomTarget{RawType::kFloat64, std::numeric_limits<double>::quiet_NaN()};
    return values;
}

// What people go by, where UIDs are only numbers: "CT, Thorax 1.5 mm".
std::string descriptionOf(const DicomElements& elements) {
    std::string text = printable(elements.text(kModality));
    const std::string words = printable(elements.text(kSeriesDescription));
    if (!words.empty()) text += (text.empty() ? "" : ", ") + words;
    return text;
}

// Tables of values are alike in most slices, and then kept once.
void addSlices(std::vector<DicomSlice> slices, DicomSeries& series) {
    for (DicomSlice& slice : slices) {
        std::shared_ptr<const DicomMeaning::Table>& table = slice.meaning.table;
        if (table && !series.slices.empty()) {
            const auto& before = series.slices.back().meaning.table;
            if (before && *before == *table) table = before;
        }
        series.slices.push_back(std::move(slice));
    }
}

void addFile(const std::filesystem::path& path, std::map<std::string, DicomSeries>& all) {
    requireRegularFile(path);
    const DicomElements elements = walkDicom(path);
    if (elements.isContents()) return;
    const std::string uid = elements.text(kSeries);
    DicomSeries& series = all[uid];
    if (series.files++ == 0) {
        series.firstFile = path;
        series.uid = uid;
        series.description = descriptionOf(elements);
    }
    series.images = series.images || elements.number(kRows, 0) > 0;
    if (series.error) return;
    try {
        addSlices(slicesOf(path, elements, series.notes), series);
    } catch (const Error& error) {
        if (error.code() != ErrorCode::kInput) throw;
        series.error = error;
    }
}

}  // namespace

std::vector<DicomSeries> findSeries(const std::filesystem::path& input,
                                    const std::vector<std::filesystem::path>& files) {
    std::map<std::string, DicomSeries> byUid;
    for (const std::filesystem::path& file : files) addFile(file, byUid);
    if (byUid.empty()) refuseFile(input, "no image", "DICOM slices");
    // It may be a slice of any of them that has been cut.
    if (byUid.size() > 1 && byUid.begin()->first.empty()) {
        refuseFile(byUid.begin()->second.firstFile, "a file that does not say its series",
                   "a SeriesInstanceUID, as others in the folder have it (the file may be cut)");
    }
    std::vector<DicomSeries> all;
    for (auto& [uid, series] : byUid) all.push_back(std::move(series));
    return all;
}

DenseSource openDicom(const std::filesystem::path& input, const std::string& name,
                      DicomSeries series) {
    if (series.error) throw Error(*series.error);
    auto files = std::make_shared<DicomFiles>();
    const DicomValues values = valuesOf(series.slices);
    files->target = values.target;
    files->volume = arrangeSlices(input, std::move(series.slices));

    DenseSource source;
    source.where = input.string();
    source.name = name;
    source.dims = {files->volume.slices[0].columns, files->volume.slices[0].rows,
                   std::int64_t(files->volume.slices.size())};
    source.type = values.target.type;
    if (values.mayBeNothing)
        source.nothing = DenseSource::Nothing{values.target.nothing, values.type};
    source.notes = series.notes.lines();
    source.bigEndian = kBigEndian;
    source.worldFromIndex = files->volume.worldFromIndex;
    requirePlacement(source.where, "places of slices", source.worldFromIndex);
    source.space = "LPS";
    source.lengthUnit = "mm";
    source.forEachLayer = [files](const DenseSource::LayerUse& use, const Listener& listener) {
        readLayers(*files, use, listener);
    };
    return source;
}

}  // namespace deltasplat
