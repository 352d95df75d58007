// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <utility>

#include "deltasplat/error.h"
#include "ingest/dense/dense_source.h"
#include "ingest/dicom/dicom_pixels.h"
#include "ingest/dicom/dicom_series.h"
#include "ingest/dicom/dicom_slices.h"
#include "ingest/dicom/dicom_walk.h"
#include "ingest/files/file_name.h"
#include "ingest/files/refuse_file.h"
#include "ingest/placement.h"
#include "memory.h"
#include "modules/medical_module.h"
#include "printable.h"

namespace deltasplat {
namespace {

constexpr std::uint32_t kStoredClass = 0x00020002;
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
constexpr std::uint32_t kIntercept = 0x00281052;
constexpr std::uint32_t kSlope = 0x00281053;

constexpr bool kBigEndian = std::endian::native == std::endian::big;

// The numbers of an attribute that is text, "1\0\0"; none if one of them is no usable number.
std::vector<double> numbersOf(const DicomElements& elements, std::uint32_t tag) {
    std::vector<double> numbers;
    std::istringstream parts(elements.text(tag));
    for (std::string part; std::getline(parts, part, '\\');) {
        part.erase(0, part.find_first_not_of(" +"));
        part.erase(part.find_last_not_of(' ') + 1);
        double number = 0;
        const char* const end = part.data() + part.size();
        const auto result = std::from_chars(part.data(), end, number);
        const bool whole = result.ec == std::errc{} && result.ptr == end;
        if (!whole || !std::isfinite(number) || std::abs(number) > 1e9) return {};
        numbers.push_back(number);
    }
    return numbers;
}

std::vector<double> placeOf(const std::filesystem::path& path, const DicomElements& elements,
                            std::uint32_t tag, const char* name, std::size_t count) {
    std::vector<double> numbers = numbersOf(elements, tag);
    if (numbers.size() == count) return numbers;
    refuseFile(path, std::string("no usable ") + name,
               std::to_string(count) + " numbers that say where the slice lies");
}

void setPlace(const DicomElements& elements, DicomSlice& slice) {
    const auto at = placeOf(slice.file, elements, kPosition, "ImagePositionPatient", 3);
    const auto axes = placeOf(slice.file, elements, kOrientation, "ImageOrientationPatient", 6);
    const auto pixel = placeOf(slice.file, elements, kPixelSpacing, "PixelSpacing", 2);
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
        const std::vector<double> sizes = numbersOf(elements, tag);
        if (sizes.empty() || !(sizes[0] > 0)) continue;
        slice.thickness = sizes[0];
        break;
    }
}

void setSize(const DicomElements& elements, DicomSlice& slice) {
    slice.columns = elements.number(kColumns, 0);
    slice.rows = elements.number(kRows, 0);
    if (slice.columns < 1 || slice.rows < 1) {
        refuseFile(slice.file, "no image", "a DICOM slice with rows and columns");
    }
    const std::string colors = elements.text(kPhotometric);
    if (elements.number(kSamples, 1) != 1 || (colors != "MONOCHROME1" && colors != "MONOCHROME2")) {
        refuseFile(slice.file, "pixels of kind " + (colors.empty() ? "unknown" : printable(colors)),
                   "one grey value a pixel");
    }
    const std::string frames = elements.text(kFrames);
    if (!frames.empty() && frames != "1") {
        refuseFile(slice.file, printable(frames) + " frames in one file", "one slice in each file");
    }
}

void setPixels(const DicomElements& elements, DicomSlice& slice) {
    DicomPixels& pixels = slice.pixels;
    pixels.syntax = elements.syntax;
    pixels.bigEndian = elements.bigEndian;
    pixels.packed = elements.packed;
    pixels.words = elements.pixelWords;
    pixels.pieces = elements.pixels;
    pixels.bitsAllocated = elements.number(kBitsAllocated, 0);
    pixels.bitsStored = elements.number(kBitsStored, 0);
    const int high = elements.number(kHighBit, 0);
    const int sign = elements.number(kSign, 0);
    const int bits = pixels.bitsAllocated;
    if ((bits != 8 && bits != 16 && bits != 32) || pixels.bitsStored < 1 ||
        pixels.bitsStored > bits || high != pixels.bitsStored - 1 || sign > 1) {
        refuseFile(slice.file,
                   "pixels of " + std::to_string(pixels.bitsStored) + " bits up to bit " +
                       std::to_string(high) + " in " + std::to_string(bits),
                   "whole numbers of 8, 16 or 32 bits");
    }
    pixels.isSigned = sign == 1;
}

// A slope of 0 says as little as none.
void setRescale(const DicomElements& elements, DicomSlice& slice) {
    const auto valueOf = [&](std::uint32_t tag, double missing) {
        if (elements.text(tag).empty()) return missing;
        const std::vector<double> numbers = numbersOf(elements, tag);
        if (numbers.size() == 1) return numbers[0];
        refuseFile(slice.file, "rescale " + printable(elements.text(tag)), "a number");
    };
    slice.pixels.rescale = {valueOf(kSlope, 1), valueOf(kIntercept, 0)};
    if (slice.pixels.rescale.slope == 0) slice.pixels.rescale.slope = 1;
    slice.type = dicomValueType(slice.pixels);
}

void requirePixels(const DicomElements& elements, const DicomSlice& slice) {
    const double bytes = double(slice.columns) * slice.rows * slice.pixels.bitsAllocated / 8;
    // Lossless JPEG 2000 of one grey packs best; this much is beyond anything an image is.
    const double most = double(elements.pixelBytes()) * (elements.packed ? 65536 : 1);
    if (bytes <= most) return;
    refuseFile(slice.file, std::to_string(elements.pixelBytes()) + " bytes of pixels",
               "enough for " + std::to_string(slice.columns) + "x" + std::to_string(slice.rows));
}

// The slices, in values of one type.
struct DicomFiles {
    DicomVolume volume;
    RawType type = RawType::kUint8;

    std::size_t slicePixels() const {
        return std::size_t(volume.slices[0].columns) * std::size_t(volume.slices[0].rows);
    }
};

void readLayers(const DicomFiles& files, const DenseSource::LayerUse& use,
                const Listener& listener) {
    const int slices = int(files.volume.slices.size());
    const std::size_t sliceBytes = files.slicePixels() * std::size_t(rawTypeBytes(files.type));
    const int most = std::min(slices, DenseSource::kLayerSlices);
    const auto bytes = std::make_unique<std::byte[]>(sliceBytes * std::size_t(most));
    for (int first = 0; first < slices; first += DenseSource::kLayerSlices) {
        const int count = std::min(DenseSource::kLayerSlices, slices - first);
        for (int i = 0; i < count; ++i) {
            readDicomPixels(files.volume.slices[std::size_t(first) + std::size_t(i)],
                            bytes.get() + sliceBytes * std::size_t(i));
        }
        use(first, count, bytes.get());
        listener.report(double(first + count) / slices);
    }
}

// Slices of different types, as when each has a slope of its own, meet in float64.
RawType commonType(const std::vector<DicomSlice>& slices) {
    const bool same = std::all_of(slices.begin(), slices.end(), [&](const DicomSlice& slice) {
        return slice.type == slices.front().type;
    });
    return same ? slices.front().type : RawType::kFloat64;
}

// Checks what the header of a slice says. Its pixels are not read.
DicomSlice sliceOf(const std::filesystem::path& path, const DicomElements& elements) {
    DicomSlice slice;
    slice.file = path;
    setSize(elements, slice);
    setPixels(elements, slice);
    requirePixels(elements, slice);
    setRescale(elements, slice);
    setPlace(elements, slice);
    return slice;
}

// What people go by, where UIDs are only numbers: "CT, Thorax 1.5 mm".
std::string descriptionOf(const DicomElements& elements) {
    std::string text = printable(elements.text(kModality));
    const std::string words = printable(elements.text(kSeriesDescription));
    if (!words.empty()) text += (text.empty() ? "" : ", ") + words;
    return text;
}

void addFile(const std::filesystem::path& path, std::map<std::string, DicomSeries>& all) {
    requireRegularFile(path);
    const DicomElements elements = walkDicom(path);
    // A table of contents, as DICOMDIR is under that name.
    if (elements.text(kStoredClass) == "1.2.840.10008.1.3.10") return;
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
        series.slices.push_back(sliceOf(path, elements));
    } catch (const Error& error) {
        if (error.code() != ErrorCode::kInput) throw;
        series.error = error;
    }
}

}  // namespace

std::vector<DicomSeries> medical_module::findSeries(
    const std::filesystem::path& input, const std::vector<std::filesystem::path>& files) {
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

DenseSource medical_module::openDicom(const std::filesystem::path& input, const std::string& name,
                                      DicomSeries series) {
    if (series.error) throw Error(*series.error);
    std::vector<DicomSlice> slices = std::move(series.slices);
    auto files = std::make_shared<DicomFiles>();
    files->type = commonType(slices);
    for (DicomSlice& slice : slices) slice.type = files->type;
    files->volume = arrangeSlices(input.string(), std::move(slices));

    DenseSource source;
    source.where = input.string();
    source.name = name;
    source.dims = {files->volume.slices[0].columns, files->volume.slices[0].rows,
                   std::int64_t(files->volume.slices.size())};
    source.type = files->type;
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
